"""Which suspects move the tip: local slopes from the model, Sobol indices from its emulator."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from SALib.analyze import sobol as sobol_analysis
from SALib.sample import sobol as sobol_sample
from scipy.sparse.csgraph import connected_components

from spavision.tip_path import FloatArray

from .case import CaseResult, displacements
from .emulator import Emulator
from .parameters import Value
from .sampling import one_at_a_time
from .suspects import Suspect

if TYPE_CHECKING:
    import pandas as pd

_BASE_POINTS = 1024
_STILL_MM = 1e-6
_INSIDE = 1e-6

_SMALL_CHANGE = 0.1
"""Share of the largest change below which a suspect moves the tip by too little to speak of."""

_ALIKE = 0.97
"""Cosine beyond which 6 % or less of a change's square is not proportional to the other's."""


@dataclass(frozen=True)
class SobolIndices:
    """Shares of the variance of the tip displacement, of each component at each pressure.

    Parameters
    ----------
    names : tuple of str
    pressure_kPa : array, shape (n_pressures,)
    first, total : array, shape (n_suspects, 2, n_pressures)
        Share that a suspect has alone, and with all its interactions; NaN where the tip does not move.
    first_half_width, total_half_width : array, same shape
        Half the 95 % interval of each, from resampling.
    """

    names: tuple[str, ...]
    pressure_kPa: FloatArray
    first: FloatArray
    total: FloatArray
    first_half_width: FloatArray
    total_half_width: FloatArray

    def table(self) -> pd.DataFrame:
        """Return one row for each suspect, component and pressure."""
        import pandas as pd

        rows = [
            {
                "suspect": name,
                "component": "xy"[axis],
                "pressure_kPa": pressure,
                "first_order": self.first[i, axis, k],
                "first_order_half_width": self.first_half_width[i, axis, k],
                "total": self.total[i, axis, k],
                "total_half_width": self.total_half_width[i, axis, k],
            }
            for i, name in enumerate(self.names)
            for axis in range(2)
            for k, pressure in enumerate(self.pressure_kPa)
        ]
        return pd.DataFrame(rows)


def sobol_indices(emulator: Emulator, pressure_kPa: FloatArray, *, seed: int) -> SobolIndices:
    """Work out the Sobol indices of the tip displacement on the emulator (Saltelli's scheme, SALib)."""
    names = tuple(one.name for one in emulator.suspects)
    problem = {
        "num_vars": len(names),
        "names": list(names),
        "bounds": [[_INSIDE, 1.0 - _INSIDE]] * len(names),
    }
    points = sobol_sample.sample(problem, _BASE_POINTS, calc_second_order=False, seed=seed)
    outputs = emulator.predict(points)
    found = np.full((4, len(names), 2, len(pressure_kPa)), np.nan)
    for axis in range(2):
        for k in range(len(pressure_kPa)):
            values = outputs[:, axis, k]
            if np.std(values) < _STILL_MM:
                continue
            indices = sobol_analysis.analyze(
                problem, (values - values.mean()) / values.std(), calc_second_order=False, seed=seed
            )
            found[:, :, axis, k] = [indices[key] for key in ("S1", "ST", "S1_conf", "ST_conf")]
    return SobolIndices(names, pressure_kPa, *found)


@dataclass(frozen=True)
class LocalSensitivity:
    """How the tip moves when one suspect alone goes from end to end of its 95 % interval.

    Parameters
    ----------
    suspect : Suspect
    ends : tuple of float or str
        From which value to which; of a choice, the two options that are furthest apart.
    change_mm : array, shape (2, n_pressures)
        Of x and y.
    """

    suspect: Suspect
    ends: tuple[Value, Value]
    change_mm: FloatArray


@dataclass(frozen=True)
class Likeness:
    """Suspects that move the tip alike, so that a tip path hardly tells one from another.

    Parameters
    ----------
    names : tuple of str
    cosine : float
        Least one of those that link them, of the angle between their changes over all pressures, without its
        sign: 1 where they are proportional.
    """

    names: tuple[str, ...]
    cosine: float

    def sentence(self) -> str:
        """Say it."""
        names = f"{', '.join(self.names[:-1])} and {self.names[-1]}"
        return (
            f"{names} move the tip alike (cosine {self.cosine:.3f} or more): the path hardly tells one from "
            "another."
        )


def local_sensitivities(
    suspects: tuple[Suspect, ...], results: Sequence[CaseResult]
) -> tuple[LocalSensitivity, ...]:
    """Take the changes from the results of `one_at_a_time`, in its order."""
    values = displacements(results)
    cases = [next(iter(case.items())) for case in one_at_a_time(suspects)]
    found = []
    for one in suspects:
        rows = [row for row, (name, _) in enumerate(cases) if name == one.name]
        first, last = max(
            itertools.combinations(rows, 2),
            key=lambda pair: np.nansum((values[pair[1]] - values[pair[0]]) ** 2),
        )
        ends = cases[first][1], cases[last][1]
        found.append(LocalSensitivity(one, ends, values[last] - values[first]))
    return tuple(found)


def likenesses(found: Sequence[LocalSensitivity]) -> list[Likeness]:
    """Return the groups of suspects that move the tip alike and by much, each linked to one of its group."""
    changes = np.array([np.nan_to_num(one.change_mm).ravel() for one in found])
    sizes = np.linalg.norm(changes, axis=1)
    moving = np.flatnonzero((sizes > _SMALL_CHANGE * sizes.max()) & (sizes > 0.0))
    directions = changes[moving] / sizes[moving, None]
    cosines = np.abs(directions @ directions.T)
    count, group = connected_components(cosines > _ALIKE, directed=False)
    members = [np.flatnonzero(group == index) for index in range(count)]
    linked = [(rows, cosines[np.ix_(rows, rows)]) for rows in members if len(rows) > 1]
    return [
        Likeness(tuple(found[moving[row]].suspect.name for row in rows), float(block[block > _ALIKE].min()))
        for rows, block in linked
    ]


def local_table(found: Sequence[LocalSensitivity], pressure_kPa: FloatArray) -> pd.DataFrame:
    """Return one row for each suspect and pressure: the change of x and y from end to end."""
    import pandas as pd

    rows = [
        {
            "suspect": one.suspect.name,
            "low": one.ends[0],
            "high": one.ends[1],
            "pressure_kPa": pressure,
            "change_ux_mm": one.change_mm[0, k],
            "change_uy_mm": one.change_mm[1, k],
        }
        for one in found
        for k, pressure in enumerate(pressure_kPa)
    ]
    return pd.DataFrame(rows)
