"""From a tension curve of the composite, measured or a coupon's, to what stands for it in the actuator."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from spavision.model.composite import PaperLayer
from spavision.model.fitting.fit import FitSettings, LawFit, fit_law
from spavision.model.fitting.measured_curve import MeasuredCurve
from spavision.model.fitting.slack_fibre_fit import slack_fibre_at_transition
from spavision.model.fitting.transition import PRIMARY_STRAIN, strain_transition, transition_or_none
from spavision.model.materials.curves import nominal_stress
from spavision.model.materials.material_files import Material
from spavision.model.materials.solid import IsotropicLaw
from spavision.model.materials.stiffness import stiffened

STIFFNESS_RANGE = (0.1, 10.0)
"""Factors on the matrix's stresses that are believed."""


@dataclass(frozen=True)
class SlackFibreComposite:
    """Paper and matrix of the slack-fibre composite, calibrated to a curve.

    Parameters
    ----------
    paper : PaperLayer
    matrix_stiffness : float
        Factor on all stresses of the matrix: what the paper adds while it is slack.
    notes : tuple of str
        How well it follows the curve.
    """

    paper: PaperLayer
    matrix_stiffness: float
    notes: tuple[str, ...]

    def experiment_keys(self) -> dict[str, float]:
        """Return what to write under ``[composite]`` in an experiment file."""
        return {
            "matrix_stiffness": self.matrix_stiffness,
            "paper_transition_factor": self.paper.transition_factor,
            "paper_length_modulus_MPa": self.paper.length_modulus_MPa,
            "paper_transition_half_width": self.paper.transition_half_width,
        }


@dataclass(frozen=True)
class OgdenComposite:
    """A homogeneous three-term Ogden law in place of matrix and paper, the article's way.

    Parameters
    ----------
    material : Material
    notes : tuple of str
        How well it follows the curve, and where it is not stable.
    """

    material: Material
    notes: tuple[str, ...]


def calibrated_slack_fibre(
    curve: MeasuredCurve, *, matrix: IsotropicLaw, crimp_ratio: float, paper: PaperLayer
) -> SlackFibreComposite:
    """Calibrate the slack-fibre composite: primary modulus, transition strain and secondary modulus are met.

    Parameters
    ----------
    curve : MeasuredCurve
        Tension along the actuator.
    matrix : IsotropicLaw
    crimp_ratio : float
    paper : PaperLayer
        Its stiffness across the width is kept.

    Raises
    ------
    InputError
        If the curve has no transition.
    """
    ratio = _primary_ratio(curve, matrix)
    factor = float(np.clip(ratio, *STIFFNESS_RANGE))
    fit = slack_fibre_at_transition(curve, stiffened(matrix, factor))
    whole = replace(paper, transition_factor=1.0).slack_strain(crimp_ratio)
    calibrated = replace(
        paper,
        transition_factor=fit.fibre.slack_strain / whole,
        length_modulus_MPa=fit.fibre.modulus_MPa,
        transition_half_width=fit.fibre.transition_half_width,
    )
    note = (
        f"slack-fibre composite calibrated to {curve.name}: slack strain {fit.fibre.slack_strain:.1%}, "
        f"stiffness {fit.fibre.modulus_MPa:.3g} MPa, matrix times {factor:.3g}; "
        f"R² {fit.goodness.r_squared:.3f}"
    )
    if factor != ratio:
        doubt = (
            f"{curve.name}: the primary modulus is {ratio:.3g} times the matrix's own, beyond what is "
            f"believed: {factor:g} is taken; check the matrix and the units"
        )
        return SlackFibreComposite(calibrated, factor, (note, doubt))
    return SlackFibreComposite(calibrated, factor, (note,))


def ogden_composite(
    curve: MeasuredCurve, *, density_g_per_cm3: float, allow_unstable: bool = False
) -> OgdenComposite:
    """Fit a three-term Ogden law to a tension curve of the composite, as the article does.

    Parameters
    ----------
    curve : MeasuredCurve
    density_g_per_cm3 : float
    allow_unstable : bool
        Whether the law may lose stability within the range of the curve.

    Raises
    ------
    InputError
        If no such law fits.
    """
    fit = fit_law("ogden", [curve], FitSettings(allow_unstable=allow_unstable, any_modulus=True))
    material = Material(
        name="Ogden composite",
        law=fit.law,
        density_g_per_cm3=density_g_per_cm3,
        source=f"fit of {curve.name}",
        uncertain="; ".join(fit.notes),
        strain_range=(min(0.0, float(curve.strain.min())), float(curve.strain.max())),
    )
    notes = (_ogden_note(curve, fit), *(f"Ogden composite: {note}" for note in fit.notes))
    return OgdenComposite(material, notes)


def _primary_ratio(curve: MeasuredCurve, matrix: IsotropicLaw) -> float:
    """Primary modulus of the curve over the matrix's own."""
    first = (curve.strain >= 0.0) & (curve.strain <= PRIMARY_STRAIN)
    measured = strain_transition(curve.strain, curve.stress_MPa, name=curve.name).primary.modulus_MPa
    own = nominal_stress(matrix, curve.stretch[first], curve.mode)
    return measured / float(np.polyfit(curve.strain[first], own, 1)[0])


def _ogden_note(curve: MeasuredCurve, fit: LawFit) -> str:
    measured = transition_or_none(curve.strain, curve.stress_MPa)
    fitted = transition_or_none(curve.strain, fit.stress_of(curve))
    error = (
        f", transition {fitted.strain:.1%} for {measured.strain:.1%} "
        f"(error {measured.relative_error_of(fitted):.1%})"
        if measured is not None and fitted is not None
        else ""
    )
    stable = "stable within it" if fit.is_stable else "NOT stable within it, so that the ramp may stop"
    return f"Ogden composite fitted to {curve.name}: R² {fit.goodness.r_squared:.3f}{error}; {stable}"
