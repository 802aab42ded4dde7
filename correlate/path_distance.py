"""Distance between two paths in the x-y plane, whatever the pressures along them."""

from __future__ import annotations

import numpy as np

from spavision.tip_path import FloatArray, TipPath


def discrete_frechet_mm(measured: TipPath, modelled: TipPath) -> float:
    """Return the discrete Fréchet distance between the two tip paths, in mm.

    The shortest leash that lets both be walked from end to end, forwards only, from reading to reading.

    Raises
    ------
    ValueError
        If one of the paths holds no reading.

    References
    ----------
    T. Eiter, H. Mannila, Computing discrete Fréchet distance, TU Wien CD-TR 94/64 (1994).
    """
    a, b = _points(measured), _points(modelled)
    if not len(a) or not len(b):
        raise ValueError("a path without a reading has no distance")
    apart = np.hypot(a[:, None, 0] - b[None, :, 0], a[:, None, 1] - b[None, :, 1])
    leash = np.empty_like(apart)
    leash[0] = np.maximum.accumulate(apart[0])
    leash[:, 0] = np.maximum.accumulate(apart[:, 0])
    for i in range(1, len(a)):
        for j in range(1, len(b)):
            before = min(leash[i - 1, j], leash[i, j - 1], leash[i - 1, j - 1])
            leash[i, j] = max(apart[i, j], before)
    return float(leash[-1, -1])


def _points(path: TipPath) -> FloatArray:
    readings = path.readings()
    return np.column_stack([readings.ux_mm, readings.uy_mm])
