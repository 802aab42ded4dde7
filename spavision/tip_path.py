"""The tip path: the one table that the tracker, the model and the correlation share."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas as pd

FloatArray = NDArray[np.float64]

STATUSES = ("ok", "partial", "missing", "rejected")
"""What became of a reading: ``ok``, ``partial`` , ``missing``, or ``rejected`` (by hand)."""


@dataclass(frozen=True)
class TipPath:
    """Displacement of the actuator's tip against pressure.

    Axes: x horizontal, y along the hanging actuator, positive down. Displacements are relative to the
    reference state (lowest pressure); a reading that is missing holds NaN and keeps its row.

    Parameters
    ----------
    pressure_kPa, ux_mm, uy_mm : array, shape (n,)
        Gauge pressure and the two displacement components.
    sigma_ux_mm, sigma_uy_mm : array, shape (n,)
        Standard uncertainty (one sigma) of each component; NaN where unknown.
    photo : tuple of str, optional
        File name behind each reading; empty for a modelled path.
    status, reason : tuple of str, optional
        One of `STATUSES` for each photo, and why it is not ``ok``.

    Raises
    ------
    ValueError
        If the columns differ in length or a status is unknown.
    """

    pressure_kPa: FloatArray
    ux_mm: FloatArray
    uy_mm: FloatArray
    sigma_ux_mm: FloatArray
    sigma_uy_mm: FloatArray
    photo: tuple[str, ...] = field(default=())
    status: tuple[str, ...] = field(default=())
    reason: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        n = len(self.pressure_kPa)
        for name in ("ux_mm", "uy_mm", "sigma_ux_mm", "sigma_uy_mm"):
            if np.shape(getattr(self, name)) != (n,):
                raise ValueError(f"{name} has shape {np.shape(getattr(self, name))}, pressure_kPa has ({n},)")
        for name in ("photo", "status", "reason"):
            if len(getattr(self, name)) not in (0, n):
                raise ValueError(f"{name} has {len(getattr(self, name))} entries, pressure_kPa has {n}")
        unknown = set(self.status) - set(STATUSES)
        if unknown:
            raise ValueError(f"status {sorted(unknown)} is none of {STATUSES}")

    @classmethod
    def modelled(
        cls,
        pressure_kPa: FloatArray,
        ux_mm: FloatArray,
        uy_mm: FloatArray,
        *,
        status: tuple[str, ...] = (),
        reason: tuple[str, ...] = (),
    ) -> TipPath:
        """Return a path whose uncertainty is not known, as a model computes it."""
        unknown = np.full(len(pressure_kPa), np.nan)
        return cls(pressure_kPa, ux_mm, uy_mm, unknown, unknown.copy(), status=status, reason=reason)

    def __len__(self) -> int:
        return len(self.pressure_kPa)

    @property
    def has_reading(self) -> NDArray[np.bool_]:
        """Which rows hold a displacement, shape (n,)."""
        return np.isfinite(self.ux_mm) & np.isfinite(self.uy_mm)

    def readings(self) -> TipPath:
        """Return only the rows that hold a displacement, ordered by pressure."""
        keep = np.flatnonzero(self.has_reading)
        return self.take(keep[np.argsort(self.pressure_kPa[keep], kind="stable")])

    def take(self, rows: NDArray[np.intp]) -> TipPath:
        """Return the given rows, in the given order."""

        def pick(texts: tuple[str, ...]) -> tuple[str, ...]:
            return tuple(texts[row] for row in rows) if texts else ()

        return TipPath(
            pressure_kPa=self.pressure_kPa[rows],
            ux_mm=self.ux_mm[rows],
            uy_mm=self.uy_mm[rows],
            sigma_ux_mm=self.sigma_ux_mm[rows],
            sigma_uy_mm=self.sigma_uy_mm[rows],
            photo=pick(self.photo),
            status=pick(self.status),
            reason=pick(self.reason),
        )

    def table(self) -> pd.DataFrame:
        """Return the path as a DataFrame, one row a reading, in the columns of the CSV file."""
        import pandas as pd

        columns: dict[str, object] = {"photo": list(self.photo)} if self.photo else {}
        columns |= {
            name: getattr(self, name)
            for name in ("pressure_kPa", "ux_mm", "uy_mm", "sigma_ux_mm", "sigma_uy_mm")
        }
        for name in ("status", "reason"):
            if getattr(self, name):
                columns[name] = list(getattr(self, name))
        return pd.DataFrame(columns)
