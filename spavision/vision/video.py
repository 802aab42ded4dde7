"""The calmest frame of each pressure hold of a video."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from spavision.errors import InputError

from .arrays import RgbImage
from .holds import Hold

VIDEO_SUFFIXES = (".mp4", ".mov", ".m4v", ".avi", ".mkv", ".webm")

SETTLING, CLOSING = 0.4, 0.1
"""Shares of a hold at its beginning and end in which the actuator may still, or again, move."""

FRAMES_COMPARED = 7
"""Frames of a hold among which the calmest is chosen; as many are in memory at a time."""

THUMBNAIL_PX = 320

# FFmpeg writes about a broken file on its own; the user gets one sentence of ours instead.
os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")


@dataclass(frozen=True)
class HoldFrame:
    """A frame of a video.

    Parameters
    ----------
    hold : Hold
        When it was taken.
    time_s : float
        Its own time.
    rgb : uint8 array, shape (height, width, 3)
    """

    hold: Hold
    time_s: float
    rgb: RgbImage


def is_video(path: Path) -> bool:
    """Tell a video from a folder of photographs, by its name's ending."""
    return path.suffix.lower() in VIDEO_SUFFIXES and not path.is_dir()


def hold_frames(path: Path, holds: list[Hold]) -> Iterator[HoldFrame]:
    """Yield one frame a hold: the one that differs least from the median picture of its hold.

    A frame taken while the actuator still swings, or while a hand is in the picture, is far from the median.

    Parameters
    ----------
    path : Path
        The video.
    holds : list of Hold
        In order of time.

    Raises
    ------
    InputError
        If the video cannot be read, or ends before a hold begins.
    """
    with _opened(path) as video:
        length_s = _length_s(video)
        for hold in holds:
            if hold.start_s >= length_s:
                raise _nothing_shown(path, hold, length_s)
        times = _times(video)
        now = next(times, np.inf)
        for hold in holds:
            taken: dict[float, RgbImage] = {}
            for moment in _moments(hold, length_s):
                while now < moment:
                    now = next(times, np.inf)
                if now < hold.end_s and now not in taken:
                    taken[now] = _retrieve(video, path)
            if not taken:
                raise _nothing_shown(path, hold, length_s)
            calmest = list(taken)[_calmest(list(taken.values()))]
            yield HoldFrame(hold, calmest, taken[calmest])


def _nothing_shown(path: Path, hold: Hold, length_s: float) -> InputError:
    return InputError(
        f"{path.name} shows nothing of the hold at {hold.pressure_kPa:g} kPa from {hold.start_s:g} s on; "
        f"expected times from the video's beginning, within its {length_s:.1f} s"
    )


@contextmanager
def _opened(path: Path) -> Iterator[cv2.VideoCapture]:
    video = cv2.VideoCapture(str(path))
    try:
        if not video.isOpened():
            raise InputError(
                f"{path} cannot be read as a video; give an existing file, saved as H.264 or MJPEG"
            )
        yield video
    finally:
        video.release()


def _length_s(video: cv2.VideoCapture) -> float:
    rate = video.get(cv2.CAP_PROP_FPS)
    return float(video.get(cv2.CAP_PROP_FRAME_COUNT) / rate) if rate > 0 else np.inf


def _moments(hold: Hold, length_s: float) -> list[float]:
    """Return the times at which a hold is looked at."""
    lasts_s = min(hold.end_s, length_s) - hold.start_s
    if not (np.isfinite(lasts_s) and lasts_s > 0):
        return [hold.start_s]
    shares = np.linspace(SETTLING, 1.0 - CLOSING, FRAMES_COMPARED)
    moments: list[float] = (hold.start_s + shares * lasts_s).tolist()
    return moments


def _times(video: cv2.VideoCapture) -> Iterator[float]:
    """Yield the time of each frame in turn, s; that frame can then be retrieved.

    Reading on is exact, where seeking depends on the format.
    """
    while video.grab():
        yield video.get(cv2.CAP_PROP_POS_MSEC) / 1000.0


def _retrieve(video: cv2.VideoCapture, path: Path) -> RgbImage:
    whole, picture = video.retrieve()
    if not whole:
        raise InputError(f"{path.name} is corrupt or truncated; copy it again from the camera")
    return np.asarray(cv2.cvtColor(picture, cv2.COLOR_BGR2RGB), dtype=np.uint8)


def _calmest(pictures: list[RgbImage]) -> int:
    """Return which picture differs least from the median of all."""
    small = np.array([_thumbnail(picture) for picture in pictures], dtype=np.float32)
    difference = np.abs(small - np.median(small, axis=0)).mean(axis=(1, 2, 3))
    return int(np.argmin(difference))


def _thumbnail(picture: RgbImage) -> RgbImage:
    factor = min(1.0, THUMBNAIL_PX / max(picture.shape))
    size = (max(1, round(picture.shape[1] * factor)), max(1, round(picture.shape[0] * factor)))
    return np.asarray(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)
