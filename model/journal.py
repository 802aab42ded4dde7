"""The journal of a ramp: a record of each step, and the fields at the asked pressures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .continuation import AcceptedStep
from .elements import FloatArray
from .equilibrium import Equilibrium, State
from .newton import NewtonResult
from .ramp_path import RampPlace
from .simulation import StepRecord


@dataclass(frozen=True)
class Checkpoint:
    """What a pressure ramp has done so far, and all that it needs to go on.

    Parameters
    ----------
    place : RampPlace
    steps : tuple of StepRecord
    displacement_mm : array, shape (n_pressures, n_nodes, 3)
        NaN where not yet reached.
    enclosed_volume_mm3 : array, shape (n_pressures,)
    energy_at_rest_mJ, gravity_work_at_rest_mJ : float
        Of the half model, from which the records count.
    """

    place: RampPlace
    steps: tuple[StepRecord, ...]
    displacement_mm: FloatArray
    enclosed_volume_mm3: FloatArray
    energy_at_rest_mJ: float
    gravity_work_at_rest_mJ: float


class Journal:
    """Collects steps, and fields at the asked pressures, as the ramp goes."""

    def __init__(
        self, problem: Equilibrium, pressures_kPa: FloatArray, progress: Callable[[float], None] | None
    ) -> None:
        self._problem = problem
        self._pressures = pressures_kPa
        self._progress = progress
        self.steps: list[StepRecord] = []
        self.displacement_mm = np.full((len(pressures_kPa), len(problem.mesh.nodes_mm), 3), np.nan)
        self.enclosed_volume_mm3 = np.full(len(pressures_kPa), np.nan)

    def begin(self, hanging: NewtonResult) -> None:
        """Note the state at zero pressure, from which energies are counted."""
        self._first_energy = self._problem.strain_energy(hanging.state)
        self._first_gravity_work = self._problem.gravity_work(hanging.state)
        self.add(AcceptedStep(0.0, hanging))

    def go_on(self, checkpoint: Checkpoint) -> None:
        """Take up what an interrupted ramp had noted."""
        self._first_energy = checkpoint.energy_at_rest_mJ
        self._first_gravity_work = checkpoint.gravity_work_at_rest_mJ
        self.steps = list(checkpoint.steps)
        self.displacement_mm = checkpoint.displacement_mm.copy()
        self.enclosed_volume_mm3 = checkpoint.enclosed_volume_mm3.copy()

    def checkpoint(self, place: RampPlace) -> Checkpoint:
        """Return what is noted so far, to go on from a place."""
        return Checkpoint(
            place=place,
            steps=tuple(self.steps),
            displacement_mm=self.displacement_mm,
            enclosed_volume_mm3=self.enclosed_volume_mm3,
            energy_at_rest_mJ=self._first_energy,
            gravity_work_at_rest_mJ=self._first_gravity_work,
        )

    def add(self, step: AcceptedStep) -> None:
        """Note an accepted step."""
        state = step.result.state
        # Twice: the model is one half of the actuator.
        volume = 2.0 * self._problem.enclosed_volume_mm3(state)
        self.steps.append(
            StepRecord(
                pressure_kPa=step.pressure_kPa,
                newton_iterations=step.result.iterations,
                residual=step.result.residuals[-1],
                negative_pivots=step.result.negative_pivots,
                enclosed_volume_mm3=volume,
                strain_energy_mJ=2.0 * (self._problem.strain_energy(state) - self._first_energy),
                gas_work_mJ=self._gas_work_mJ(step.pressure_kPa, volume),
                gravity_work_mJ=self._gravity_work_mJ(state),
                released_mJ=self._released_mJ(step),
            )
        )
        for row in np.flatnonzero(self._pressures == step.pressure_kPa):
            self.displacement_mm[row] = state.displacement
            self.enclosed_volume_mm3[row] = volume
        if self._progress is not None:
            self._progress(step.pressure_kPa)

    def _gas_work_mJ(self, pressure_kPa: float, volume_mm3: float) -> float:
        if not self.steps:
            return 0.0
        last = self.steps[-1]
        mean_MPa = 0.5e-3 * (last.pressure_kPa + pressure_kPa)
        return last.gas_work_mJ + mean_MPa * (volume_mm3 - last.enclosed_volume_mm3)

    def _released_mJ(self, step: AcceptedStep) -> float:
        before_mJ = self.steps[-1].released_mJ if self.steps else 0.0
        return before_mJ + 2.0 * step.released_mJ

    def _gravity_work_mJ(self, state: State) -> float:
        return 2.0 * (self._problem.gravity_work(state) - self._first_gravity_work)
