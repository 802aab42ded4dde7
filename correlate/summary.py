"""The comparison in words and numbers: what the terminal prints and the report opens with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.tip_path import TipPath

from .alignment import Alignment, best_scale, best_shift
from .discrepancy import Discrepancy
from .modes import Modes, find_modes
from .path_distance import discrete_frechet_mm
from .validation import ModelUncertainty, Validation, validate


@dataclass(frozen=True)
class Summary:
    """Every figure that sums a comparison up.

    Parameters
    ----------
    measured_modes, modelled_modes : Modes
        Extremum, reversal and second direction of each side.
    frechet_mm : float
        Distance between the two paths in the x-y plane, whatever the pressures.
    shift, scale : Alignment or None
        Best pressure correction of each kind; None with too few readings.
    validation_x, validation_y : Validation
        Each component's error against its validation uncertainty.
    """

    discrepancy: Discrepancy
    measured_modes: Modes
    modelled_modes: Modes
    frechet_mm: float
    shift: Alignment | None
    scale: Alignment | None
    validation_x: Validation
    validation_y: Validation

    def sentences(self) -> list[str]:
        """Say the main findings, one sentence each."""
        return [
            self._largest(),
            self._rmse(),
            self._verdict(),
            _mode_sentence("measured", self.measured_modes),
            _mode_sentence("modelled", self.modelled_modes),
            *self._alignment(),
            f"Pressure left aside, the paths are {self.frechet_mm:.1f} mm apart (discrete Fréchet distance).",
            *self._gaps(),
        ]

    def _largest(self) -> str:
        d = self.discrepancy
        return (
            f"The model is furthest from the measurement at {d.pressure_kPa[d.largest]:g} kPa: "
            f"{d.distance_mm[d.largest]:.1f} mm (x {d.error_ux_mm[d.largest]:+.1f} mm, "
            f"y {d.error_uy_mm[d.largest]:+.1f} mm, modelled minus measured)."
        )

    def _rmse(self) -> str:
        parts = []
        for name, component in (("x", self.discrepancy.x), ("y", self.discrepancy.y)):
            share = f" ({component.nrmse:.0%} of the measured range)" if np.isfinite(component.nrmse) else ""
            parts.append(f"{component.rmse_mm:.1f} mm in {name}{share}")
        return f"Root mean square error: {' and '.join(parts)}."

    def _verdict(self) -> str:
        common = self.discrepancy.is_common
        counts = [
            f"{int(np.sum(validation.is_significant & common))} in {name}"
            for name, validation in (("x", self.validation_x), ("y", self.validation_y))
        ]
        missing = [
            f"{' and '.join(names)} not estimated{where}"
            for names, where in (
                (self.validation_x.left_out, ""),
                (self.validation_x.left_out_in_part, " at every pressure"),
            )
            if names
        ]
        caveat = f" ({', '.join(missing)}, so it is a lower bound)" if missing else ""
        if not any(np.any(v.is_significant & common) for v in (self.validation_x, self.validation_y)):
            return (
                f"Nowhere does the error exceed twice the validation uncertainty{caveat}: "
                "model and measurement do not differ significantly (V&V 20)."
            )
        return (
            f"The error exceeds twice the validation uncertainty{caveat} at {' and '.join(counts)} "
            f"of {int(common.sum())} pressures: there model and measurement differ significantly (V&V 20)."
        )

    def _alignment(self) -> list[str]:
        found = [alignment for alignment in (self.shift, self.scale) if alignment is not None]
        if not found:
            return ["Too few readings to tell a pressure error from a shape error."]
        sentences = []
        for alignment in found:
            how = (
                f"A pressure shift of {alignment.value:+.1f} kPa"
                if alignment.kind == "shift"
                else f"A pressure scale of {alignment.value:.2f}"
            )
            sentences.append(
                f"{how} of the model would bring the error from "
                f"{alignment.rmse_before_mm:.1f} to {alignment.rmse_after_mm:.1f} mm over "
                f"{alignment.readings} readings: {alignment.explained:.0%} "
                "of the squared error is of that kind, the rest is shape."
            )
        return sentences

    def _gaps(self) -> list[str]:
        d = self.discrepancy
        gaps = [f"{p:g}" for p, common in zip(d.pressure_kPa, d.is_common, strict=True) if not common]
        return [f"No comparison at {', '.join(gaps)} kPa: one side has no reading."] if gaps else []


def summarise(discrepancy: Discrepancy, model: ModelUncertainty | None = None) -> Summary:
    """Compute every figure of the summary from a comparison.

    Parameters
    ----------
    discrepancy : Discrepancy
    model : ModelUncertainty, optional
        What is known of the model's own uncertainty.
    """
    validation_x, validation_y = validate(discrepancy, model or ModelUncertainty())
    measured, modelled = discrepancy.measured, discrepancy.modelled
    return Summary(
        discrepancy=discrepancy,
        measured_modes=find_modes(measured),
        modelled_modes=find_modes(modelled),
        frechet_mm=_frechet_over_common(discrepancy),
        shift=best_shift(measured, modelled),
        scale=best_scale(measured, modelled),
        validation_x=validation_x,
        validation_y=validation_y,
    )


def _frechet_over_common(discrepancy: Discrepancy) -> float:
    rows = np.flatnonzero(discrepancy.is_common)
    both: tuple[TipPath, TipPath] = (discrepancy.measured.take(rows), discrepancy.modelled.take(rows))
    return discrete_frechet_mm(*both)


def _mode_sentence(side: str, modes: Modes) -> str:
    top = f"x reaches {modes.first_extremum_mm:.1f} mm at {modes.first_extremum_kPa:.0f} kPa"
    if not modes.reverses:
        return f"First mode, {side}: {top}, the last reading; no change of mode is seen."
    crossing = (
        f", passing its rest position at {modes.crosses_zero_kPa:.0f} kPa"
        if np.isfinite(modes.crosses_zero_kPa)
        else ""
    )
    return (
        f"First mode, {side}: {top}; second mode: back to {modes.second_extreme_mm:.1f} mm "
        f"at {modes.second_extreme_kPa:.0f} kPa{crossing}."
    )
