"""A run that is interrupted keeps what it has measured, and the next goes on from there."""

import json

import numpy as np
import pytest

from spavision.vision import track as tracking
from spavision.vision.settings import TrackSettings
from spavision.workflow.observation_store import ObservationStore

from .conftest import A_FEW


@pytest.fixture
def counted(monkeypatch):
    """Return the names of the photos that are measured; the run stops at the third while ``stop`` is set."""
    measured = []
    observe = tracking.observe

    def observe_or_stop(path, **looks):
        if observe_or_stop.stop and path.name == A_FEW[2]:
            raise KeyboardInterrupt
        measured.append(path.name)
        return observe(path, **looks)

    observe_or_stop.stop = True
    monkeypatch.setattr(tracking, "observe", observe_or_stop)
    return measured, observe_or_stop


def test_what_was_measured_before_an_interruption_is_not_measured_again(spavision, photos, tmp_path, counted):
    measured, observing = counted
    stopped = spavision("track", photos, "-o", "out")
    assert stopped.code == 130
    assert "same command" in stopped.err
    assert sorted(measured) == list(A_FEW[:2])
    observing.stop = False
    spavision("track", photos, "-o", "out", "-q")
    assert sorted(measured) == list(A_FEW)
    out = tmp_path / "out"
    assert not (out / ".unfinished").exists()
    measured.clear()
    spavision("track", photos, "-o", "whole", "-q")
    assert sorted(measured) == list(A_FEW)
    for name in ("track.csv", "budget.csv", "shape.csv"):
        assert (out / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
    records = [json.loads((tmp_path / run / "run.json").read_text()) for run in ("out", "whole")]
    assert records[0] == records[1]


def test_an_observation_counts_for_the_same_photo_settings_and_whole_file_alone(photos, tmp_path):
    settings, path = TrackSettings(), photos / A_FEW[0]
    (observation,) = tracking.observe_photos([path], settings=settings)
    store = ObservationStore(tmp_path / "kept", settings)
    store.keep(path, observation)
    recalled = store.recall(path)
    assert recalled.board.pose == observation.board.pose
    np.testing.assert_array_equal(recalled.board.pixels, observation.board.pixels)
    np.testing.assert_array_equal(recalled.candidates[0].rim_px, observation.candidates[0].rim_px)
    other = ObservationStore(tmp_path / "kept", TrackSettings(marker_colour="blue"))
    assert other.recall(path) is None
    path.write_bytes(path.read_bytes() + b" ")
    assert store.recall(path) is None
    store.keep(path, observation)
    for file in (tmp_path / "kept").iterdir():
        file.write_bytes(file.read_bytes()[:5000])
    assert store.recall(path) is None
