"""The virtual tensile test: pull the cell until the paper tears, sampled as a testing machine does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from spavision.errors import InputError
from spavision.model.elements import FloatArray
from spavision.model.fitting.measured_curve import MeasuredCurve
from spavision.model.fitting.transition import StrainTransition, strain_transition
from spavision.model.linear_solver import LinearSolver, linear_solver
from spavision.model.materials.curves import PLANAR, UNIAXIAL
from spavision.model.materials.solid import SolidMaterial
from spavision.model.reduced.one_thread import one_thread

from .cell import Cell, CellSettings, CellState
from .geometry import CouponGeometry
from .paper import Paper
from .tension import NotPulledError, Pulled, pull_to

LATERAL = {"plane-strain": PLANAR, "plane-stress": UNIAXIAL}
"""How the width is held, and the standard test that a homogeneous coupon would be in."""

LARGEST_STRAIN = 3.0

_SMALLEST_STEP = 1e-6
_PAST_STRAIGHT = 0.1
"""Without a tear the pull ends so far beyond the strain at which the paper is straight."""

_MOST_SECANTS = 20
_TEAR_TOLERANCE = 1e-3
"""Of the strength, when the last strain is adjusted to it."""


@dataclass(frozen=True)
class CouponSettings:
    """How the coupon is pulled.

    Parameters
    ----------
    strain_step : float
        Strain from one point of the curve to the next. Through «the last ten points» it enters the
        secondary modulus, as the sampling of a real test does. Assumed.
    end_strain : float or None
        Where the test ends if the paper has not torn before; None: a tenth beyond the strain at which the
        paper is straight.
    cell : CellSettings
    """

    strain_step: float = 0.005
    end_strain: float | None = None
    cell: CellSettings = field(default_factory=CellSettings)

    def last_strain(self, geometry: CouponGeometry) -> float:
        """Return the strain at which the test ends unless the paper tears before.

        Raises
        ------
        InputError
            If a setting is out of range.
        """
        if self.cell.lateral not in LATERAL:
            raise InputError(f"lateral is {self.cell.lateral!r}, expected one of {', '.join(LATERAL)}")
        if not 1e-4 <= self.strain_step <= 0.1:
            raise InputError(f"strain step is {self.strain_step:g}, expected 0.0001 to 0.1")
        if self.end_strain is None:
            return geometry.straight_strain + _PAST_STRAIGHT
        if not self.strain_step <= self.end_strain <= LARGEST_STRAIN:
            raise InputError(
                f"end strain is {self.end_strain:g}, expected from the strain step {self.strain_step:g} "
                f"to {LARGEST_STRAIN:g}"
            )
        return self.end_strain


@dataclass(frozen=True)
class Coupon:
    """A virtual tensile test.

    Parameters
    ----------
    cell : Cell
    settings : CouponSettings
    strain : array, shape (n,)
        Engineering strain along the actuator, from 0.
    stress_MPa : array, shape (n,)
        Nominal, over the whole layer.
    paper_tension_MPa : array, shape (n,)
        Largest tension in the paper, mean over its thickness.
    matrix_stretch : array, shape (n,)
        Largest principal stretch of the matrix.
    width_strain : array, shape (n,)
        Strain along z.
    states : tuple of CellState
    ended_by : str
        ``tear``, ``end strain``, or why no further equilibrium was found.
    """

    cell: Cell
    settings: CouponSettings
    strain: FloatArray
    stress_MPa: FloatArray
    paper_tension_MPa: FloatArray
    matrix_stretch: FloatArray
    width_strain: FloatArray
    states: tuple[CellState, ...]
    ended_by: str

    def transition(self) -> StrainTransition:
        """Return primary and secondary modulus and the transition point by the article's procedure.

        Raises
        ------
        InputError
            If the curve has none.
        """
        return strain_transition(self.strain, self.stress_MPa, name=self.name)

    @property
    def matrix(self) -> SolidMaterial:
        """Material of the matrix."""
        return self.cell.matrix

    @property
    def name(self) -> str:
        """What the coupon is called in messages."""
        return f"coupon of crimp ratio {self.cell.geometry.crimp_ratio:g}"

    def curve(self) -> MeasuredCurve:
        """Return the coupon's curve as the fits take it."""
        mode = LATERAL[self.settings.cell.lateral]
        return MeasuredCurve(self.name, mode, 1.0 + self.strain, self.stress_MPa)


def pull_coupon(
    geometry: CouponGeometry,
    *,
    matrix: SolidMaterial,
    paper: Paper,
    settings: CouponSettings | None = None,
    progress: Callable[[float], None] | None = None,
) -> Coupon:
    """Pull the periodic cell until the paper tears or the end strain is reached.

    Parameters
    ----------
    geometry : CouponGeometry
    matrix : SolidMaterial
    paper : Paper
    settings : CouponSettings, optional
    progress : callable, optional
        Told the strain after each point.

    Raises
    ------
    InputError
        If a setting is out of range, or the paper does not fit into the layer.
    """
    settings = settings or CouponSettings()
    end = settings.last_strain(geometry)
    if paper.modulus_MPa > 0.0:
        geometry.refuse_thick_paper(paper.thickness_mm)
    with one_thread():
        test = _Test(Cell(geometry, matrix=matrix, paper=paper, settings=settings.cell))
        while test.ended_by == "" and test.strains[-1] < end - 1e-12:
            test.go_on(min(test.strains[-1] + settings.strain_step, end))
            if progress is not None:
                progress(test.strains[-1])
    return test.collected(settings)


class _Test:
    """A test under way: the points so far, and what has ended it."""

    def __init__(self, cell: Cell) -> None:
        rest = cell.at_rest()
        balance = cell.balance(rest)
        assert balance is not None
        self._cell = cell
        self._solver = linear_solver()
        self._points = [Pulled(rest, balance, 0)]
        self._strength_N_per_mm = cell.beam.paper.strength_MPa * cell.beam.paper.thickness_mm
        self.strains = [0.0]
        self.ended_by = ""

    def go_on(self, strain: float) -> None:
        """Pull to a strain, or to where the paper tears on the way there."""
        start, reached = self._points[-1], self.strains[-1]
        try:
            point = _reach(self._cell, start.state, reached, strain, self._solver)
            if _tension(point) > self._strength_N_per_mm:
                strain, point = self._tear(strain, _tension(point))
                self.ended_by = "tear"
        except NotPulledError as error:
            self.ended_by = str(error)
            return
        self._points.append(point)
        self.strains.append(strain)

    def collected(self, settings: CouponSettings) -> Coupon:
        """Return the test made."""
        cell, points = self._cell, self._points
        pull = np.array([point.balance.forces[-1] for point in points])
        tension = np.array([_tension(point) for point in points])
        return Coupon(
            cell=cell,
            settings=settings,
            strain=np.array(self.strains),
            stress_MPa=pull / cell.geometry.thickness_mm,
            paper_tension_MPa=tension / cell.beam.paper.thickness_mm,
            matrix_stretch=np.exp([point.balance.kinematics.log_stretch.max() for point in points]),
            width_strain=np.array([cell.fields(point.state)[0][-1, 2] for point in points]),
            states=tuple(point.state for point in points),
            ended_by=self.ended_by or "end strain",
        )

    def _tear(self, strain: float, beyond: float) -> tuple[float, Pulled]:
        """Find the strain at which the paper's tension reaches its strength, by the secant method."""
        start, reached = self._points[-1], self.strains[-1]
        known = [(reached, _tension(start)), (strain, beyond)]
        point, tear = start, reached
        for _ in range(_MOST_SECANTS):
            (first, low), (second, high) = known[-2:]
            slope = (high - low) / (second - first)
            tear = float(np.clip(first + (self._strength_N_per_mm - low) / slope, reached, strain))
            point = _reach(self._cell, start.state, reached, tear, self._solver)
            if abs(_tension(point) - self._strength_N_per_mm) < _TEAR_TOLERANCE * self._strength_N_per_mm:
                break
            known.append((tear, _tension(point)))
        return tear, point


def _reach(cell: Cell, start: CellState, reached: float, target: float, solver: LinearSolver) -> Pulled:
    """Pull to a strain, in smaller steps where Newton's method asks for them."""
    step = target - reached
    while True:
        try:
            point = pull_to(cell, start, min(reached + step, target), solver=solver)
        except NotPulledError:
            step *= 0.5
            if step < _SMALLEST_STEP:
                raise
            continue
        start, reached = point.state, reached + step
        if reached >= target - 1e-12:
            return point


def _tension(point: Pulled) -> float:
    """Largest tension of the paper, in N/mm."""
    return float(point.balance.beam.tension.max())
