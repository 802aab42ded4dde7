"""Small scenes for the tests of the renderer."""

import dataclasses

import numpy as np

from spavision.render.scene_file import with_overrides
from spavision.render.settings import RenderSettings
from spavision.render.trajectory import Trajectory

SMALL = (
    "image.width_px=400",
    "image.height_px=300",
    "camera.square_px=12",
    "camera.aim_y_mm=55",
)
"""A small picture about the tip of the hanging actuator."""

QUIET = ("sensor.noise=false", "sensor.demosaic=none", "sensor.sharpening=0", "board.mottle=0")


def settings(*assignments, base=(*SMALL, *QUIET)):
    return with_overrides(RenderSettings(), (*base, *assignments))


def path(*moves, out_of_plane=0.0):
    """Return a trajectory through the given (ux, uy), one a photo, 5 kPa apart."""
    moves = np.array(moves or [(0.0, 0.0)], dtype=float)
    pressure = 5.0 * np.arange(len(moves))
    return Trajectory(pressure, moves[:, 0], moves[:, 1], np.full(len(moves), float(out_of_plane)))


def without_actuator(*assignments):
    scene = settings(*assignments)
    return dataclasses.replace(scene, actuator=dataclasses.replace(scene.actuator, visible=False))
