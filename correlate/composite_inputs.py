"""The composite of an experiment: assumed, calibrated to a test, or computed from its constituents."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from spavision.errors import InputError
from spavision.experiment import CompositeSection
from spavision.model.coupon.calibration import calibrated_slack_fibre, ogden_composite
from spavision.model.coupon.coupon import pull_coupon
from spavision.model.coupon.geometry import CouponGeometry
from spavision.model.coupon.paper import paper_of_sheet
from spavision.model.fitting.curve_files import CurveFormat, read_curve
from spavision.model.fitting.measured_curve import MeasuredCurve
from spavision.model.materials.library import find_material
from spavision.model.simulation import SimulationSettings

_SHEET = "Bond paper 80 gsm"


def with_composite(
    settings: SimulationSettings, composite: CompositeSection, *, crimp_ratio: float
) -> tuple[SimulationSettings, tuple[str, ...]]:
    """Return the settings with the composite that the experiment asks for, and what to know about it.

    ``slack-fibre`` without a curve keeps what the experiment states. Otherwise a tension curve, measured or
    of a virtual coupon of this crimp ratio, calibrates the slack fibre or a three-term Ogden law.

    Raises
    ------
    InputError
        If the curve cannot be read, has no transition, or no law fits.
    """
    if composite.law == "slack-fibre" and composite.curve is None:
        return settings, ()
    matrix = find_material(composite.matrix_material)
    curve = _curve(composite, crimp_ratio)
    data_notes = tuple(f"{curve.name}: {note}" for note in curve.notes)
    if composite.law == "ogden":
        ogden = ogden_composite(curve, density_g_per_cm3=matrix.density_g_per_cm3)
        return replace(settings, composite=ogden.material), data_notes + ogden.notes
    try:
        calibrated = calibrated_slack_fibre(
            curve, matrix=matrix.law, crimp_ratio=crimp_ratio, paper=settings.paper
        )
    except InputError as error:
        if composite.law != "resolved":
            raise
        raise InputError(
            f"--composite resolved: no slack fibre can be calibrated at this crimp ratio ({error}); choose "
            "slack-fibre or ogden"
        ) from error
    stiffness = calibrated.matrix_stiffness * settings.matrix_stiffness
    calibrated_settings = replace(settings, paper=calibrated.paper, matrix_stiffness=stiffness)
    return calibrated_settings, data_notes + calibrated.notes


def _curve(composite: CompositeSection, crimp_ratio: float) -> MeasuredCurve:
    if composite.curve is None:
        return _coupon_curve(
            crimp_ratio,
            composite.matrix_material,
            composite.coupon_wavelength_mm,
            composite.coupon_fold_radius_mm,
            composite.coupon_paper_modulus_MPa,
        )
    curve = read_curve(Path(composite.curve), CurveFormat(may_stiffen=True))
    if not curve.strain.max() > -curve.strain.min():
        raise InputError(
            f"{composite.curve}: is no tension test, expected one of the composite; name another"
        )
    return curve


@lru_cache(maxsize=64)
def _coupon_curve(
    crimp_ratio: float,
    matrix_material: str,
    wavelength_mm: float,
    fold_radius_mm: float,
    paper_modulus_MPa: float,
) -> MeasuredCurve:
    """Pull a virtual coupon; kept, for a study asks for the same one again and again."""
    geometry = CouponGeometry(crimp_ratio, wavelength_mm=wavelength_mm, fold_radius_mm=fold_radius_mm)
    paper = paper_of_sheet(_SHEET, modulus_MPa=paper_modulus_MPa)
    return pull_coupon(geometry, matrix=find_material(matrix_material).solid(), paper=paper).curve()
