"""Coverage and distance of the simple shapes a scene is made of, compiled."""

from __future__ import annotations

import math

from .kernel import kernel

STEEPEST = 1.5
"""No distance to a thing of a scene changes faster than this with the place on the board."""


@kernel
def stripe_mean(x, width, pitch, length):  # type: ignore[no-untyped-def]
    """Mean over a window of stripes: +1 on [0, pitch), -1 on [pitch, 2 pitch), ..., 0 outside [0, length]."""
    low, high = min(max(x - 0.5 * width, 0.0), length), min(max(x + 0.5 * width, 0.0), length)
    return (_triangle(high, pitch) - _triangle(low, pitch)) / width


@kernel
def _triangle(x, pitch):  # type: ignore[no-untyped-def]
    """Integral of the square wave from 0 to x."""
    phase = x % (2.0 * pitch)
    return phase if phase < pitch else 2.0 * pitch - phase


@kernel
def window_share(x, width, low, high):  # type: ignore[no-untyped-def]
    """Share of a window around x that lies between low and high; exact."""
    return max(0.0, min(high, x + 0.5 * width) - max(low, x - 0.5 * width)) / width


@kernel
def soft_step(distance, width):  # type: ignore[no-untyped-def]
    """Coverage of a window by a straight edge at a signed distance (negative: inside)."""
    return min(1.0, max(0.0, 0.5 - distance / width))


@kernel
def smooth_step(t):  # type: ignore[no-untyped-def]
    """Go from 0 at t = 0 to 1 at t = 1 without a kink."""
    t = min(1.0, max(0.0, t))
    return t * t * (3.0 - 2.0 * t)


@kernel
def disc_distance(x, y, disc):  # type: ignore[no-untyped-def]
    """Signed distance to a disc's rim."""
    return math.hypot(x - disc[0], y - disc[1]) - disc[3]


@kernel
def tube_place(x, y, tube):  # type: ignore[no-untyped-def]
    """Place along a wavy tube, and signed distance (negative left, positive right) to its axis."""
    dx, dy = x - tube[0], y - tube[1]
    u = dx * tube[2] + dy * tube[3]
    v = dy * tube[2] - dx * tube[3]
    number = 2.0 * math.pi / tube[7]
    slope = tube[6] * number * math.cos(number * u)
    return u, (v - tube[6] * math.sin(number * u)) / math.sqrt(1.0 + slope * slope)


@kernel
def box_distance(x, y, box):  # type: ignore[no-untyped-def]
    """Signed distance to a turned rectangle."""
    dx, dy = x - box[0], y - box[1]
    u = abs(dx * box[4] + dy * box[5]) - box[2]
    v = abs(dy * box[4] - dx * box[5]) - box[3]
    outside = math.hypot(max(u, 0.0), max(v, 0.0))
    return outside + min(max(u, v), 0.0)


@kernel
def segment_meets_box(x0, y0, x1, y1, box):  # type: ignore[no-untyped-def]
    """Tell whether a segment touches a turned rectangle (Liang and Barsky's clipping)."""
    ax, ay = x0 - box[0], y0 - box[1]
    bx, by = x1 - box[0], y1 - box[1]
    enter, leave = 0.0, 1.0
    for axis in range(2):
        if axis == 0:
            start, end, half = ax * box[4] + ay * box[5], bx * box[4] + by * box[5], box[2]
        else:
            start, end, half = ay * box[4] - ax * box[5], by * box[4] - bx * box[5], box[3]
        run = end - start
        if abs(run) < 1e-12:
            if abs(start) > half:
                return False
            continue
        first, second = (-half - start) / run, (half - start) / run
        enter = max(enter, min(first, second))
        leave = min(leave, max(first, second))
    return enter <= leave


@kernel
def _hash(i, j):  # type: ignore[no-untyped-def]
    """Return a number between -1 and 1 that looks random, for each lattice point."""
    h = (i * 374761393 + j * 668265263) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
    return ((h ^ (h >> 16)) & 0xFFFF) / 32767.5 - 1.0


@kernel
def value_noise(x, y):  # type: ignore[no-untyped-def]
    """Smooth noise of unit wavelength, between -1 and 1."""
    i, j = math.floor(x), math.floor(y)
    u, v = smooth_step(x - i), smooth_step(y - j)
    i, j = int(i), int(j)
    top = _hash(i, j) * (1.0 - u) + _hash(i + 1, j) * u
    bottom = _hash(i, j + 1) * (1.0 - u) + _hash(i + 1, j + 1) * u
    return top * (1.0 - v) + bottom * v
