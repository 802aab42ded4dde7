"""How far the model is from the measurement at equal pressures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from spavision.errors import InputError
from spavision.tip_path import FloatArray, TipPath

if TYPE_CHECKING:
    import pandas as pd

SAME_PRESSURE_kPa = 1e-6
"""Two pressures closer than this are one pressure written twice; nothing is interpolated."""


@dataclass(frozen=True)
class ComponentError:
    """Root mean square of one component's comparison error over the common pressures.

    Parameters
    ----------
    rmse_mm : float
        Root mean square error.
    nrmse : float
        The same over the range of the measured component; NaN where the measurement does not move.
    bias_mm : float
        Mean error, modelled minus measured.
    """

    rmse_mm: float
    nrmse: float
    bias_mm: float


@dataclass(frozen=True)
class Discrepancy:
    """Measured and modelled tip path, row by row at the same pressures.

    The comparison error is E = S − D, simulation minus data (ASME V&V 20-2009, section 1-5).

    Parameters
    ----------
    measured, modelled : TipPath
        Paths of equal length and equal pressures; a gap on either side holds NaN.
    """

    measured: TipPath
    modelled: TipPath

    @property
    def pressure_kPa(self) -> FloatArray:
        """Pressures, shape (n,)."""
        return self.measured.pressure_kPa

    @property
    def error_ux_mm(self) -> FloatArray:
        """Comparison error of the x component, modelled minus measured, shape (n,)."""
        return self.modelled.ux_mm - self.measured.ux_mm

    @property
    def error_uy_mm(self) -> FloatArray:
        """Comparison error of the y component, modelled minus measured, shape (n,)."""
        return self.modelled.uy_mm - self.measured.uy_mm

    @property
    def distance_mm(self) -> FloatArray:
        """Distance between the two tips, shape (n,)."""
        return np.hypot(self.error_ux_mm, self.error_uy_mm)

    @property
    def is_common(self) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Rows in which both sides hold a displacement, shape (n,)."""
        return self.measured.has_reading & self.modelled.has_reading

    @property
    def x(self) -> ComponentError:
        """Summary of the x component."""
        return _component_error(self.error_ux_mm, self.measured.ux_mm)

    @property
    def y(self) -> ComponentError:
        """Summary of the y component."""
        return _component_error(self.error_uy_mm, self.measured.uy_mm)

    @property
    def largest(self) -> int:
        """Row of the largest distance."""
        return int(np.nanargmax(self.distance_mm))

    def table(self) -> pd.DataFrame:
        """Return the comparison as a DataFrame, one row a pressure, in the columns of the CSV file."""
        import pandas as pd

        columns: dict[str, object] = {
            "pressure_kPa": self.pressure_kPa,
            "measured_ux_mm": self.measured.ux_mm,
            "measured_uy_mm": self.measured.uy_mm,
            "sigma_ux_mm": self.measured.sigma_ux_mm,
            "sigma_uy_mm": self.measured.sigma_uy_mm,
            "modelled_ux_mm": self.modelled.ux_mm,
            "modelled_uy_mm": self.modelled.uy_mm,
            "error_ux_mm": self.error_ux_mm,
            "error_uy_mm": self.error_uy_mm,
            "distance_mm": self.distance_mm,
            "remark": [self.remark(row) for row in range(len(self.pressure_kPa))],
        }
        return pd.DataFrame(columns)

    def remark(self, row: int) -> str:
        """Say why a row lacks a reading or is not a plain one; empty for a plain row."""
        sides = (("measured", self.measured), ("modelled", self.modelled))
        return "; ".join(
            f"{side}: {path.status[row]}" + (f" ({path.reason[row]})" if path.reason else "")
            for side, path in sides
            if path.status and path.status[row] != "ok"
        )


def compare(measured: TipPath, modelled: TipPath) -> Discrepancy:
    """Pair the two paths at equal pressures.

    Every measured pressure keeps its row; where the model has no such pressure, its side is a gap. Nothing is
    interpolated and nothing extrapolated.

    Parameters
    ----------
    measured, modelled : TipPath
        Both with x positive in the direction of the first bending mode.

    Raises
    ------
    InputError
        If no pressure holds a displacement on both sides.
    """
    order = np.argsort(measured.pressure_kPa, kind="stable")
    measured = measured.take(order)
    discrepancy = Discrepancy(measured=measured, modelled=_at_pressures(modelled, measured.pressure_kPa))
    if not np.any(discrepancy.is_common):
        raise InputError(
            f"measured ({_range_of(measured)}) and modelled ({_range_of(modelled)}) paths share no pressure "
            "with a reading; measure or simulate at the same pressures"
        )
    return discrepancy


def in_bending_axes(path: TipPath, *, first_bend: str) -> TipPath:
    """Turn a path of the photos into the model's axes: x positive in the direction of the first bend."""
    if first_bend == "right":
        return path
    return TipPath(
        pressure_kPa=path.pressure_kPa,
        ux_mm=-path.ux_mm,
        uy_mm=path.uy_mm,
        sigma_ux_mm=path.sigma_ux_mm,
        sigma_uy_mm=path.sigma_uy_mm,
        photo=path.photo,
        status=path.status,
        reason=path.reason,
    )


def _at_pressures(path: TipPath, pressure_kPa: FloatArray) -> TipPath:
    apart = np.abs(pressure_kPa[:, None] - path.pressure_kPa[None, :])
    row = np.argmin(apart, axis=1)
    found = apart[np.arange(len(row)), row] <= SAME_PRESSURE_kPa

    def pick(values: FloatArray) -> FloatArray:
        return np.where(found, values[row], np.nan)

    def pick_text(texts: tuple[str, ...], otherwise: str) -> tuple[str, ...]:
        return tuple(
            (texts[r] if texts else "ok") if ok else otherwise for r, ok in zip(row, found, strict=True)
        )

    return TipPath(
        pressure_kPa=pressure_kPa,
        ux_mm=pick(path.ux_mm),
        uy_mm=pick(path.uy_mm),
        sigma_ux_mm=pick(path.sigma_ux_mm),
        sigma_uy_mm=pick(path.sigma_uy_mm),
        status=pick_text(path.status, "missing"),
        reason=pick_text(path.reason or ("",) * len(path), "not computed at this pressure"),
    )


def _component_error(error_mm: FloatArray, measured_mm: FloatArray) -> ComponentError:
    common = np.isfinite(error_mm)
    rmse = float(np.sqrt(np.mean(error_mm[common] ** 2)))
    span = float(np.ptp(measured_mm[common]))
    return ComponentError(
        rmse_mm=rmse,
        nrmse=rmse / span if span > 0 else float("nan"),
        bias_mm=float(np.mean(error_mm[common])),
    )


def _range_of(path: TipPath) -> str:
    pressure = path.readings().pressure_kPa
    return f"{pressure.min():g} to {pressure.max():g} kPa" if len(pressure) else "no reading"
