"""Every example of the documentation runs, and what it finds is so."""

import runpy
from pathlib import Path

import numpy as np
import pytest

GALLERY = Path(__file__).resolve().parent.parent / "docs" / "gallery"


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Return a function that runs an example in an empty folder and gives its variables."""
    monkeypatch.chdir(tmp_path)
    return lambda name: runpy.run_path(str(GALLERY / f"{name}.py"))


def test_every_example_is_run_here():
    source = Path(__file__).read_text(encoding="utf-8")
    missing = [path.stem for path in sorted(GALLERY.glob("*.py")) if f'run("{path.stem}")' not in source]
    assert not missing


@pytest.mark.slow
def test_track_photos(run, tmp_path):
    found = run("track_photos")
    # The article's 71.25 mm at 40 kPa, which the sample photographs are made to pass through.
    assert found["tracked"].tip_path.ux_mm[-1] == pytest.approx(71.25, abs=0.1)
    assert (tmp_path / "results" / "tracked" / "run.json").is_file()
    assert (tmp_path / "tip_path.png").stat().st_size > 5000


@pytest.mark.slow
def test_own_actuator(run):
    found = run("own_actuator")
    # Bending grows when walls get thinner: the same pressure on softer walls.
    assert found["thin"].tip_path.ux_mm[-1] > 1.1 * found["thick"].tip_path.ux_mm[-1] > 0


@pytest.mark.slow
def test_compare_table(run, tmp_path):
    found = run("compare_table")
    table, simulated = found["compared"].table(), found["simulated"].tip_path
    assert table["error_ux_mm"].to_numpy() == pytest.approx(simulated.ux_mm - np.array([0.0, 0.5, 1.1]))
    assert (tmp_path / "results" / "compared" / "report.md").is_file()
