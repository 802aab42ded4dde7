"""The actuator's silhouette against the board: its edges, its tip and where it leaves the clamp."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import BoolArray, FloatArray, sample
from .centre_line import CentreLine, line_through
from .edge_fit import Edge, fit_edges
from .edge_profiles import CLEAN_RUN_SQUARES, STEP_SQUARES, Profiles
from .limb import STRANGE, Limb, UnclearError
from .rectified import PIXELS_A_SQUARE, BareBoard, RectifiedBoard
from .sight import Sight

SEARCH_SQUARES = (3.0, 1.2, 0.8, 0.8)
"""How far from the last line's edge the edge is looked for, step by step."""

SHOWS_BODY = 0.5
"""Share of body pixels over bright (or dark) squares that must be strange for such squares to tell."""

WIDEST_EDGE_BLUR_SQUARES = 0.1
EDGE_SHIFT_BLURS = 0.4
"""Blur mixes light, not the levels of the file: an edge seems to lie up to half a blur nearer its dark side,
by how much depends on both colours. So a wider edge is not fitted as such, and the line is as uncertain."""

BOUND_WEIGHT = 0.05
"""Say of a broken bound against that of a seen edge."""

FEWEST_EDGE_POINTS = 60
"""Edge points, of both sides together, that a fit needs."""

BEYOND_SQUARES = (0.2, 0.7)
LEAST_PATTERN = 0.8
"""Stretch beyond an edge in which the board's pattern must show, and share of its contrast that must. What
lacks leaves room for a grey layer not told from the board; the line is as uncertain, in squares."""

END_MARGIN_MM = 2.0
"""Stretch at either end that is left out of the fit: rounded corners, the clamp's shadow."""

CLAMP_SEARCH_SQUARES = 4.0
END_LATERALS = 41


@dataclass(frozen=True)
class Silhouette:
    """The fitted silhouette in the plane of the side face.

    Parameters
    ----------
    line : CentreLine
        From the clamp to the tip.
    residuals_mm : array, shape (2, STATIONS)
        Distance of the left and right edge points from the smooth edges; NaN without an edge point.
    sigma_across_mm, sigma_heading_rad : array, shape (STATIONS,)
        Standard uncertainty of the line's place across itself, and of its heading, as the edges tell them.
    """

    line: CentreLine
    residuals_mm: FloatArray
    sigma_across_mm: FloatArray
    sigma_heading_rad: FloatArray


def find_silhouette(board: RectifiedBoard, bare: BareBoard, limb: Limb, sight: Sight) -> Silhouette:
    """Fit edges and ends of the actuator, starting from the walked limb.

    Raises
    ------
    UnclearError
        If the body cannot be told from the board along an edge, or tip or clamp cannot be seen.
    """
    view = _View(board, bare, sight)
    line = _first_line(board, limb, sight)
    for search in SEARCH_SQUARES:
        sides = [view.edge(line, sign, search * board.square_mm) for sign in (-1.0, 1.0)]
        if sum(np.count_nonzero(np.isfinite(side.distance_mm)) for side in sides) < FEWEST_EDGE_POINTS:
            raise UnclearError("too little of the actuator's edges is seen")
        fit = fit_edges(line, sides[0], sides[1])
        tip = view.tip(fit.line, search * board.square_mm)
        line = fit.line.trimmed(0.0, fit.line.length_mm + tip)
    pattern = min(view.pattern_beyond(line, sign) for sign in (-1.0, 1.0))
    if pattern < LEAST_PATTERN:
        raise UnclearError("what lies beyond the edge found is not the bare board")
    start_mm = view.clamp(line)
    line = line.trimmed(start_mm, line.length_mm)
    across, heading = (
        np.interp(line.arc_mm + start_mm, fit.line.arc_mm, sigma)
        for sigma in (fit.sigma_across_mm, fit.sigma_heading_rad)
    )
    shift = np.hypot(EDGE_SHIFT_BLURS * bare.blur_squares, max(0.0, 1.0 - pattern))
    return Silhouette(line, fit.residuals_mm, np.hypot(across, shift * board.square_mm), heading)


def _first_line(board: RectifiedBoard, limb: Limb, sight: Sight) -> CentreLine:
    """Return the line midway between the limb's edges on the body, of which a seen wall is no part."""
    half_mm = limb.half_width * board.pixel_mm
    rough = line_through(board.to_mm(limb.centres), half_mm)
    left, right = (
        sight.touched_at(rough.points_mm + sign * half_mm * rough.rightward, sign * rough.rightward)
        for sign in (-1.0, 1.0)
    )
    half = 0.5 * float(np.median(np.linalg.norm(right - left, axis=1)))
    return line_through(0.5 * (left + right), half)


@dataclass(frozen=True)
class _View:
    """A rectified photograph and the sight onto it."""

    board: RectifiedBoard
    bare: BareBoard
    sight: Sight

    def edge(self, line: CentreLine, sign: float, search_mm: float) -> Edge:
        """Measure one edge at each station of a line."""
        outward = sign * line.rightward
        predicted = line.points_mm + outward * line.half_width_mm[:, None]
        usable = (line.arc_mm > END_MARGIN_MM) & (line.arc_mm < line.length_mm - END_MARGIN_MM)
        profiles = self._profiles(predicted, outward, search_mm)
        ends = profiles.ends(self._telling_squares(line, sign))
        # An edge known between bounds alone speaks up only where the prediction breaks one.
        broken = np.where(ends.low > 0.0, ends.low, np.where(ends.high < 0.0, ends.high, np.nan))
        seen = np.isfinite(ends.edge)
        offsets = np.where(seen, ends.edge, broken)
        distance = np.where(usable, line.half_width_mm + offsets, np.nan)
        return Edge(distance, np.where(seen, ends.weight, BOUND_WEIGHT))

    def pattern_beyond(self, line: CentreLine, sign: float) -> float:
        """Return how much of the board's contrast shows just beyond an edge: about 1 on bare board.

        A grey layer may pass for board in shadow over bright squares and for lit board over dark ones.
        """
        step = STEP_SQUARES * self.board.square_mm
        offsets = step * np.arange(*(round(share / STEP_SQUARES) for share in BEYOND_SQUARES))
        outward = sign * line.rightward
        edge = line.points_mm + outward * line.half_width_mm[:, None]
        points = edge[:, None] + offsets[None, :, None] * outward[:, None]
        pixels = self.board.to_pixels(
            self.sight.seen_at(points, np.broadcast_to(outward[:, None], points.shape))
        )
        seen, bare = (
            sample(picture, pixels).sum(axis=-1) for picture in (self.board.rgb, self.bare.expected)
        )
        seen, bare = seen / np.nanmean(seen), bare / np.nanmean(bare)
        known = np.isfinite(seen) & np.isfinite(bare)
        contrast = bare[known] - 1.0
        return float((seen[known] - 1.0) @ contrast / max(float(contrast @ contrast), 1e-9))

    def tip(self, line: CentreLine, search_mm: float) -> float:
        """How far the tip lies beyond the line's end, mm."""
        lateral = np.linspace(-0.7, 0.7, END_LATERALS) * line.half_width_mm[-1]
        places = line.points_mm[-1] + lateral[:, None] * line.rightward[-1]
        outward = np.broadcast_to(line.along[-1], places.shape)
        ends = self._profiles(places, outward, search_mm).ends(self._telling_tip(line))
        found = np.isfinite(ends.low)
        if np.count_nonzero(found) < END_LATERALS // 2:
            raise UnclearError("the tip's end is not seen against the board")
        seen = np.isfinite(ends.edge)
        low, high = (np.where(seen, ends.edge, bound)[found] for bound in (ends.low, ends.high))
        # The median of all bounds is the place that breaks them least.
        return float(np.median(np.concatenate([low, high])))

    def clamp(self, line: CentreLine) -> float:
        """Arc length at which the body leaves the clamp: the sharpest change of colour near the start."""
        reach, step = CLAMP_SEARCH_SQUARES * self.board.square_mm, STEP_SQUARES * self.board.square_mm
        along = np.arange(-reach, reach, step)
        lateral = np.linspace(-0.6, 0.6, END_LATERALS) * line.half_width_mm[0]
        points = (
            line.points_mm[0]
            + along[:, None, None] * line.along[0]
            + lateral[None, :, None] * line.rightward[0]
        )
        colours = sample(self.board.rgb, self.board.to_pixels(self.sight.on_board(points)))
        span = round(0.4 / STEP_SQUARES)
        total = np.cumsum(colours.astype(float), axis=0)
        mean = (total[span:] - total[:-span]) / span
        change = np.median(np.linalg.norm(mean[span:] - mean[:-span], axis=-1), axis=1)
        return float(along[np.argmax(change) + span])

    def _profiles(self, predicted: FloatArray, outward: FloatArray, search_mm: float) -> Profiles:
        """Sample the picture along lines that cross a predicted outline."""
        step = STEP_SQUARES * self.board.square_mm
        reach = np.ceil((search_mm + CLEAN_RUN_SQUARES * self.board.square_mm) / step)
        offsets = np.arange(-reach, reach + 1) * step
        points = predicted[:, None] + offsets[None, :, None] * outward[:, None]
        seen = self.sight.seen_at(points, np.broadcast_to(outward[:, None], points.shape))
        pixels = self.board.to_pixels(seen)
        profile = sample(self.bare.strangeness, pixels)
        return Profiles(
            offsets,
            np.where(np.isfinite(profile), profile, np.inf) > STRANGE,
            self._over_bright(pixels),
            sample(self.board.rgb, pixels),
            sample(self.bare.expected, pixels),
            search_mm,
            min(self.bare.blur_squares, WIDEST_EDGE_BLUR_SQUARES),
        )

    def _telling_squares(self, line: CentreLine, sign: float) -> tuple[bool, bool]:
        """Whether the body is strange over dark and over bright squares just inside an edge."""
        depth = np.linspace(0.5, 1.3, 9) * self.board.square_mm
        inner = line.half_width_mm[:, None] - depth
        points = line.points_mm[:, None] + sign * inner[..., None] * line.rightward[:, None]
        return self._telling(self.sight.on_board(points))

    def _telling_tip(self, line: CentreLine) -> tuple[bool, bool]:
        lateral = np.linspace(-0.7, 0.7, END_LATERALS) * line.half_width_mm[-1]
        back = np.linspace(0.5, 2.0, 9) * self.board.square_mm
        points = (
            line.points_mm[-1]
            + lateral[:, None, None] * line.rightward[-1]
            - back[None, :, None] * line.along[-1]
        )
        return self._telling(self.sight.on_board(points))

    def _telling(self, board_mm: FloatArray) -> tuple[bool, bool]:
        pixels = self.board.to_pixels(board_mm)
        strange = sample(self.bare.strangeness, pixels) > STRANGE
        bright = self._over_bright(pixels)
        shares = [float(strange[chosen].mean()) if chosen.any() else 0.0 for chosen in (~bright, bright)]
        if max(shares) < SHOWS_BODY:
            raise UnclearError("the actuator cannot be told from the board along an edge")
        return shares[0] >= SHOWS_BODY, shares[1] >= SHOWS_BODY

    def _over_bright(self, pixels: FloatArray) -> BoolArray:
        """Whether rectified pixels lie over bright squares."""
        square = np.floor((pixels + 0.5) / PIXELS_A_SQUARE).astype(np.intp)
        return np.asarray(square.sum(axis=-1) % 2 == self.board.bright_parity)
