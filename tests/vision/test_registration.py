"""By how many squares a camera moved: what stands still tells, what moves by itself does not."""

import numpy as np
import pytest

from spavision.vision.board import BoardView
from spavision.vision.camera import Camera, Pose, project
from spavision.vision.observe import BoardMap, Observation
from spavision.vision.registration import SMALLEST_CERTAINTY, register

NODES = np.stack(np.meshgrid(np.arange(60), np.arange(60)), axis=-1).reshape(-1, 2)
CAMERA = Camera(1000.0, 1000.0, 300.0, 300.0, (0.0,) * 5, 600, 600)
POSE = Pose((0.0, 0.0, 0.0), (-30.0, -30.0, 100.0))


def photograph(name, *, shift, tip, still):
    """A photo whose lattice lies ``shift`` squares from the reference's, with an actuator bent by ``tip``.

    What stands ``still`` is a clamp, and the paper beside the board.
    """
    column, row = (NODES + np.rint(shift).astype(int)).T
    values = 0.5 + 0.001 * np.random.default_rng(len(name)).standard_normal(len(NODES))
    values[(abs(column - 30 - tip * (row / 50) ** 2) < 3) & (row > 10) & (row < 50)] = 0.2
    if still:
        values[abs(column - 30) > 24] = 0.9
        values[(abs(column - 30) < 16) & (abs(row - 6) < 5)] = 0.05
    pixels = project(CAMERA, POSE, NODES + np.array(shift))
    board = BoardView(NODES, pixels, CAMERA, POSE, rms_px=0.0, pitch_px=10.0, contrast=100.0)
    board_map = BoardMap(values.reshape(60, 60).astype(np.float32), (0, 0))
    return Observation(name, "", 600, 600, None, board, map=board_map)


@pytest.mark.parametrize("shift", [(2.4, 1.7), (-3.3, 0.8), (0.4, -6.4)])
def test_clamp_and_rim_tell_the_shift_though_the_actuator_moves(shift):
    reference = photograph("reference", shift=(0.0, 0.0), tip=0, still=True)
    found = register(reference, photograph("other", shift=shift, tip=9, still=True))
    assert found.shift.tolist() == np.rint(shift).tolist()
    assert found.certainty > SMALLEST_CERTAINTY


def test_an_actuator_alone_does_not_tell_it():
    reference = photograph("reference", shift=(0.0, 0.0), tip=0, still=False)
    found = register(reference, photograph("other", shift=(2.4, 1.7), tip=9, still=False))
    assert found.certainty < SMALLEST_CERTAINTY


def test_an_unmoved_camera_is_certain():
    reference = photograph("reference", shift=(0.0, 0.0), tip=0, still=True)
    found = register(reference, photograph("other", shift=(0.0, 0.0), tip=9, still=True))
    assert found.shift.tolist() == [0, 0]
    assert np.isinf(found.certainty)
