"""Experiment files: defaults, overlays and one sentence for each defect."""

import pytest

from spavision.errors import InputError
from spavision.experiment import Experiment, read_experiment
from spavision.vision.settings import TrackSettings


def write(folder, text):
    path = folder / "experiment.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_an_empty_file_means_the_article_s_set_up(tmp_path):
    experiment = read_experiment(write(tmp_path, ""))
    assert experiment.board.square_mm == 2.5
    assert experiment.actuator.void_count * experiment.actuator.pitch_mm == pytest.approx(157.5)
    assert experiment.camera.standoff_mm is None


def test_options_lie_over_the_file(tmp_path):
    experiment = read_experiment(write(tmp_path, "[camera]\nstandoff_mm = 20\ndistance_mm = 700\n"))
    changed = experiment.with_options({"camera": {"distance_mm": 650.0, "standoff_mm": None}})
    assert (changed.camera.standoff_mm, changed.camera.distance_mm) == (20, 650)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[board]\nsquare_mm = -2.5\n", "[board] square_mm is -2.5: input should be greater than"),
        ("[camera]\nstandof_mm = 20\n", "did you mean standoff_mm?"),
        ("[kamera]\nstandoff_mm = 20\n", "did you mean camera?"),
        ("[camera]\ndistance_mm = 1e9\n", "less than or equal to 20000"),
        ("[camera]\ndistance_mm = nan\n", "distance_mm is nan"),
        ('[board]\nsquare_mm = "wide"\n', "valid number"),
        ("[actuator]\ncrimp_ratio = 0.9\n", "crimp_ratio is 0.9"),
        ('[actuator]\nfirst_bend = "up"\n', "'right' or 'left'"),
        ('[photos]\npressures = "table"\n', "needs the key table"),
        ("[board\n", "is not valid TOML"),
    ],
)
def test_each_defect_is_told_in_one_sentence_that_names_file_and_key(tmp_path, text, said):
    with pytest.raises(InputError) as caught:
        read_experiment(write(tmp_path, text))
    assert "experiment.toml" in str(caught.value)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_bad_option_names_the_command_line():
    with pytest.raises(InputError, match=r"command line: \[actuator\] crimp_ratio is 0\.05"):
        Experiment().with_options({"actuator": {"crimp_ratio": 0.05}})


def test_a_missing_file_is_told(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_experiment(tmp_path / "experiment.toml")


def test_defaults_are_the_model_s():
    from spavision.model.geometry import ActuatorGeometry
    from spavision.model.simulate import SimulationSettings

    actuator = Experiment().actuator
    assert ActuatorGeometry(**actuator.geometry()) == ActuatorGeometry()
    assert actuator.body_material == SimulationSettings().body_material
    assert actuator.strip_b_material == SimulationSettings().strip_b_material
    assert Experiment().model.mesh == SimulationSettings().mesh_level


def test_defaults_of_uncertainties_are_the_trackers_own():
    said, own = Experiment(), TrackSettings()
    assert said.camera.sigma_standoff_mm == own.sigma_standoff_mm
    assert said.camera.sigma_distance_mm == own.sigma_distance_mm
    assert said.board.sigma_scale == own.sigma_board_scale
    assert said.marker.sigma_out_of_plane_mm == own.sigma_out_of_plane_mm
