"""Linear least squares under linear inequalities, solved exactly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

FloatArray = NDArray[np.float64]

_RIDGE = 1e-8
"""Share of a column's length that is added in a direction of its own, so that no matrix is singular."""


def constrained_least_squares(
    matrix: FloatArray, target: FloatArray, inequalities: FloatArray, margins: FloatArray
) -> tuple[FloatArray, NDArray[np.int64]]:
    """Minimise |matrix·x − target| under inequalities·x ≥ margins.

    A convex problem with one minimum, turned by a QR factorisation into one of least distance and that into
    one of non-negative least squares.

    Parameters
    ----------
    matrix : array, shape (n, k)
    target : array, shape (n,)
    inequalities : array, shape (m, k)
    margins : array, shape (m,)

    Returns
    -------
    x : array, shape (k,)
    active : array of int
        Numbers of the inequalities that hold the solution back.

    Raises
    ------
    ValueError
        If no x satisfies the inequalities.

    References
    ----------
    C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, SIAM 1995, chapter 23.
    """
    scale = np.linalg.norm(matrix, axis=0)
    scale[scale == 0.0] = 1.0
    width = matrix.shape[1]
    q, r = np.linalg.qr(np.vstack([matrix / scale, _RIDGE * np.eye(width)]))
    free = q[: len(target)].T @ target
    constraints = np.linalg.solve(r.T, (inequalities / scale).T)
    length = np.linalg.norm(constraints, axis=0)
    length[length == 0.0] = 1.0
    constraints = constraints / length
    lacking = margins / length - free @ constraints
    if np.all(lacking <= 0.0):
        return np.linalg.solve(r, free) / scale, np.empty(0, dtype=np.int64)
    stacked = np.vstack([constraints, lacking])
    goal = np.append(np.zeros(width), 1.0)
    multipliers, distance = nnls(stacked, goal)
    if distance < 1e-12:
        raise ValueError("no solution satisfies the inequalities")
    rest = stacked @ multipliers - goal
    x = np.linalg.solve(r, free - rest[:width] / rest[width]) / scale
    return x, np.flatnonzero(multipliers > 0.0)
