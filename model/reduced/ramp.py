"""The pressure ramp of the reduced model."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from spavision.errors import InputError
from spavision.model.elements import FloatArray
from spavision.model.geometry import ActuatorGeometry
from spavision.model.newton import NewtonSettings, NotConvergedError
from spavision.model.simulate import checked_pressures
from spavision.model.simulation import SimulationSettings
from spavision.tip_path import TipPath

from .cell import Cell, CellResponse, SectionLoad
from .one_thread import one_thread
from .rod import RodShape, hang

LARGEST_VOLUME_RATIO = 3.3
"""V/V₀ up to which the reduced model is meant: its tip is then within 2 mm of the full model's.

Beyond, cells balloon and those at the clamp and the end wall, which hold them, lag behind the others, which
the row of alike cells leaves out: 5 mm at V/V₀ 4 to 4.7, 12 to 18 mm at 5.4 to 6.8
(benchmarks/study_reduced_model.py).
"""

_LARGEST_STEP_KPA = 5.0
_SMALLEST_STEP_KPA = 0.2
_TIGHTER = 20.0


@dataclass(frozen=True)
class ReducedSimulation:
    """What the reduced model found.

    Parameters
    ----------
    tip_path : TipPath
        One row for each asked pressure; beyond the model's range its reason says so.
    volume_ratio : array, shape (n_pressures,)
        Of the cells' gas, V/V₀; NaN where not reached.
    axis_mm : array, shape (n_pressures, n_cells + 1, 2)
        Axis points; NaN where not reached.
    """

    tip_path: TipPath
    volume_ratio: FloatArray
    axis_mm: FloatArray


def simulate_reduced(
    geometry: ActuatorGeometry,
    *,
    crimp_ratio: float,
    pressures_kPa: FloatArray,
    settings: SimulationSettings | None = None,
) -> ReducedSimulation:
    """Inflate a hanging row of alike cells.

    One cell in three dimensions, in pure bending and tension, is carried along the ramp at the mean load of
    the row; its compliance there gives the other cells' response. Left out: the channel through the walls,
    shear, the clamp's hold on the first cell and the end wall of the last.

    Parameters
    ----------
    geometry : ActuatorGeometry
    crimp_ratio : float
    pressures_kPa : array, shape (n,)
        Increasing, 0 or more.
    settings : SimulationSettings, optional
        Mesh level, materials, paper, gravity and Newton's settings are used.

    Raises
    ------
    InputError
        If pressures, crimp ratio, material names or mesh level are unusable, or the clamp holds a length.
    """
    settings, pressures_kPa = settings or SimulationSettings(), checked_pressures(pressures_kPa)
    if geometry.clamp_length_mm > 0.0:
        raise InputError(
            f"clamp_length_mm is {geometry.clamp_length_mm:g}, which the reduced model does not know; "
            "take the full model, or 0"
        )
    with one_thread():
        return _inflated(geometry, crimp_ratio, pressures_kPa, settings)


def _inflated(
    geometry: ActuatorGeometry, crimp_ratio: float, pressures_kPa: FloatArray, settings: SimulationSettings
) -> ReducedSimulation:
    cell = Cell(geometry, crimp_ratio=crimp_ratio, settings=settings)
    count = geometry.void_count
    axis = np.full((len(pressures_kPa), count + 1, 2), np.nan)
    marker = np.full((len(pressures_kPa), 2), np.nan)
    volume_ratio = np.full(len(pressures_kPa), np.nan)
    row_of_cells = _Row(cell, count, cell.mass_tonne if settings.gravity else 0.0, settings)
    reason = ""
    for row, target in enumerate(pressures_kPa):
        try:
            response, shape = row_of_cells.inflate(float(target))
        except (NotConvergedError, ArithmeticError) as error:
            reason = f"the reduced model stopped at {row_of_cells.reached_kPa:.4g} kPa: {error}"
            break
        axis[row], volume_ratio[row] = shape.points_mm, response.volume_ratio
        marker[row] = _marker(shape, geometry, cell.axis_x_mm)
    return ReducedSimulation(_tip_path(pressures_kPa, marker, volume_ratio, reason), volume_ratio, axis)


def _tightened(newton: NewtonSettings) -> NewtonSettings:
    """Converge further than the full model: an error of one cell's angle is an error of every cell's."""
    return replace(
        newton,
        correction_tolerance_mm=newton.correction_tolerance_mm / _TIGHTER,
        residual_tolerance=newton.residual_tolerance / _TIGHTER,
    )


class _Row:
    """A cell and the row of cells like it, on the way up."""

    def __init__(self, cell: Cell, n_cells: int, mass_tonne: float, settings: SimulationSettings) -> None:
        self._cell, self._n_cells, self._mass_tonne = cell, n_cells, mass_tonne
        self._newton, self._tilt = _tightened(settings.newton), float(np.deg2rad(settings.gravity_tilt_deg))
        self._shape: RodShape | None = None
        self._step_kPa = _LARGEST_STEP_KPA
        self.reached_kPa = 0.0

    def inflate(self, target_kPa: float) -> tuple[CellResponse, RodShape]:
        """Go on to a pressure in steps, halved where the cell finds no equilibrium.

        Raises
        ------
        NotConvergedError, ArithmeticError
            If a step no larger than `_SMALLEST_STEP_KPA` fails.
        """
        while True:
            parts = max(1, int(np.ceil((target_kPa - self.reached_kPa) / self._step_kPa - 1e-9)))
            size = (target_kPa - self.reached_kPa) / parts
            try:
                result = self._step(self.reached_kPa + size if parts > 1 else target_kPa)
            except NotConvergedError:
                if size <= _SMALLEST_STEP_KPA:
                    raise
                self._step_kPa = 0.5 * size
                continue
            self._step_kPa = min(1.5 * self._step_kPa, _LARGEST_STEP_KPA)
            if parts == 1:
                return result

    def _step(self, pressure_kPa: float) -> tuple[CellResponse, RodShape]:
        """Inflate the cell, which bears the mean load of the row one step before."""
        moment, tension = (0.0, 0.0) if self._shape is None else _mean_load(self._shape)
        response = self._cell.respond(SectionLoad(1e-3 * pressure_kPa, moment, tension), self._newton)
        self._shape = hang(
            response,
            n_cells=self._n_cells,
            mass_tonne=self._mass_tonne,
            start=self._shape,
            tilt=self._tilt,
        )
        self.reached_kPa = pressure_kPa
        return response, self._shape


def _mean_load(shape: RodShape) -> tuple[float, float]:
    return float(shape.moments_Nmm.mean()), float(shape.tensions_N.mean())


def _marker(shape: RodShape, geometry: ActuatorGeometry, axis_x_mm: float) -> FloatArray:
    """Position of the tracked point, between the faces of the cell that carries it."""
    x, y, _ = geometry.marker_position_mm
    at = y / geometry.pitch_mm
    cell = min(int(at), geometry.void_count - 1)
    share = at - cell
    angle = (1.0 - share) * shape.angles[cell] + share * shape.angles[cell + 1]
    point = (1.0 - share) * shape.points_mm[cell] + share * shape.points_mm[cell + 1]
    return np.asarray(point + (x - axis_x_mm) * np.array([np.cos(angle), -np.sin(angle)]))


def _tip_path(
    pressures_kPa: FloatArray, marker_mm: FloatArray, volume_ratio: FloatArray, reason: str
) -> TipPath:
    relative = marker_mm - marker_mm[0]
    status, reasons = [], []
    for ratio in volume_ratio:
        if not np.isfinite(ratio):
            status.append("missing")
            reasons.append(reason)
        elif ratio > LARGEST_VOLUME_RATIO:
            status.append("ok")
            reasons.append(
                f"beyond the reduced model's range: V/V₀ is {ratio:.2f}, expected up to "
                f"{LARGEST_VOLUME_RATIO:g}"
            )
        else:
            status.append("ok")
            reasons.append("")
    return TipPath.modelled(
        pressures_kPa, relative[:, 0], relative[:, 1], status=tuple(status), reason=tuple(reasons)
    )
