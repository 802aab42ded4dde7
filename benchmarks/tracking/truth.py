"""What is really in a rendered set of photographs, read from its ``truth.json``."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from scenes import BenchmarkSet

from spavision.render.photo_set import photo_set
from spavision.vision.camera import Camera, Pose, project, to_plane


@dataclass(frozen=True)
class PhotoTruth:
    """One photograph: its file, the board before its camera, and where the dots are."""

    path: Path
    pressure_kPa: float
    pose: Pose
    dot_mm: np.ndarray
    base_dot_mm: np.ndarray | None
    hidden: float


@dataclass(frozen=True)
class SetTruth:
    """A rendered set: photographs, camera, and the board's lattice."""

    photos: tuple[PhotoTruth, ...]
    camera: Camera
    square_mm: float
    origin_mm: np.ndarray
    megapixels: float

    def displacement_mm(self, reference: int) -> np.ndarray:
        """True displacement of the dot from a reference photo, the base dot's motion taken off."""
        dots = np.array(
            [p.dot_mm if p.base_dot_mm is None else p.dot_mm - p.base_dot_mm for p in self.photos]
        )
        return dots - dots[reference]

    def nearest_corners(self, photo: int, pixels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lattice indices of the true corners nearest to some pixels, and those corners' own pixels."""
        pose = self.photos[photo].pose
        plane = to_plane(self.camera, pose, pixels)
        nodes = np.rint((plane - self.origin_mm) / self.square_mm).astype(int)
        return nodes, project(self.camera, pose, nodes * self.square_mm + self.origin_mm)


def rendered(benchmark: BenchmarkSet, cache: Path) -> SetTruth:
    """Render a set into the cache folder, or find it there, and return its truth."""
    moves = np.column_stack(
        [benchmark.trajectory.ux_mm, benchmark.trajectory.uy_mm, benchmark.trajectory.uz_mm]
    )
    key = hashlib.sha256(f"{benchmark.settings!r}{moves.round(9).tolist()}".encode()).hexdigest()[:10]
    folder = cache / f"{benchmark.name}-{benchmark.seed}-{key}"
    if not (folder / "truth.json").exists():
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in photo_set(benchmark.settings, benchmark.trajectory):
            (folder / name).write_bytes(content)
    return _read(folder)


def _read(folder: Path) -> SetTruth:
    record = json.loads((folder / "truth.json").read_text())
    matrix, distortion = np.array(record["camera_matrix_px"]), record["distortion_k1_k2_p1_p2_k3"]
    image, board = record["settings"]["image"], record["board"]
    width, height = image["width_px"], image["height_px"]
    fx, fy, cx, cy = matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2]
    half = 0.5 * np.array([board["columns"] % 2, board["rows"] % 2])
    return SetTruth(
        photos=tuple(_photo(folder, photo) for photo in record["photos"]),
        camera=Camera(fx, fy, cx, cy, tuple(distortion), width, height),
        square_mm=board["square_mm"],
        origin_mm=half * board["square_mm"],
        megapixels=width * height / 1e6,
    )


def _photo(folder: Path, record: dict) -> PhotoTruth:
    rotation = cv2.Rodrigues(np.array(record["rotation"]))[0].ravel()
    base = record.get("base_dot_mm")
    return PhotoTruth(
        path=folder / record["photo"],
        pressure_kPa=record["pressure_kPa"],
        pose=Pose(tuple(rotation), tuple(record["translation_mm"])),
        dot_mm=np.array(record["dot_mm"][:2]),
        base_dot_mm=None if base is None else np.array(base[:2]),
        hidden=record["dot_hidden_share"],
    )
