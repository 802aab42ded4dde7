"""The marker's rim to a fraction of a pixel: radial profiles, half contrast."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .arrays import FloatArray, FloatImage, sample
from .board import BoardView
from .camera import project, to_plane
from .circle import Circle, fit_circle

N_RAYS = 96
SAMPLES_PER_RADIUS = 24
OUTER_RADII = 1.9
"""Length of a ray, in radii."""

SIDES = ((0.3, 0.65), (1.35, 1.75))
"""Where along a ray the levels inside and outside are taken, in radii."""


@dataclass(frozen=True)
class Rim:
    """Edge points of a marker candidate.

    Parameters
    ----------
    pixels : array, shape (n, 2)
        One point a ray, in order of angle; NaN where a ray shows no edge.
    contrast : float
        Step between inside and outside over the scatter of colours there, where an edge is seen.
    """

    pixels: FloatArray
    contrast: float


def find_rim(
    image: FloatImage, board: BoardView, centre_px: FloatArray, radius_squares: float, inside: FloatArray
) -> tuple[Rim, Circle] | None:
    """Find a spot's rim about an approximate centre, and the circle through it in squares of the board.

    Rays run in the plane of the board, so that a tilted camera's ellipse becomes a circle.

    Parameters
    ----------
    image : float32 array, shape (height, width, 3)
        Colours, lightly smoothed where they are noisy.
    board : BoardView
        The board's lattice in this photograph.
    centre_px : array, shape (2,)
        Approximate centre.
    radius_squares : float
        Approximate radius, in squares of the board.
    inside : array, shape (3,)
        Colour of the spot.
    """
    looks: list[tuple[Rim, Circle]] = []
    for separation in SEPARATIONS:
        look = _look(image, board, centre_px, radius_squares, inside, separation)
        if look is not None:
            looks.append(look)
            if _share_seen(look) == 1.0:
                break
    # Where both see as much, always the first: half contrast lies elsewhere in the other's colours, and the
    # rims of a series are compared.
    return max(looks, key=_share_seen, default=None)


def _share_seen(look: tuple[Rim, Circle]) -> float:
    """Share of the rim that a look rests on, to a tenth."""
    return round(look[1].coverage, 1)


def _look(
    image: FloatImage,
    board: BoardView,
    centre_px: FloatArray,
    radius_squares: float,
    inside: FloatArray,
    separation: Separation,
) -> tuple[Rim, Circle] | None:
    """Find the rim with one way of telling inside from outside, closing in on its centre."""
    centre, radius = centre_px, radius_squares
    found = None
    for _ in range(3):
        rim = _edges(image, board, centre, radius, inside, separation)
        circle = None if rim is None else fit_circle(to_plane(board.camera, board.pose, rim.pixels))
        if rim is None or circle is None:
            return None
        found = rim, circle
        # A wild radius means a shape that is no disc; the approximate one is kept for the next look.
        radius = circle.radius if 0.6 < circle.radius / radius_squares < 1.6 else radius
        centre = project(board.camera, board.pose, circle.centre[None])[0]
    return found


def _edges(
    image: FloatImage,
    board: BoardView,
    centre_px: FloatArray,
    radius: float,
    inside: FloatArray,
    separation: Separation,
) -> Rim | None:
    """Half-contrast crossings along rays about a centre."""
    profiles, distances, angles = _profiles(image, board, centre_px, radius)
    inner = profiles[:, distances < 0.6].reshape(-1, 3)
    outer = profiles[:, (distances > 1.3) & (distances < 1.7)].reshape(-1, 3)
    step = inside - np.median(outer, axis=0)
    direction = np.linalg.solve(separation(inner, outer, profiles), step)
    length = float(step @ direction)
    if length < 1e-6:
        return None
    values = (profiles - inside) @ (direction / length)  # 0 inside, −1 at the typical outside
    crossing = _half_contrast(values, distances)
    found = np.isfinite(crossing)
    if not found.any():
        return None
    centre = to_plane(board.camera, board.pose, centre_px[None])[0]
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    points = centre + (radius * crossing)[:, None] * ring
    pixels = np.full((N_RAYS, 2), np.nan)
    pixels[found] = project(board.camera, board.pose, points[found])
    by_channel = _contrast(profiles[found], distances, 4.0 * np.ones(3))
    # On the bare board black and white lie about the spot: along one direction of colour they are alike.
    along = _contrast(values[found, :, None], distances, 4.0 * (direction @ direction)[None] / length**2)
    return Rim(pixels, max(by_channel, along))


def _contrast(profiles: FloatArray, distances: FloatArray, noise: FloatArray) -> float:
    """Step across the rim over the scatter of values on either side, along rays that show an edge.

    Medians, for near its border a cover's colour shows on those rays too. Profiles have shape (rays, samples,
    channels), ``noise`` holds the least variance of each channel.
    """
    middle, variance = np.zeros((2, profiles.shape[2])), noise
    for side, (low, high) in enumerate(SIDES):
        values = profiles[:, (distances > low) & (distances < high)].reshape(-1, profiles.shape[2])
        middle[side] = np.median(values, axis=0)
        variance = variance + (1.4826 * np.median(np.abs(values - middle[side]), axis=0)) ** 2
    return float(np.sqrt(((middle[0] - middle[1]) ** 2 / variance).sum()))


def _scatter(inner: FloatArray, outer: FloatArray, _profiles: FloatArray) -> FloatArray:
    """Scatter of colours on either side (Fisher's discriminant): highlights and shading drop out."""
    return np.asarray(np.cov(inner.T) + np.cov(outer.T) + 4.0 * np.eye(3))


def _noise(_inner: FloatArray, _outer: FloatArray, profiles: FloatArray) -> FloatArray:
    """Noise of the pixels alone: a cover, whose colour is part of either side's scatter, does no harm."""
    jumps = np.diff(profiles[:, :: SAMPLES_PER_RADIUS // 6], axis=1).reshape(-1, 3)
    return np.asarray(np.diag((1.4826 * np.median(np.abs(jumps), axis=0)) ** 2 / 2.0 + 2.0))


Separation = Callable[[FloatArray, FloatArray, FloatArray], FloatArray]
SEPARATIONS: tuple[Separation, ...] = (_scatter, _noise)
"""Covariances against which the colour step across the rim is weighed; the better look is kept."""


def _profiles(
    image: FloatImage, board: BoardView, centre_px: FloatArray, radius: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Colours along rays: shape (rays, samples, 3); distances in radii; angles."""
    angles = np.arange(N_RAYS, dtype=float) * (2.0 * np.pi / N_RAYS)
    distances = np.arange(int(OUTER_RADII * SAMPLES_PER_RADIUS), dtype=float) / SAMPLES_PER_RADIUS
    centre = to_plane(board.camera, board.pose, centre_px[None])[0]
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    points = centre + radius * distances[None, :, None] * ring[:, None, :]
    pixels = project(board.camera, board.pose, points.reshape(-1, 2)).reshape(N_RAYS, len(distances), 2)
    sampled = sample(image, pixels)
    return sampled.astype(float), distances, angles


def _half_contrast(values: FloatArray, distances: FloatArray) -> FloatArray:
    """Distance of the half-contrast crossing along each ray, NaN where there is none.

    Values are 0 in the spot's colour and −1 in the typical colour outside. Each ray's own levels inside
    and outside (`SIDES`), taken with its neighbours', set its half contrast. Just within the crossing the
    spot's colour must show: a highlight farther in does no harm, the edge of a cover does not count.
    """
    padded = np.pad(values, ((0, 0), (1, 1)), "edge")
    smooth = 0.25 * padded[:, :-2] + 0.5 * padded[:, 1:-1] + 0.25 * padded[:, 2:]
    near, far = ((distances > low) & (distances < high) for low, high in SIDES)
    inside = np.clip(_circular_median(np.median(smooth[:, near], axis=1), 9), -0.2, 0.2)
    outside = _circular_median(np.median(smooth[:, far], axis=1), 9)
    half = 0.5 * (inside + outside)
    below = smooth < half[:, None]
    falls = ~below[:, :-1] & below[:, 1:] & (distances[None, 1:] > 0.4)
    crossing = np.full(len(values), np.nan)
    for ray in np.flatnonzero((inside - outside > 0.35) & falls.any(axis=1)):
        places = np.flatnonzero(falls[ray])
        place = places[np.argmin(np.abs(distances[places] - 1.0))]
        within = smooth[ray, (distances > distances[place] - 0.4) & (distances < distances[place] - 0.15)]
        if within.max() < inside[ray] - 0.3:
            continue
        before, after = smooth[ray, place], smooth[ray, place + 1]
        share = (before - half[ray]) / max(before - after, 1e-12)
        crossing[ray] = distances[place] + share * (distances[place + 1] - distances[place])
    return crossing


def _circular_median(values: FloatArray, width: int) -> FloatArray:
    half = width // 2
    padded = np.concatenate([values[-half:], values, values[:half]])
    return np.median(np.lib.stride_tricks.sliding_window_view(padded, width), axis=1)
