"""The calmest frame of each hold, from small videos made here."""

import cv2
import numpy as np
import pytest

from spavision.errors import InputError
from spavision.vision.holds import Hold
from spavision.vision.video import hold_frames, is_video

RATE_HZ = 10


def write_video(path, code, frames):
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*code), float(RATE_HZ), (128, 96))
    for frame in frames:
        writer.write(frame)
    writer.release()


def bar(column):
    """A frame with a bright bar, like an actuator that swings."""
    frame = np.full((96, 128, 3), 40, np.uint8)
    frame[:, column : column + 12] = (40, 40, 200)  # blue, green, red
    return frame


@pytest.fixture
def swinging():
    """Two holds of 4 s; in each the bar swings about 30, then 80 px, at one moment only exactly there."""
    swing = [0, 30, 0, 20, 0, 10] * 4 + [9, -8, 6, 0, -7, 8, 0, 5, -9, 7, 6, -6, 9, -9, 5, -5]
    return [bar(place + offset) for place in (30, 80) for offset in swing]


@pytest.mark.parametrize(("name", "code"), [("clip.avi", "MJPG"), ("clip.mp4", "mp4v")])
def test_the_calmest_frame_of_each_hold_is_taken(tmp_path, swinging, name, code):
    write_video(tmp_path / name, code, swinging)
    frames = list(hold_frames(tmp_path / name, [Hold(0.0, 4.0, 0.0), Hold(4.0, np.inf, 5.0)]))
    assert [frame.hold.pressure_kPa for frame in frames] == [0.0, 5.0]
    for frame, place in zip(frames, (30, 80), strict=True):
        assert frame.hold.start_s + 1.5 < frame.time_s < frame.hold.start_s + 3.7
        red = frame.rgb[48, :, 0].astype(int)
        assert np.flatnonzero(red > 120).mean() == pytest.approx(place + 5.5, abs=6.0)
        np.testing.assert_allclose(frame.rgb[0, 0], 40, atol=12)


def test_videos_that_cannot_serve_are_refused(tmp_path, capfd):
    with pytest.raises(InputError, match=r"absent\.mp4 cannot be read"):
        list(hold_frames(tmp_path / "absent.mp4", [Hold(0, 1, 0.0)]))
    (tmp_path / "text.mp4").write_text("no video")
    with pytest.raises(InputError, match=r"text\.mp4 cannot be read"):
        list(hold_frames(tmp_path / "text.mp4", [Hold(0, 1, 0.0)]))
    write_video(tmp_path / "short.avi", "MJPG", [bar(5)] * 10)
    with pytest.raises(InputError, match=r"short\.avi shows nothing of the hold at 5 kPa .* 1\.0 s"):
        list(hold_frames(tmp_path / "short.avi", [Hold(0, 0.9, 0.0), Hold(7.0, 9.0, 5.0)]))
    assert capfd.readouterr().err == ""


def test_a_folder_is_no_video_whatever_its_name(tmp_path):
    (tmp_path / "photos.mp4").mkdir()
    assert not is_video(tmp_path / "photos.mp4")
    assert is_video(tmp_path / "clip.MOV")
