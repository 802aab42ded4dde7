"""Where an incompressible law is stable in Drucker's sense, in the three standard tests."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from .curves import MODES, LockingLaw, Mode, locking_stretches
from .solid import IsotropicLaw

FloatArray = NDArray[np.float64]

SEARCH_LIMITS = (0.1, 10.0)
"""Stretches between which the ends of the stable range are looked for."""

_STEPS = 400
"""Points on each side of 1 in that search; a narrower unstable band could be missed."""

_ROUNDING = 1e-14

VOLUME_PRESERVING = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, -1.0]])
"""Log strains of an incompressible body, as combinations of the first two."""


@dataclass(frozen=True)
class StableRange:
    """Range of stretch around 1 in which a law is stable in one test.

    Parameters
    ----------
    mode : str
    lowest, highest : float
        Ends of the range; equal to the limits of the search where nothing was found.
    lowest_is_found, highest_is_found : bool
        Whether instability (or locking) begins there.
    """

    mode: str
    lowest: float
    highest: float
    lowest_is_found: bool
    highest_is_found: bool

    def covers(self, lowest: float, highest: float) -> bool:
        """Whether the law is stable all the way from one stretch to the other."""
        below = not self.lowest_is_found or lowest >= self.lowest
        return below and (not self.highest_is_found or highest <= self.highest)

    def __str__(self) -> str:
        low = f"{self.lowest:.3g}" if self.lowest_is_found else f"{self.lowest:g} or less"
        high = f"{self.highest:.3g}" if self.highest_is_found else f"{self.highest:g} or more"
        return f"{self.mode}: stretch {low} to {high}"


def incremental_moduli(second: FloatArray) -> FloatArray:
    """Reduce second derivatives of the energy to volume-preserving increments, (n, 3, 3) to (n, 2, 2).

    They relate increments of Kirchhoff stress to increments of the log strains in fixed principal directions,
    any pressure being free.
    """
    return np.einsum("ia,nij,jb->nab", VOLUME_PRESERVING, second, VOLUME_PRESERVING)


def drucker_margin(law: IsotropicLaw, stretch: FloatArray, mode: Mode) -> FloatArray:
    """Return the smaller eigenvalue of the incremental moduli over the law's shear modulus, (n,).

    Positive where dτ : d(ln V) > 0 for every volume-preserving increment (Drucker's and Hill's condition, the
    check that finite-element programs print); 2 at rest; NaN beyond locking. Rounding of the larger
    eigenvalue is forgiven.
    """
    return stability_margin(law, mode.log_stretch(stretch))


def stability_margin(law: IsotropicLaw, log_stretch: FloatArray) -> FloatArray:
    """Return `drucker_margin` at any isochoric log stretches, (n, 3) to (n,)."""
    _, second = law.derivatives(log_stretch)
    moduli = incremental_moduli(second)
    mean = 0.5 * (moduli[:, 0, 0] + moduli[:, 1, 1])
    radius = np.hypot(0.5 * (moduli[:, 0, 0] - moduli[:, 1, 1]), moduli[:, 0, 1])
    return (mean - radius + _ROUNDING * (mean + radius)) / law.shear_modulus_MPa


def stable_range(law: IsotropicLaw, mode: Mode) -> StableRange:
    """Find the range of stretch around 1 in which a law is stable in one test."""
    limits = list(SEARCH_LIMITS)
    locked = [False, False]
    if isinstance(law, LockingLaw):
        for end, locking in enumerate(locking_stretches(law, mode)):
            if abs(np.log(locking)) < abs(np.log(limits[end])):
                limits[end], locked[end] = locking, True
    lowest, low_found = _first_instability(law, mode, limits[0], locked=locked[0])
    highest, high_found = _first_instability(law, mode, limits[1], locked=locked[1])
    return StableRange(mode.name, lowest, highest, low_found, high_found)


def stable_ranges(law: IsotropicLaw) -> dict[str, StableRange]:
    """Find the stable range of a law in each of the three tests."""
    return {name: stable_range(law, mode) for name, mode in MODES.items()}


def _first_instability(law: IsotropicLaw, mode: Mode, limit: float, *, locked: bool) -> tuple[float, bool]:
    """Walk from 1 towards the limit; return where the margin first vanishes, or the limit."""
    log_limit = np.log(limit)
    steps = np.linspace(0.0, log_limit, _STEPS + 1)[: -1 if locked else None]
    margin = drucker_margin(law, np.exp(steps), mode)
    unstable = np.flatnonzero(~(margin > 0.0))
    if len(unstable) == 0:
        return limit, locked
    first = unstable[0]
    if first == 0:
        return 1.0, True

    def margin_at(log_stretch: float) -> float:
        return float(drucker_margin(law, np.exp([log_stretch]), mode)[0])

    return float(np.exp(brentq(margin_at, steps[first - 1], steps[first]))), True
