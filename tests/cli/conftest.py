"""Running the command line inside the test's process, on a few of the sample photos."""

import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from spavision.cli import main

SAMPLES = Path(__file__).resolve().parents[2] / "sample_images"
A_FEW = ("IMG_0000_000kPa.jpg", "IMG_0004_020kPa.jpg", "IMG_0008_040kPa.jpg")


@dataclass(frozen=True)
class Outcome:
    """What a command left behind."""

    code: int
    out: str
    err: str

    def is_one_sentence_about(self, *words: str) -> bool:
        """Whether the command refused its input in one line that holds the given words."""
        lines = [line for line in self.err.splitlines() if ": note: " not in line]
        return (
            self.code == 2
            and len(lines) == 1
            and lines[0].startswith("spavision: ")
            and all(word in lines[0] for word in words)
        )


@pytest.fixture
def spavision(monkeypatch, capsys, tmp_path):
    """Return a function that runs a command in an empty working directory."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments) -> Outcome:
        monkeypatch.setattr(sys, "argv", ["spavision", *(str(argument) for argument in arguments)])
        with pytest.raises(SystemExit) as stopped:
            main.run()
        captured = capsys.readouterr()
        return Outcome(int(stopped.value.code or 0), captured.out, captured.err)

    return call


@pytest.fixture
def photos(tmp_path):
    """Return a folder with three of the sample photos of crimp ratio 0.2 and their experiment file."""
    folder = tmp_path / "photos"
    folder.mkdir()
    for name in (*A_FEW, "experiment.toml"):
        shutil.copy(SAMPLES / "crimp-0.20" / name, folder)
    return folder
