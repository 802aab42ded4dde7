"""The figures of merit of a simulation as rows and sentences."""

from __future__ import annotations

from typing import TYPE_CHECKING

from spavision.table_text import number

if TYPE_CHECKING:
    from spavision.model.outputs import DesignOutputs, StretchUse


def design_rows(outputs: DesignOutputs) -> list[list[str]]:
    """Return a printed table's rows: quantity, value, remark."""
    turned = outputs.mode_change_kPa is not None
    rows = [
        [
            "pressure of the mode change, kPa",
            number(outputs.mode_change_kPa) if outputs.mode_change_kPa is not None else "–",
            "" if turned else "x does not turn round within these pressures",
        ],
        ["first extremum of x, mm", number(outputs.first_extremum_mm), "" if turned else "largest x"],
        [
            "secondary displacement, mm",
            number(outputs.secondary_displacement_mm)
            if outputs.secondary_displacement_mm is not None
            else "–",
            "way back of x from there",
        ],
        [
            "enclosed volume, mm³",
            number(outputs.enclosed_volume_mm3, 0),
            f"{outputs.volume_ratio:.2f} times the volume at rest",
        ],
    ]
    return rows + [_stretch_row(use) for use in outputs.stretch]


def path_warnings(outputs: DesignOutputs) -> list[str]:
    """Return a sentence for each thing that sets the computed path apart from a real actuator's."""
    warnings = []
    if outputs.touches_itself_from_kPa is not None:
        warnings.append(
            f"from {outputs.touches_itself_from_kPa:g} kPa on the actuator passes through itself; contact is "
            "not modelled, so that the real one would go another way"
        )
    if outputs.loses_stability_at_kPa is not None:
        warnings.append(
            f"from {outputs.loses_stability_at_kPa:.4g} kPa on the path is not stable: the real actuator "
            "may buckle or snap away from it"
        )
    if outputs.snaps_from_kPa is not None:
        warnings.append(
            f"at {outputs.snaps_from_kPa:.4g} kPa the path folds back and the actuator snaps to the next "
            f"stable shape ({outputs.released_mJ:.2g} mJ given off in all such snaps); often one corner of a "
            "thin wall folds, which a finer mesh does at another pressure"
        )
    return warnings


def stretch_warnings(outputs: DesignOutputs) -> list[str]:
    """Return a sentence for each material that is stretched beyond its calibration or unstable."""
    warnings = []
    if outputs.unstable is not None:
        warnings.append(
            f"from {outputs.unstable_from_kPa:g} kPa on {outputs.unstable}; results beyond mean little"
            + (
                "; use --composite slack-fibre or resolved"
                if outputs.unstable.region == "composite"
                else "; choose another law or refit it (spavision fit)"
            )
        )
    return warnings + [
        f"{use.material} is stretched to {use.largest_stretch:.2f} at {use.pressure_kPa:g} kPa, beyond "
        f"{use.calibrated[1]:.2f}, to which its law was calibrated"
        for use in outputs.stretch
        if use.is_beyond and use.calibrated is not None
    ]


def _stretch_row(use: StretchUse) -> list[str]:
    if use.calibrated is None:
        remark = "range of calibration not known"
    else:
        remark = f"calibrated {use.calibrated[0]:.2f} to {use.calibrated[1]:.2f}"
    return [f"largest stretch, {use.material}", number(use.largest_stretch), remark]
