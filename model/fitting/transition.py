"""The strain transition point of a bilinear material, by the article's procedure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.errors import InputError

from .measured_curve import FloatArray

PRIMARY_STRAIN = 0.10
"""The primary modulus is fitted to the strains up to this one (article: "the initial 10% strain")."""

SECONDARY_POINTS = 10
"""The secondary modulus is fitted to so many points at the end (article: "the last ten data points")."""

_FEWEST_PRIMARY = 3


@dataclass(frozen=True)
class Line:
    """A straight line through points of a stress-strain curve, stress = modulus·strain + intercept.

    Parameters
    ----------
    modulus_MPa, intercept_MPa : float
    """

    modulus_MPa: float
    intercept_MPa: float


@dataclass(frozen=True)
class StrainTransition:
    """Where the primary and the secondary line meet.

    Parameters
    ----------
    strain : float
        Engineering strain of the intersection.
    primary, secondary : Line
    """

    strain: float
    primary: Line
    secondary: Line

    @property
    def stress_MPa(self) -> float:
        """Nominal stress of the intersection."""
        return self.primary.modulus_MPa * self.strain + self.primary.intercept_MPa

    def relative_error_of(self, other: StrainTransition) -> float:
        """Return |other's strain − this one's| over this one's, as the article compares a law with a test."""
        return abs(other.strain - self.strain) / abs(self.strain)


def strain_transition(strain: FloatArray, stress_MPa: FloatArray, *, name: str) -> StrainTransition:
    """Find the strain transition point of a curve.

    Linear regression through the points up to 10 % strain gives the primary modulus, through the last ten
    points the secondary one; extrapolated, the lines meet at the transition point. On a fitted law, pass its
    stress at the measured strains, so that both are treated alike.

    Parameters
    ----------
    strain : array, shape (n,)
        Engineering strain of the first loading in tension, in rising order.
    stress_MPa : array, shape (n,)
        Nominal stress.
    name : str
        What the curve is called in messages.

    Raises
    ------
    InputError
        If there are too few points for the two lines, they overlap, the curve does not stiffen, or the lines
        meet outside it.

    References
    ----------
    The article, section "Modeling" of the bilinear material.
    """
    primary_points = np.flatnonzero((strain >= 0.0) & (strain <= PRIMARY_STRAIN))
    if len(primary_points) < _FEWEST_PRIMARY:
        raise InputError(
            f"{name}: {len(primary_points)} points lie below {PRIMARY_STRAIN:.0%} strain, the primary "
            f"modulus needs {_FEWEST_PRIMARY}; measure more densely"
        )
    last = np.arange(len(strain))[-SECONDARY_POINTS:]
    if len(last) < SECONDARY_POINTS or last[0] <= primary_points[-1]:
        raise InputError(
            f"{name}: the last {SECONDARY_POINTS} points, which give the secondary modulus, reach into the "
            f"first {PRIMARY_STRAIN:.0%} strain; measure more densely or further"
        )
    primary = _regression(strain[primary_points], stress_MPa[primary_points])
    secondary = _regression(strain[last], stress_MPa[last])
    if not secondary.modulus_MPa > primary.modulus_MPa:
        raise InputError(
            f"{name}: the modulus falls from {primary.modulus_MPa:.3g} to {secondary.modulus_MPa:.3g} MPa, "
            "so there is no transition to a stiffer range; pull the test further, or do without it"
        )
    crossing = (primary.intercept_MPa - secondary.intercept_MPa) / (
        secondary.modulus_MPa - primary.modulus_MPa
    )
    if not 0.0 < crossing < strain[-1]:
        raise InputError(
            f"{name}: the lines of the primary and the secondary modulus meet at {crossing:.1%} strain, "
            f"outside the test of 0 to {strain[-1]:.1%}, so there is no transition; pull the test further, "
            "or do without it"
        )
    return StrainTransition(float(crossing), primary, secondary)


def transition_or_none(strain: FloatArray, stress_MPa: FloatArray) -> StrainTransition | None:
    """Return the transition point of a fitted law's curve, or None where it has none."""
    try:
        return strain_transition(strain, stress_MPa, name="fitted law")
    except InputError:
        return None


def _regression(strain: FloatArray, stress: FloatArray) -> Line:
    slope, intercept = np.polynomial.Polynomial.fit(strain, stress, 1).convert().coef[::-1]
    return Line(float(slope), float(intercept))
