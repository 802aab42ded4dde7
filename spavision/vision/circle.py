"""Robust circles through edge points: free radius, known radius, and how much of the rim they rest on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import BoolArray, FloatArray

REACH_SIGMAS = 2.5


@dataclass(frozen=True)
class Circle:
    """A circle fitted to edge points.

    Parameters
    ----------
    centre : array, shape (2,)
        In the points' unit.
    radius : float
        In the points' unit.
    rms : float
        Root mean square distance of the supporting points from the circle.
    covariance : array, shape (2, 2)
        Of the centre.
    support : bool array, shape (n,)
        Points that lie on the circle within the noise.
    radius_slope : array, shape (2,)
        Derivative of the centre by the radius, where the radius was taken as known; zero otherwise.
    coverage : float
        Share of the full turn that the supporting points cover.
    """

    centre: FloatArray
    radius: float
    rms: float
    covariance: FloatArray
    radius_slope: FloatArray
    support: BoolArray
    coverage: float


def fit_circle(points: FloatArray, *, radius: float | None = None) -> Circle | None:
    """Fit a circle, its radius free or known, that most of the points agree on.

    A consensus over triples (or pairs, for a known radius) starts the fit; Gauss-Newton with Cauchy weights
    ends it. None when fewer than eight points agree.

    Parameters
    ----------
    points : array, shape (n, 2)
        Edge points; rows of NaN are left out of the fit.
    radius : float, optional
        Known radius, in the points' unit.
    """
    usable = np.flatnonzero(np.isfinite(points).all(axis=1))
    if len(usable) < 8:
        return None
    chosen = points[usable]
    start = _consensus(chosen, radius)
    if start is None:
        return None
    centre, found_radius = start
    sigma = np.inf
    for _ in range(30):
        offset = chosen - centre
        length = np.maximum(np.linalg.norm(offset, axis=1), 1e-12)
        error = length - found_radius
        scale = max(1.4826 * float(np.median(np.abs(error[np.abs(error) < 0.3 * found_radius]))), 1e-9)
        sigma = min(sigma, scale) if np.isfinite(sigma) else scale
        weight = 1.0 / (1.0 + (error / (REACH_SIGMAS * sigma)) ** 2) ** 2
        design = np.column_stack([-offset / length[:, None], -np.ones(len(chosen))])
        if radius is not None:
            design = design[:, :2]
        step = np.linalg.lstsq(
            design.T @ (weight[:, None] * design), -design.T @ (weight * error), rcond=None
        )[0]
        centre = centre + step[:2]
        if radius is None:
            found_radius = found_radius + float(step[2])
        if np.linalg.norm(step[:2]) < 1e-9 * found_radius:
            break
    return _judge(points, centre, found_radius, known=radius is not None)


def _consensus(points: FloatArray, radius: float | None) -> tuple[FloatArray, float] | None:
    """Best of many circles through few points: the one that most points lie near."""
    n = len(points)
    random = np.random.default_rng(n)
    if radius is None:
        triples = points[random.integers(0, n, (400, 3))]
        centres, radii = _through_three(triples)
    else:
        pairs = points[random.integers(0, n, (400, 2))]
        half = 0.5 * (pairs[:, 1] - pairs[:, 0])
        length = np.linalg.norm(half, axis=1)
        height = np.sqrt(np.maximum(radius**2 - length**2, 0.0)) / np.maximum(length, 1e-12)
        normal = np.column_stack([-half[:, 1], half[:, 0]]) * height[:, None]
        middle = pairs.mean(axis=1)
        centres = np.concatenate([middle + normal, middle - normal])
        good = np.tile((length > 0.05 * radius) & (length <= radius), 2)
        centres, radii = centres[good], np.full(int(good.sum()), radius)
    # A straight edge is a circle too, of huge radius: the points' own extent bounds it.
    sane = np.isfinite(radii) & (radii < 0.8 * np.ptp(points, axis=0).max())
    centres, radii = centres[sane], radii[sane]
    if len(radii) == 0:
        return None
    error = np.abs(np.linalg.norm(points[None] - centres[:, None], axis=2) - radii[:, None]) / radii[:, None]
    votes = np.maximum(0.0, 1.0 - (error / 0.06) ** 2).sum(axis=1)
    best = int(np.argmax(votes))
    return (centres[best], float(radii[best])) if votes[best] > 4 else None


def _through_three(triples: FloatArray) -> tuple[FloatArray, FloatArray]:
    a, b, c = triples[:, 0], triples[:, 1], triples[:, 2]
    ab, ac = b - a, c - a
    cross = 2.0 * (ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0])
    cross = np.where(np.abs(cross) > 1e-12, cross, np.nan)
    square_ab, square_ac = (ab**2).sum(axis=1), (ac**2).sum(axis=1)
    ux = (ac[:, 1] * square_ab - ab[:, 1] * square_ac) / cross
    uy = (ab[:, 0] * square_ac - ac[:, 0] * square_ab) / cross
    return a + np.column_stack([ux, uy]), np.hypot(ux, uy)


def _judge(points: FloatArray, centre: FloatArray, radius: float, *, known: bool) -> Circle | None:
    """Supporting points, coverage and covariance of a fitted circle."""
    with np.errstate(invalid="ignore"):
        offset = points - centre
        length = np.linalg.norm(offset, axis=1)
        error = length - radius
        near = np.abs(error) < 0.3 * radius
        sigma = 1.4826 * float(np.median(np.abs(error[near]))) if near.any() else np.inf
        support = np.abs(error) < max(3.0 * min(sigma, 0.05 * radius), 0.01 * radius)
    if support.sum() < 8 or not np.isfinite(radius):
        return None
    rms = float(np.sqrt(np.mean(error[support] ** 2)))
    angle = np.arctan2(offset[support, 1], offset[support, 0])
    sectors = np.unique(np.floor((angle + np.pi) / (2 * np.pi) * 36).astype(int) % 36)
    design = offset[support] / length[support][:, None]
    slope = -np.linalg.pinv(design).sum(axis=1) if known else np.zeros(2)
    if not known:
        design = np.column_stack([design, np.ones(len(design))])
    covariance = rms**2 * np.linalg.pinv(design.T @ design)[:2, :2]
    return Circle(centre, float(radius), rms, covariance, slope, support, len(sectors) / 36.0)
