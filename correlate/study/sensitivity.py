"""Which suspects move the tip: local slopes from the model, Sobol indices from its emulator."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from SALib.analyze import sobol as sobol_analysis
from SALib.sample import sobol as sobol_sample

from spavision.tip_path import FloatArray

from .case import CaseResult, displacements
from .emulator import Emulator
from .sampling import one_at_a_time
from .suspects import Suspect

if TYPE_CHECKING:
    import pandas as pd

_BASE_POINTS = 1024
_STILL_MM = 1e-6
_INSIDE = 1e-6


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
    change_mm : array, shape (2, n_pressures)
        Of x and y, from the lower to the upper end; for a choice, from the first to the last option.
    """

    suspect: Suspect
    change_mm: FloatArray


def local_sensitivities(
    suspects: tuple[Suspect, ...], results: Sequence[CaseResult]
) -> tuple[LocalSensitivity, ...]:
    """Take the slopes from the results of `one_at_a_time`, in its order."""
    values = displacements(results)
    names = [next(iter(case)) for case in one_at_a_time(suspects)]
    found = []
    for one in suspects:
        rows = [row for row, name in enumerate(names) if name == one.name]
        found.append(LocalSensitivity(one, values[rows[-1]] - values[rows[0]]))
    return tuple(found)


def local_table(found: Sequence[LocalSensitivity], pressure_kPa: FloatArray) -> pd.DataFrame:
    """Return one row for each suspect and pressure: the change of x and y from end to end."""
    import pandas as pd

    rows = [
        {
            "suspect": one.suspect.name,
            "low": one.suspect.interval[0],
            "high": one.suspect.interval[1],
            "pressure_kPa": pressure,
            "change_ux_mm": one.change_mm[0, k],
            "change_uy_mm": one.change_mm[1, k],
        }
        for one in found
        for k, pressure in enumerate(pressure_kPa)
    ]
    return pd.DataFrame(rows)
