"""The file ``camera.toml``: a calibrated camera with its covariance, written and read."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from spavision.errors import InputError
from spavision.tables import read_toml

from .arrays import FloatArray
from .bundle import PARAMETERS, parameter_values
from .calibration import Calibration
from .camera import Camera

Size = Annotated[int, Field(gt=0, le=100_000, strict=True)]
Focal = Annotated[float, Field(gt=0, le=1e7, allow_inf_nan=False)]
Real = Annotated[float, Field(ge=-1e7, le=1e7, allow_inf_nan=False)]


@dataclass(frozen=True)
class CalibratedCamera:
    """A camera as its file tells it.

    Parameters
    ----------
    camera : Camera
        Intrinsic parameters.
    covariance : array, shape (9, 9), or None
        Of `spavision.vision.bundle.PARAMETERS`; None where the file holds none.
    rms_px : float or None
        Root mean square residual of the calibration.
    """

    camera: Camera
    covariance: FloatArray | None = None
    rms_px: float | None = None


def write_camera(path: Path, calibration: Calibration) -> None:
    """Write a calibrated camera as TOML, each parameter with its standard deviation beside it."""
    path.write_text(camera_text(calibration), encoding="utf-8")


def camera_text(calibration: Calibration) -> str:
    """Return the text of ``camera.toml``."""
    camera = calibration.camera
    values = dict(zip(PARAMETERS, parameter_values(camera), strict=True))
    sigma = dict(zip(PARAMETERS, np.sqrt(np.diag(calibration.covariance)).tolist(), strict=True))

    def lines(names: tuple[str, ...]) -> list[str]:
        return [
            f"{name} = {values[name]!r}  # {f'± {sigma[name]:.2g}' if sigma[name] > 0 else 'fixed'}"
            for name in names
        ]

    rows = [f"    [{', '.join(repr(value) for value in row)}]," for row in calibration.covariance.tolist()]
    text = [
        "# Written by spavision calibrate; 1 sigma beside each value. OpenCV's model; the centre of the",
        "# top-left pixel is (0, 0). Valid for this lens at this zoom and focus, and photos of this size.",
        "",
        "[image]",
        f"width_px = {camera.width}",
        f"height_px = {camera.height}",
        "",
        "[intrinsics]",
        *lines(PARAMETERS[:4]),
        "",
        "[distortion]",
        *lines(PARAMETERS[4:]),
        "",
        "[quality]",
        f"rms_px = {calibration.rms_px!r}",
        f"sigma_corner_px = {calibration.sigma_px!r}",
        f"photos = {len(calibration.photos)}",
        f"corners = {sum(len(photo.corners.pixels) for photo in calibration.photos)}",
        "",
        "[covariance]",
        f"parameters = [{', '.join(repr(name) for name in PARAMETERS)}]".replace("'", '"'),
        "matrix = [",
        *rows,
        "]",
    ]
    return "\n".join(text) + "\n"


def read_camera(path: Path) -> CalibratedCamera:
    """Read a camera file; the sections ``quality`` and ``covariance`` may be absent.

    Raises
    ------
    InputError
        If the file cannot be read, a key is missing or unknown, or a value is of the wrong type or size.
    """
    try:
        content = _File.model_validate(read_toml(path))
    except ValidationError as error:
        raise InputError(f"{path}: {_sentence(error)}") from error
    image, intrinsics = content.image, content.intrinsics
    lens = content.distortion
    camera = Camera(
        fx=intrinsics.fx_px,
        fy=intrinsics.fy_px,
        cx=intrinsics.cx_px,
        cy=intrinsics.cy_px,
        distortion=(lens.k1, lens.k2, lens.p1, lens.p2, lens.k3),
        width=image.width_px,
        height=image.height_px,
    )
    if not (-0.5 <= camera.cx <= camera.width - 0.5 and -0.5 <= camera.cy <= camera.height - 0.5):
        raise InputError(
            f"{path}: the principal point ({camera.cx:g}, {camera.cy:g}) lies outside the photo of "
            f"{camera.width}×{camera.height} px; calibrate anew or correct the file"
        )
    covariance = None if content.covariance is None else _covariance(content.covariance, path)
    return CalibratedCamera(camera, covariance, None if content.quality is None else content.quality.rms_px)


class _Section(BaseModel):
    """A section of the file: unknown keys, such as the k4 of another lens model, are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class _Image(_Section):
    width_px: Size
    height_px: Size


class _Intrinsics(_Section):
    fx_px: Focal
    fy_px: Focal
    cx_px: Real
    cy_px: Real


class _Distortion(_Section):
    k1: Real
    k2: Real
    p1: Real
    p2: Real
    k3: Real = 0.0


class _Quality(_Section):
    rms_px: Annotated[float, Field(ge=0, allow_inf_nan=False)]
    sigma_corner_px: Annotated[float, Field(ge=0, allow_inf_nan=False)] | None = None
    photos: int | None = None
    corners: int | None = None


class _Covariance(_Section):
    parameters: tuple[str, ...]
    matrix: tuple[tuple[Real, ...], ...]


class _File(_Section):
    image: _Image
    intrinsics: _Intrinsics
    distortion: _Distortion
    quality: _Quality | None = None
    covariance: _Covariance | None = None


def _covariance(section: _Covariance, path: Path) -> FloatArray:
    if section.parameters != PARAMETERS:
        raise InputError(
            f"{path}: [covariance] parameters must be {', '.join(PARAMETERS)}, in this order; "
            "calibrate anew or remove the section"
        )
    n = len(PARAMETERS)
    if len(section.matrix) != n or any(len(row) != n for row in section.matrix):
        raise InputError(
            f"{path}: [covariance] matrix must have {n} rows of {n} numbers; "
            "calibrate anew or remove the section"
        )
    matrix = np.array(section.matrix, dtype=float)
    scale = np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    correlation = matrix / np.outer(scale, scale)
    if not np.allclose(correlation, correlation.T, atol=1e-6) or (np.diag(matrix) < 0).any():
        raise InputError(
            f"{path}: [covariance] matrix is not symmetric with variances of 0 or more; "
            "calibrate anew or remove the section"
        )
    return matrix


def _sentence(error: ValidationError) -> str:
    """Say the first thing that is wrong with the file."""
    first = error.errors()[0]
    section, *rest = [str(part) for part in first["loc"]]
    where = f"[{section}] {' '.join(rest)}".rstrip()
    if first["type"] == "missing":
        return f"{where} is missing; calibrate anew or add it"
    if first["type"] == "extra_forbidden":
        return f"unknown key {where}; expected OpenCV's model of k1, k2, p1, p2, k3 as spavision writes it"
    message = first["msg"][:1].lower() + first["msg"][1:]
    value = first["input"]
    shown = f" is {value!r}:" if isinstance(value, (str, int, float)) else ":"
    return f"{where}{shown} {message}; correct the value"
