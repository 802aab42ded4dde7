"""First sight of the actuator in the rectified picture: walked from the marker up to the clamp."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from .arrays import BoolArray, FloatArray, FloatImage
from .rectified import LARGEST_STRANGENESS, PIXELS_A_SQUARE

STRANGE = 0.5 * LARGEST_STRANGENESS
"""Strangeness from which a pixel counts as not the board."""

CLOSING_SQUARES = 1.75
"""Gaps up to this size are filled: a white layer over white squares looks like the board."""

LARGEST_HOLE_SQUARES = 8.0
"""Area of a hole that is filled, for the same reason."""

START_REACH_SQUARES = 10.0
FIRST_STEPS = 6
"""Steps from which the width is learnt."""

WIDEST_SQUARES = 24.0
WIDTH_RANGE = (0.7, 1.3)
"""Half-width against the usual one within which an edge is believed."""

LOOK_AHEAD_SQUARES = 6
"""A stretch without believable edges up to this length may be something that crosses behind."""

FEWEST_CLAMP_STEPS = 2
"""Steps into the clamp that show it, where the photo or the board ends soon after."""

FEWEST_STEPS = 12
MOST_STEPS = 400
HUE_CHANGE = 0.12
DIMMED = 0.35
"""A change of the colours' shares, or a drop of brightness to this share, that ends the actuator."""


class UnclearError(Exception):
    """The silhouette cannot be told; the message says why."""


@dataclass(frozen=True)
class Limb:
    """The actuator as first walked along, from the clamp to the tip, in rectified pixels.

    Parameters
    ----------
    centres : array, shape (n, 2)
        Points midway between the edges, about a square apart.
    half_width : float
        Half the usual width.
    """

    centres: FloatArray
    half_width: float


@dataclass(frozen=True)
class _Section:
    """The mask across the walking direction: where it ends on either side, and what lies between."""

    left: float
    right: float
    colour: FloatArray


def silhouette_mask(strangeness: FloatImage) -> BoolArray:
    """Return the pixels that are not the board; outside the photograph False."""
    strange = (np.nan_to_num(strangeness) > STRANGE).astype(np.uint8)
    speckless = cv2.medianBlur(strange, 3)
    reach = round(CLOSING_SQUARES * PIXELS_A_SQUARE)
    closed = cv2.morphologyEx(speckless, cv2.MORPH_CLOSE, np.ones((reach, reach), np.uint8))
    _, holes, sizes, _ = cv2.connectedComponentsWithStats(1 - closed)
    small = sizes[:, cv2.CC_STAT_AREA] < LARGEST_HOLE_SQUARES * PIXELS_A_SQUARE**2
    return np.asarray((closed > 0) | small[holes])


def walk_limb(mask: BoolArray, rgb: FloatImage, marker: FloatArray) -> Limb:
    """Walk along the mask from the marker, first to the clamp, then to the tip.

    Parameters
    ----------
    mask : bool array, shape (height, width)
    rgb : float32 array, shape (height, width, 3)
    marker : array, shape (2,)
        The marker's centre, rectified pixels.

    Raises
    ------
    UnclearError
        If the marker is not on the mask, or the mask does not look like a limb of even width.
    """
    heading = _first_heading(mask, marker)
    walk = _Walk(mask, rgb, marker, heading)
    upwards = walk.to_clamp()
    if len(upwards) < FEWEST_STEPS:
        raise UnclearError("the actuator's outline is lost near the marker")
    downwards = walk.to_tip(upwards)
    return Limb(np.array([*upwards[::-1], *downwards]), walk.half_width)


def _first_heading(mask: BoolArray, marker: FloatArray) -> FloatArray:
    """Direction from the marker into the body: towards the centre of the mask around it."""
    reach = round(START_REACH_SQUARES * PIXELS_A_SQUARE)
    x, y = np.rint(marker).astype(int).tolist()
    if not (0 <= x < mask.shape[1] and 0 <= y < mask.shape[0]):
        raise UnclearError("the marker lies outside the board")
    top, left = max(0, y - reach), max(0, x - reach)
    part = mask[top : y + reach + 1, left : x + reach + 1].astype(np.uint8)
    _, labels = cv2.connectedComponents(part)
    own = labels[max(0, y - top), max(0, x - left)]
    if own == 0:
        raise UnclearError("the marker does not stand before the board's squares")
    rows, columns = np.nonzero(labels == own)
    near = np.hypot(columns + left - marker[0], rows + top - marker[1]) <= reach
    centre = np.array([columns[near].mean() + left, rows[near].mean() + top])
    away = centre - marker
    if np.linalg.norm(away) < 0.8 * PIXELS_A_SQUARE:
        raise UnclearError("the marker is not near the actuator's tip")
    return np.asarray(away / np.linalg.norm(away))


class _Walk:
    """A walk along the mask, with what has been learnt on the way."""

    def __init__(self, mask: BoolArray, rgb: FloatImage, marker: FloatArray, heading: FloatArray) -> None:
        self.mask, self.rgb = mask, rgb
        self.start, self.first_heading = marker, heading
        self.half_width = 0.0
        self.colour = np.zeros(3)

    def to_clamp(self) -> list[FloatArray]:
        """Return the centres from the marker's side up to the clamp."""
        centres = self._first_steps()
        heading = _direction(centres)
        doubtful = 0
        while len(centres) < MOST_STEPS:
            place = centres[-1] + heading * PIXELS_A_SQUARE
            section = self._section(place, heading)
            if section is None:
                if doubtful >= FEWEST_CLAMP_STEPS:
                    return centres[:-doubtful]
                raise UnclearError("the actuator leaves the photo or the board before a clamp is seen")
            side, believed = self._sideways(section)
            doubtful = 0 if believed else doubtful + 1
            if doubtful > LOOK_AHEAD_SQUARES:
                return centres[: len(centres) - LOOK_AHEAD_SQUARES]
            centres.append(place + side * _across(heading))
            if believed:
                heading = _direction(centres[-8:])
        raise UnclearError("no clamp is seen at the actuator's upper end")

    def to_tip(self, upwards: list[FloatArray]) -> list[FloatArray]:
        """Return the centres beyond the first of ``upwards``, down to where the mask ends."""
        heading = -_direction(upwards[:FIRST_STEPS])
        centres = [upwards[0]]
        while len(centres) < MOST_STEPS:
            place = centres[-1] + heading * 0.5 * PIXELS_A_SQUARE
            if not _inside(place, self.mask.shape):
                raise UnclearError("the tip lies outside the photo or the board")
            if not self.mask[_pixel(place)]:
                return centres[1:]
            centres.append(place)
        raise UnclearError("no tip is seen")

    def _first_steps(self) -> list[FloatArray]:
        """Walk the first steps, where the width is not known yet, and learn it."""
        heading, place, centres, widths, colours = self.first_heading, self.start, [], [], []
        for _ in range(FIRST_STEPS):
            place = place + heading * PIXELS_A_SQUARE
            section = self._section(place, heading)
            if section is None or section.left + section.right < PIXELS_A_SQUARE:
                raise UnclearError("the actuator's outline is lost near the marker")
            place = place + 0.5 * (section.right - section.left) * _across(heading)
            centres.append(place)
            widths.append(0.5 * (section.left + section.right))
            colours.append(section.colour)
            if len(centres) >= 3:
                heading = _direction(centres)
        self.half_width = float(np.median(widths))
        self.colour = np.median(colours, axis=0)
        if self.half_width > 0.45 * WIDEST_SQUARES * PIXELS_A_SQUARE:
            raise UnclearError("what surrounds the marker is too wide for an actuator")
        return centres

    def _sideways(self, section: _Section) -> tuple[float, bool]:
        """How far the true centre lies to the right, and whether an edge speaks for it."""
        low, high = (bound * self.half_width for bound in WIDTH_RANGE)
        sides = [
            sign * (reach - self.half_width)
            for sign, reach in ((-1.0, section.left), (1.0, section.right))
            if low <= reach <= high
        ]
        if not sides or self._other_thing(section.colour):
            return 0.0, False
        return float(np.mean(sides)), True

    def _other_thing(self, colour: FloatArray) -> bool:
        share, usual = colour / colour.sum(), self.colour / self.colour.sum()
        # Shares of a dark colour are noise: judge them by what they are worth in grey levels.
        weight = min(1.0, colour.sum() / 120.0)
        return bool(
            weight * np.abs(share - usual).max() > HUE_CHANGE or colour.sum() < DIMMED * self.colour.sum()
        )

    def _section(self, place: FloatArray, heading: FloatArray) -> _Section | None:
        """Measure across the walk; None where the place leaves the picture or whatever hides the board."""
        if not _inside(place, self.mask.shape) or not self.mask[_pixel(place)]:
            return None
        reach = np.arange(0.5 * WIDEST_SQUARES * PIXELS_A_SQUARE)
        ends = []
        for sign in (-1.0, 1.0):
            points = np.rint(place + sign * reach[:, None] * _across(heading)).astype(np.intp)
            x = np.clip(points[:, 0], 0, self.mask.shape[1] - 1)
            y = np.clip(points[:, 1], 0, self.mask.shape[0] - 1)
            outside = np.flatnonzero(~self.mask[y, x])
            ends.append(float(outside[0]) if len(outside) else float(len(reach)))
        half = 0.4 * (self.half_width or min(ends))
        middle = np.linspace(-half, half, 9)[:, None] * _across(heading) + place
        x = np.clip(np.rint(middle[:, 0]).astype(np.intp), 0, self.mask.shape[1] - 1)
        y = np.clip(np.rint(middle[:, 1]).astype(np.intp), 0, self.mask.shape[0] - 1)
        colour = np.asarray(np.median(self.rgb[y, x], axis=0) + 1.0, dtype=float)
        return _Section(ends[0], ends[1], colour)


def _across(heading: FloatArray) -> FloatArray:
    """Direction to the walker's right as the picture shows it (x right, y down)."""
    return np.array([-heading[1], heading[0]])


def _direction(centres: list[FloatArray]) -> FloatArray:
    """Mean direction of a short row of points."""
    along = centres[-1] - centres[0]
    return np.asarray(along / np.linalg.norm(along))


def _inside(place: FloatArray, shape: tuple[int, ...]) -> bool:
    return bool(0 <= place[0] <= shape[1] - 1 and 0 <= place[1] <= shape[0] - 1)


def _pixel(place: FloatArray) -> tuple[int, int]:
    return round(float(place[1])), round(float(place[0]))
