"""Calibration against the renderer's truth, OpenCV's published result and its own scatter."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from spavision.errors import InputError
from spavision.render.render import render_photo
from spavision.render.settings import RenderSettings
from spavision.render.trajectory import sample_trajectory
from spavision.vision.adjustment import View
from spavision.vision.bundle import PARAMETERS, LensModel, adjust_bundle, parameter_values
from spavision.vision.calibrate import calibrate
from spavision.vision.calibration import CalibrationSettings
from spavision.vision.calibration_corners import BoardCorners, lattice_corners, within_board
from spavision.vision.camera import Camera, Pose, project
from spavision.vision.coverage_figure import coverage_figure
from spavision.vision.photos import find_photos

REAL = Path(__file__).resolve().parents[3] / "shared" / "data" / "photos" / "opencv_left"
needs_real_photos = pytest.mark.skipif(not REAL.is_dir(), reason="needs ../shared/data/photos/opencv_left")

SIZE = (640, 480)
FOCAL_PX = 750.0
TRUTH = np.array([FOCAL_PX, FOCAL_PX, 325.5, 235.5, -0.2, 0.05, 0.0, 0.0, 0.0])
SQUARE_MM = 20.0

VIEWS = (
    (0, 0, 0, 0, 0, 420),
    (30, 0, 5, 70, 30, 400),
    (-30, 5, -4, -70, 40, 400),
    (4, 30, 2, 50, -50, 400),
    (0, -30, 0, -50, -60, 400),
    (25, 25, 10, 80, 65, 420),
    (-25, -25, 0, -80, -65, 420),
    (-25, 25, 90, -80, 65, 420),
    (25, -25, -5, 80, -60, 420),
    (15, 0, 45, 0, 0, 330),
)
"""Yaw, pitch, roll (degrees), point aimed at (mm) and distance (mm) of each photograph."""


def render_board(folder, views=VIEWS, **board):
    """Photographs of a board of 11 by 8 squares of 20 mm, at 28 to 45 px each, cut by the frame in some."""
    paths = []
    trajectory = sample_trajectory(0.3, np.array([0.0, 5.0]))
    for number, (yaw, pitch, roll, x, y, distance) in enumerate(views):
        settings = RenderSettings(seed=number)
        settings = replace(
            settings,
            image=replace(settings.image, width_px=SIZE[0], height_px=SIZE[1]),
            board=replace(
                settings.board,
                **({"columns": 11, "rows": 8, "square_mm": SQUARE_MM, "margin_mm": 15.0} | board),
            ),
            actuator=replace(settings.actuator, visible=False),
            camera=replace(
                settings.camera,
                distance_mm=float(distance),
                square_px=FOCAL_PX * board.get("square_mm", SQUARE_MM) / distance,
                yaw_deg=float(yaw),
                pitch_deg=float(pitch),
                roll_deg=float(roll),
                aim_x_mm=float(x),
                aim_y_mm=float(y),
                k1=float(TRUTH[4]),
                k2=float(TRUTH[5]),
                cx_offset_px=float(TRUTH[2] - (SIZE[0] - 1) / 2),
                cy_offset_px=float(TRUTH[3] - (SIZE[1] - 1) / 2),
            ),
        )
        paths.append(folder / f"board{number:02d}.jpg")
        Image.fromarray(render_photo(settings, trajectory, 0).pixels).save(paths[-1], quality=92)
    return paths


@pytest.fixture(scope="module")
def rendered(tmp_path_factory):
    return render_board(tmp_path_factory.mktemp("board"))


@pytest.fixture(scope="module")
def calibration(rendered):
    return calibrate(rendered, CalibrationSettings(square_mm=SQUARE_MM))


def pulls(camera, covariance, truth=TRUTH):
    """Deviation of each parameter from the truth, in its own standard deviations."""
    return (np.array(parameter_values(camera)) - truth) / np.sqrt(np.diag(covariance))


def test_rendered_camera_is_recovered_within_its_own_uncertainty(calibration):
    # The truth is the renderer's, which projects by code of its own.
    assert np.abs(pulls(calibration.camera, calibration.covariance)).max() < 3
    sigma = dict(zip(PARAMETERS, np.sqrt(np.diag(calibration.covariance)), strict=True))
    assert sigma["fx_px"] < 1.0
    assert sigma["k1"] < 0.01
    assert calibration.rms_px < 0.1
    assert calibration.board == (10, 7)
    assert calibration.left_out == ()


def test_boards_cut_by_the_frame_and_good_coverage_give_no_note(calibration):
    assert any(len(photo.corners.pixels) < 70 for photo in calibration.photos)
    assert calibration.notes == ()


def test_distances_are_the_renders(calibration):
    measured = [photo.pose.distance_mm for photo in calibration.photos]
    np.testing.assert_allclose(measured, [view[5] for view in VIEWS], rtol=2e-3)


def test_the_same_photos_give_the_same_camera(rendered, calibration):
    again = calibrate(rendered, CalibrationSettings(square_mm=SQUARE_MM))
    assert again.camera == calibration.camera
    np.testing.assert_array_equal(again.covariance, calibration.covariance)


def test_square_scales_distances_alone(rendered):
    doubled = calibrate(rendered[:6], CalibrationSettings(square_mm=2 * SQUARE_MM))
    single = calibrate(rendered[:6], CalibrationSettings(square_mm=SQUARE_MM))
    assert doubled.camera.fx == pytest.approx(single.camera.fx, rel=1e-5)
    ratio = doubled.photos[0].pose.distance_mm / single.photos[0].pose.distance_mm
    assert ratio == pytest.approx(2.0, rel=1e-5)


def test_a_board_too_small_for_a_lattice_is_found_when_its_size_is_told(tmp_path):
    paths = render_board(tmp_path, VIEWS[:4], columns=5, rows=4, square_mm=30.0)
    told = calibrate(paths, CalibrationSettings((4, 3), 30.0, model=LensModel(True, True, True, True)))
    assert told.camera.fx == pytest.approx(FOCAL_PX, rel=0.03)
    with pytest.raises(InputError, match="fewer than 20"):
        calibrate(paths, CalibrationSettings())


@needs_real_photos
def test_opencvs_published_calibration_is_reproduced():
    # left_intrinsics.yml beside the photos: fx 535.916, RMS 0.3926 px, aspect ratio fixed.
    settings = CalibrationSettings((9, 6), 25.0, finder="opencv", model=LensModel(fix_aspect_ratio=True))
    found = calibrate(find_photos(REAL), settings)
    assert found.camera.fx == pytest.approx(535.916, abs=0.3)
    assert found.camera.fy == found.camera.fx
    assert found.rms_px == pytest.approx(0.3926, abs=0.002)
    assert found.camera.distortion == pytest.approx(
        (-0.26637, -0.038589, 0.0017832, -0.00028122, 0.23839), abs=1e-3
    )
    # In left02 squares are smaller than OpenCV's window: its published per-view error is 1.18 px.
    assert any(note.startswith("left02.jpg fits far worse") for note in found.notes)


@needs_real_photos
def test_a_wrong_number_of_corners_is_told_though_a_few_photos_would_pass():
    with pytest.raises(InputError, match=r"shows 9×6 corners, not 8×6; correct --corners"):
        calibrate(find_photos(REAL), CalibrationSettings((8, 6), 25.0))


@needs_real_photos
def test_windows_scaled_to_the_squares_fit_real_photos_better():
    settings = CalibrationSettings(square_mm=25.0, model=LensModel(fix_aspect_ratio=True))
    found = calibrate(find_photos(REAL), settings)
    assert found.board == (9, 6)
    assert sum(len(photo.corners.pixels) for photo in found.photos) >= 0.99 * 13 * 54
    # OpenCV's own corners, with a window of 5 px that no square is smaller than, leave 0.196 px.
    assert found.rms_px < 0.196
    # The corners of the frame stay empty in these photos, the left ones by far.
    (coverage,) = [note for note in found.notes if note.startswith("poor coverage")]
    assert "upper left" in coverage
    assert "lower left" in coverage


def exact_views(truth, n_views=8, noise_px=0.0, seed=0):
    """Corners by OpenCV's projection with noise, no photograph between."""
    random = np.random.default_rng(seed)
    points = np.stack(np.meshgrid(np.arange(9.0), np.arange(6.0)), axis=-1).reshape(-1, 2) * 20 - [80, 50]
    angles = np.linspace(0, 2 * np.pi, n_views, endpoint=False)
    views = []
    for angle in angles:
        pose = Pose((0.5 * np.cos(angle), 0.5 * np.sin(angle), 0.1), (30 * np.sin(angle), 20.0, 300.0))
        pixels = project(truth, pose, points)
        views.append(View(points, pixels + noise_px * random.standard_normal(pixels.shape)))
    return views


def test_covariance_is_the_scatter_of_repeated_calibrations():
    # 120 repetitions: a standard deviation is known to 6.5 %.
    truth = Camera(500.0, 505.0, 321.0, 242.0, (-0.1, 0.02, 0.001, -0.001, 0.0), *SIZE)
    model = LensModel(zero_k3=True)
    runs = [adjust_bundle(exact_views(truth, noise_px=0.1, seed=k), SIZE, model) for k in range(120)]
    values = np.array([parameter_values(run.camera) for run in runs])
    expected = np.mean([np.diag(run.covariance) for run in runs], axis=0)
    np.testing.assert_allclose(values.std(axis=0, ddof=1)[:8], np.sqrt(expected)[:8], rtol=0.2)
    assert expected[8] == 0
    assert np.mean([run.sigma_px for run in runs]) == pytest.approx(0.1, rel=0.02)


@pytest.mark.parametrize(
    ("model", "fixed"),
    [
        (LensModel(fix_aspect_ratio=True), {}),
        (LensModel(fix_principal_point=True), {"cx_px": 319.5, "cy_px": 239.5}),
        (LensModel(zero_tangential=True, zero_k3=True), {"p1": 0.0, "p2": 0.0, "k3": 0.0}),
    ],
)
def test_what_is_fixed_stays_and_has_no_variance(model, fixed):
    truth = Camera(500.0, 500.0, 319.5, 239.5, (-0.1, 0.02, 0.0, 0.0, 0.0), *SIZE)
    found = adjust_bundle(exact_views(truth, noise_px=0.05), SIZE, model)
    values = dict(zip(PARAMETERS, parameter_values(found.camera), strict=True))
    for name, value in fixed.items():
        assert values[name] == pytest.approx(value, abs=0.51)
        assert found.covariance[PARAMETERS.index(name)].any() == 0
    if model.fix_aspect_ratio:
        assert found.camera.fx == found.camera.fy
        assert found.covariance[0, 0] == found.covariance[1, 1] == found.covariance[0, 1] > 0
    free = [k for k, name in enumerate(PARAMETERS) if name not in fixed]
    truth_values = np.array(parameter_values(truth))
    assert np.abs(pulls(found.camera, found.covariance + 1e-30 * np.eye(9), truth_values)[free]).max() < 4


def test_sigma_is_opencvs_own():
    truth = Camera(500.0, 505.0, 321.0, 242.0, (-0.1, 0.02, 0.001, -0.001, 0.0), *SIZE)
    views = exact_views(truth, noise_px=0.1)
    found = adjust_bundle(views, SIZE, LensModel())
    points = [np.column_stack([v.points_mm, np.zeros(len(v.points_mm))]).astype(np.float32) for v in views]
    pixels = [v.pixels.astype(np.float32) for v in views]
    deviations = cv2.calibrateCameraExtended(points, pixels, SIZE, np.eye(3), np.zeros(5))[5].ravel()[:9]
    np.testing.assert_allclose(np.sqrt(np.diag(found.covariance)), deviations, rtol=0.01)


def grid(columns, rows):
    indices = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2)
    return BoardCorners(indices.astype(np.intp), indices * 10.0)


def test_a_stray_row_beside_the_board_is_dropped():
    board = grid(9, 6)
    stray = BoardCorners(
        np.vstack([board.indices, [[4, 6]]]).astype(np.intp), np.vstack([board.pixels, [[1.0, 1.0]]])
    )
    kept = within_board(stray, (9, 6))
    np.testing.assert_array_equal(kept.indices, board.indices)
    assert within_board(stray, (6, 9)).extent == (9, 6)


def test_a_larger_board_is_not_the_one_asked_for():
    assert within_board(grid(9, 6), (8, 5)) is None
    assert within_board(grid(9, 6), (11, 9)).extent == (9, 6)


def test_no_board_gives_no_corners():
    assert lattice_corners(np.full((200, 300), 120, np.float32), None) is None
    assert lattice_corners(np.full((200, 300), 120, np.float32), (4, 3)) is None


def test_boards_that_face_the_camera_squarely_are_refused_or_warned_of(tmp_path):
    paths = render_board(tmp_path, ((0, 0, 0, 0, 0, 420), (0, 0, 5, 20, 0, 420), (0, 0, -5, -20, 5, 430)))
    try:
        notes = calibrate(paths, CalibrationSettings(square_mm=SQUARE_MM)).notes
    except InputError as error:
        notes = (str(error),)
    assert any("tilted" in note for note in notes)


def test_copies_and_broken_photos_are_left_out_by_name(rendered, tmp_path):
    broken = tmp_path / "broken.jpg"
    broken.write_bytes(b"no picture")
    copy = tmp_path / "copy.jpg"
    copy.write_bytes(rendered[0].read_bytes())
    blank = tmp_path / "blank.png"
    Image.new("RGB", SIZE, (128, 128, 128)).save(blank)
    found = calibrate([*rendered[:4], broken, copy, blank], CalibrationSettings(square_mm=SQUARE_MM))
    assert [name for name, _ in found.left_out] == ["broken.jpg", "copy.jpg", "blank.png"]
    assert found.left_out[1][1] == "is a copy of board00.jpg"
    assert any(note.startswith("blank.png was left out: no board") for note in found.notes)


def test_the_figure_shows_map_and_tilts(calibration):
    figure = coverage_figure(calibration)
    titles = [axes.get_title() for axes in figure.axes]
    corners = sum(len(photo.corners.pixels) for photo in calibration.photos)
    assert f"{corners} corners of {len(VIEWS)} photos" in titles[0]
    assert "Tilt" in titles[1]
