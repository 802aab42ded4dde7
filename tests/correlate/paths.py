"""Tip paths for the tests of the comparison."""

import numpy as np

from spavision.tip_path import TipPath


def make_path(pressure, ux, uy, **texts):
    pressure = np.asarray(pressure, dtype=float)
    return TipPath(
        pressure_kPa=pressure,
        ux_mm=np.asarray(ux, dtype=float),
        uy_mm=np.asarray(uy, dtype=float),
        sigma_ux_mm=np.full(len(pressure), 0.02),
        sigma_uy_mm=np.full(len(pressure), 0.02),
        **texts,
    )
