"""The entry point: help without heavy imports, the version, internal errors."""

import subprocess
import sys

from spavision import __version__
from spavision.cli import main


def test_help_names_every_command_and_loads_no_heavy_package():
    code = (
        "import sys\nsys.argv = ['spavision', '--help']\nfrom spavision.cli.main import run\n"
        "try:\n    run()\nexcept SystemExit:\n    pass\n"
        "heavy = {'numpy', 'pandas', 'matplotlib', 'skfem', 'cv2', 'scipy', 'numba'} & set(sys.modules)\n"
        "assert not heavy, heavy"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert all(f" {name} " in done.stdout for name in main.COMMANDS)


def test_every_command_has_a_help_page(spavision):
    for name in main.COMMANDS:
        outcome = spavision(name, "--help")
        assert outcome.code == 0
        assert "Usage: spavision" in outcome.out


def test_version(spavision):
    assert spavision("--version").out.strip() == f"spavision, version {__version__}"


def test_an_unknown_command_is_refused(spavision):
    outcome = spavision("trak")
    assert outcome.code == 2
    assert "trak" in outcome.err


def test_an_internal_error_shows_its_traceback_only_when_debugging(spavision, monkeypatch):
    def fail(*_arguments, **_options):
        raise RuntimeError("gone wrong")

    monkeypatch.setattr("spavision.cli.options.parse_pressures", fail)
    outcome = spavision("simulate", "--crimp", "0.2")
    assert outcome.code == 1
    assert "Traceback" not in outcome.err
    assert "gone wrong" in outcome.err
    assert "Traceback" in spavision("--debug", "simulate", "--crimp", "0.2").err
