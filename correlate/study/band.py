"""The band around the modelled tip path that uncertain inputs leave."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from spavision.tip_path import FloatArray, TipPath

from .case import CaseResult, displacements

if TYPE_CHECKING:
    import pandas as pd

QUANTILES = (0.025, 0.5, 0.975)

_FEWEST = 4
"""Cases below which no spread is given."""


@dataclass(frozen=True)
class Band:
    """Scatter of the modelled tip displacement over the cases of a study, pressure by pressure.

    A case that did not reach a pressure is not in the numbers there, and `n_reached` says so: the band
    is then too narrow, for the cases that stop first are the softest.

    Parameters
    ----------
    nominal : TipPath
        With every parameter at its nominal value.
    sigma_mm : array, shape (2, n_pressures)
        Standard deviation of x and y: the input uncertainty u_input of V&V 20. NaN for fewer than four cases.
    quantiles_mm : array, shape (3, 2, n_pressures)
        At `QUANTILES`.
    n_reached : array, shape (n_pressures,)
    n_cases : int
    """

    nominal: TipPath
    sigma_mm: FloatArray
    quantiles_mm: FloatArray
    n_reached: NDArray[np.int64]
    n_cases: int

    def table(self) -> pd.DataFrame:
        """Return the band as a DataFrame, one row a pressure, in the columns of the CSV file."""
        import pandas as pd

        columns: dict[str, object] = {"pressure_kPa": self.nominal.pressure_kPa}
        for index, axis in enumerate("xy"):
            columns |= {
                f"nominal_u{axis}_mm": (self.nominal.ux_mm, self.nominal.uy_mm)[index],
                f"low_u{axis}_mm": self.quantiles_mm[0, index],
                f"median_u{axis}_mm": self.quantiles_mm[1, index],
                f"high_u{axis}_mm": self.quantiles_mm[2, index],
                f"u_input_u{axis}_mm": self.sigma_mm[index],
            }
        return pd.DataFrame(columns | {"n_reached": self.n_reached, "n_cases": self.n_cases})


def band(nominal: TipPath, results: Sequence[CaseResult]) -> Band:
    """Work out the band.

    Parameters
    ----------
    nominal : TipPath
    results : sequence of CaseResult
        At the nominal path's pressures.
    """
    values = displacements(results)
    reached = np.isfinite(values).all(axis=1).sum(axis=0)
    sigma = np.full(values.shape[1:], np.nan)
    quantiles = np.full((len(QUANTILES), *values.shape[1:]), np.nan)
    for row in np.flatnonzero(reached >= _FEWEST):
        found = values[:, :, row][np.isfinite(values[:, 0, row])]
        sigma[:, row] = found.std(axis=0, ddof=1)
        quantiles[:, :, row] = np.quantile(found, QUANTILES, axis=0)
    return Band(nominal, sigma, quantiles, reached, len(results))
