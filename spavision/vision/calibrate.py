"""From photographs of a board to a calibrated camera: the main road of ``spavision calibrate``."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from spavision.errors import InputError

from .adjustment import View
from .arrays import FloatImage
from .bundle import PARAMETERS, Bundle, adjust_bundle
from .calibration import Calibration, CalibrationPhoto, CalibrationSettings
from .calibration_corners import BoardCorners, lattice_corners, opencv_corners, within_board
from .coverage import cover, coverage_notes
from .photos import read_photo
from .threads import in_threads

FEWEST_PHOTOS = 3
GOOD_NUMBER_OF_PHOTOS = 8
FEWEST_CORNERS = 8
MOST_OPENCV_CORNERS = 500
"""OpenCV's detector is slow on denser boards and rarely sees them whole."""

WORSE_THAN_MEDIAN = 3.0
LARGEST_FOCAL_SIGMA = 0.01


@dataclass(frozen=True)
class _Found:
    """One photograph after the search: its size, and its corners or what is wrong with it."""

    name: str
    size: tuple[int, int] | None
    corners: BoardCorners | None
    problem: str = ""


def calibrate(
    paths: Sequence[Path], settings: CalibrationSettings, *, progress: Callable[[str], None] | None = None
) -> Calibration:
    """Calibrate a camera from photographs of one flat board.

    Parameters
    ----------
    paths : sequence of Path
        The photographs; those without a board are left out and named.
    settings : CalibrationSettings
    progress : callable, optional
        Called with a photograph's name after it has been searched.

    Raises
    ------
    InputError
        If sizes are mixed, too few photographs show the board, the number of corners asked for is wrong, or
        the photographs do not determine a camera.
    """
    found = _without_copies(_search_all(paths, settings, progress))
    size = _common_size(found)
    used = [each for each in found if each.corners is not None]
    _refuse_too_few(found, used, settings)
    boards = [each.corners for each in used if each.corners is not None]
    views = [View(board.indices.astype(float) * settings.square_mm, board.pixels) for board in boards]
    bundle = adjust_bundle(views, size, settings.model)
    if bundle is None:
        raise InputError(
            "the photographs do not determine the camera, as when the board always faces it squarely; "
            "add photos with the board tilted by 20 to 40°"
        )
    photos = tuple(
        CalibrationPhoto(each.name, board, pose, residuals)
        for each, board, pose, residuals in zip(used, boards, bundle.poses, bundle.residuals_px, strict=True)
    )
    coverage = cover(bundle.camera, [board.pixels for board in boards], bundle.poses)
    left_out = tuple((each.name, each.problem) for each in found if each.corners is None)
    return Calibration(
        camera=bundle.camera,
        covariance=bundle.covariance,
        rms_px=bundle.rms_px,
        sigma_px=bundle.sigma_px,
        board=settings.corners or max((board.extent for board in boards), key=lambda size: size[0] * size[1]),
        photos=photos,
        left_out=left_out,
        coverage=coverage,
        notes=(*_notes(bundle, photos, left_out), *coverage_notes(coverage)),
    )


def _search_all(
    paths: Sequence[Path], settings: CalibrationSettings, progress: Callable[[str], None] | None
) -> list[_Found]:
    found = []
    for each in in_threads(lambda path: _search(path, settings), paths):
        found.append(each)
        if progress is not None:
            progress(each.name)
    return found


def _search(path: Path, settings: CalibrationSettings) -> _Found:
    try:
        gray = read_photo(path, largest_megapixels=settings.largest_megapixels).gray
    except InputError as error:
        return _Found(path.name, None, None, str(error))
    size = (gray.shape[1], gray.shape[0])
    corners = _find_corners(gray, settings)
    if corners is None:
        return _Found(path.name, size, None, "no board found")
    if settings.corners is not None:
        seen, corners = corners.extent, within_board(corners, settings.corners)
        if corners is None:
            asked = f"{settings.corners[0]}×{settings.corners[1]}"
            return _Found(path.name, size, None, f"shows {seen[0]}×{seen[1]} corners, not {asked}")
    if len(corners.indices) < FEWEST_CORNERS:
        return _Found(path.name, size, None, f"only {len(corners.indices)} corners found")
    return _Found(path.name, size, corners)


def _find_corners(gray: FloatImage, settings: CalibrationSettings) -> BoardCorners | None:
    asked = settings.corners
    if settings.finder == "opencv" and asked is not None:
        return opencv_corners(gray, asked)
    found = lattice_corners(gray, asked)
    if settings.finder == "lattice" or asked is None or asked[0] * asked[1] > MOST_OPENCV_CORNERS:
        return found
    # OpenCV's detector sees a smaller board in a larger one: the lattice says whether the number is right.
    if found is not None and within_board(found, asked) is None:
        return found
    whole = opencv_corners(gray, asked)
    return found if whole is None else whole


def _without_copies(found: list[_Found]) -> list[_Found]:
    """Set aside photographs whose corners are another's to the last bit: copies count once."""
    first: dict[bytes, str] = {}
    kept = []
    for each in found:
        if each.corners is not None:
            original = first.setdefault(each.corners.pixels.tobytes(), each.name)
            if original != each.name:
                each = _Found(each.name, each.size, None, f"is a copy of {original}")
        kept.append(each)
    return kept


def _common_size(found: list[_Found]) -> tuple[int, int]:
    sizes = Counter(each.size for each in found if each.size is not None)
    if not sizes:
        raise InputError(f"no photograph could be read: {found[0].problem if found else 'none was given'}")
    (width, height), _ = sizes.most_common(1)[0]
    for each in found:
        if each.size is not None and each.size != (width, height):
            raise InputError(
                f"{each.name} has {each.size[0]}×{each.size[1]} px, most photos {width}×{height} px; "
                "calibrate with photos of one camera, all of one size and turned the same way"
            )
    return width, height


def _refuse_too_few(found: list[_Found], used: list[_Found], settings: CalibrationSettings) -> None:
    other = next((each for each in found if each.problem.startswith("shows ")), None)
    if len(used) < FEWEST_PHOTOS and other is not None:
        raise InputError(f"{other.name} {other.problem}; correct --corners or leave it off")
    if not used:
        named = settings.corners is not None
        raise InputError(
            "no board was found in any photograph; "
            + (
                "check --corners, "
                if named
                else "give --corners for a board of fewer than 20 inner corners, "
            )
            + "and keep the board flat, in focus and evenly lit"
        )
    if len(used) < FEWEST_PHOTOS:
        raise InputError(
            f"{len(used)} of {len(found)} photographs show the board, {FEWEST_PHOTOS} or more are needed and "
            f"10 to 20 are good; add photos with the board tilted in several directions"
        )
    if settings.corners is None:
        return
    largest = max((each.corners.extent for each in used if each.corners), key=lambda size: size[0] * size[1])
    asked = (max(settings.corners), min(settings.corners))
    if largest[0] < asked[0] or largest[1] < asked[1]:
        raise InputError(
            f"--corners is {settings.corners[0]}x{settings.corners[1]}, but no photograph shows more than "
            f"{largest[0]}×{largest[1]} inner corners; correct it, or leave it off for partly visible boards"
        )


def _notes(
    bundle: Bundle, photos: tuple[CalibrationPhoto, ...], left_out: tuple[tuple[str, str], ...]
) -> list[str]:
    notes = [f"{name} was left out: {reason}" for name, reason in left_out]
    median = float(np.median([photo.rms_px for photo in photos]))
    notes += [
        f"{photo.photo} fits far worse than the rest ({photo.rms_px:.2f} px, median {median:.2f} px); look "
        "at it: board bent, blurred, or corners wrong"
        for photo in photos
        if photo.rms_px > WORSE_THAN_MEDIAN * median
    ]
    if len(photos) < GOOD_NUMBER_OF_PHOTOS:
        notes.append(f"{len(photos)} photos are few; 10 to 20 make the result trustworthy")
    sigma = float(np.sqrt(bundle.covariance[PARAMETERS.index("fx_px"), PARAMETERS.index("fx_px")]))
    if sigma > LARGEST_FOCAL_SIGMA * bundle.camera.fx:
        notes.append(
            f"the focal length is known to ±{100 * sigma / bundle.camera.fx:.1f} % only; "
            "add photos with the board tilted by 20 to 40° that fill the frame"
        )
    return notes
