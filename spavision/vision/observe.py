"""What one photograph says on its own: board, marker candidates, a low-passed map of the board."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from spavision.errors import InputError

from .arrays import FloatImage, blur, sample, shrink, shrunk_place
from .board import BoardView, find_board
from .camera import project
from .colour import LEAST_CHROMA, MarkerColour, colour_chroma, white_balance
from .marker import Candidate, find_candidates
from .photos import Photo, read_photo

MAP_MARGIN_SQUARES = 8
MAP_BLUR_SQUARES = 0.9
MAP_REACH_SQUARES = 3.0 * MAP_BLUR_SQUARES
"""How far beyond its rim a spot shows in the map."""


@dataclass(frozen=True)
class MarkerLook:
    """How a marker looks.

    Parameters
    ----------
    colour : MarkerColour
    diameter_squares : float or None
        Diameter in squares of the board, where known.
    """

    colour: MarkerColour
    diameter_squares: float | None


@dataclass(frozen=True)
class BoardMap:
    """Brightness of the photograph at lattice nodes, squares averaged away: what lies on and about the board.

    The marker is left out. It moves as a whole, and would pass for a board that did.

    Parameters
    ----------
    values : float32 array, shape (rows, columns)
        Grey levels; NaN outside the photograph and about spots that may be the marker.
    origin : tuple of int
        Column and row index of ``values[0, 0]`` in the photograph's lattice.
    """

    values: FloatImage
    origin: tuple[int, int]


@dataclass(frozen=True)
class Observation:
    """One photograph, measured on its own.

    Parameters
    ----------
    name : str
        File name.
    problem : str
        Why the photograph cannot be used; empty when it can.
    width, height : int
        Size, px.
    focal_px : float or None
        Focal length according to EXIF.
    board : BoardView or None
    candidates : tuple of Candidate
        Spots that may be the marker.
    base_candidates : tuple of Candidate
        Spots that may be the base marker.
    map : BoardMap or None
    """

    name: str
    problem: str
    width: int = 0
    height: int = 0
    focal_px: float | None = None
    board: BoardView | None = None
    candidates: tuple[Candidate, ...] = ()
    base_candidates: tuple[Candidate, ...] = ()
    map: BoardMap | None = None

    def set_aside(self, problem: str) -> Observation:
        """Return the photograph without what was measured in it, and why."""
        return Observation(self.name, problem, self.width, self.height, self.focal_px)


class ObservationMemory(Protocol):
    """Keeps observations from an interrupted run for the next."""

    def recall(self, photo: Path) -> Observation | None:
        """Return what is kept of a photo, if anything."""

    def keep(self, photo: Path, observation: Observation) -> None:
        """Keep an observation."""


def observe(
    path: Path, *, tip: MarkerLook, base: MarkerLook | None, largest_megapixels: float
) -> Observation:
    """Read one photograph and measure board and marker candidates; problems are told, not raised."""
    try:
        photo = read_photo(path, largest_megapixels=largest_megapixels)
    except InputError as error:
        return Observation(path.name, str(error))
    height, width = photo.gray.shape
    board = find_board(photo.gray)
    if board is None:
        return Observation(path.name, "no board found in view", width, height, photo.focal_px)
    candidates = _candidates(photo, board, tip)
    base_candidates: tuple[Candidate, ...] = ()
    if base is not None:
        base_candidates = candidates if base == tip else _candidates(photo, board, base)
    return Observation(
        path.name,
        "",
        width,
        height,
        photo.focal_px,
        board,
        candidates,
        base_candidates,
        _board_map(photo.gray, board, candidates),
    )


def _candidates(photo: Photo, board: BoardView, look: MarkerLook) -> tuple[Candidate, ...]:
    colour = look.colour.in_white_light(white_balance(photo.rgb, board))
    if colour_chroma(colour) < LEAST_CHROMA:
        return ()
    return find_candidates(photo.rgb, board, colour=colour, diameter_squares=look.diameter_squares)


def _board_map(gray: FloatImage, board: BoardView, spots: tuple[Candidate, ...]) -> BoardMap:
    low = board.indices.min(axis=0) - MAP_MARGIN_SQUARES
    high = board.indices.max(axis=0) + MAP_MARGIN_SQUARES
    columns, rows = np.meshgrid(np.arange(low[0], high[0] + 1), np.arange(low[1], high[1] + 1))
    nodes = np.stack([columns, rows], axis=-1).reshape(-1, 2).astype(float)
    pixels = project(board.camera, board.pose, nodes).reshape(*columns.shape, 2)
    factor = min(1.0, 4.0 / board.pitch_px)
    smooth = blur(shrink(gray, factor), MAP_BLUR_SQUARES * board.pitch_px * factor)
    values = sample(smooth, shrunk_place(pixels, factor))
    height, width = gray.shape
    inside = (pixels >= 0).all(axis=-1) & (pixels[..., 0] < width) & (pixels[..., 1] < height)
    values[~inside] = np.nan
    for spot in spots:
        distance = np.hypot(columns - spot.place_squares[0], rows - spot.place_squares[1])
        values[distance < spot.radius_squares + MAP_REACH_SQUARES] = np.nan
    return BoardMap(values, (int(low[0]), int(low[1])))
