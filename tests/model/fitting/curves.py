"""Curves for the tests: the shared data where present, and synthetic ones with known parameters."""

from pathlib import Path

import numpy as np
import pytest

from spavision.model.fitting.curve_files import CurveFormat, read_curve
from spavision.model.fitting.measured_curve import MeasuredCurve
from spavision.model.materials.curves import EQUIBIAXIAL, PLANAR, UNIAXIAL, nominal_stress

DATA = Path(__file__).resolve().parents[4] / "shared" / "data" / "materials"

THREE_TESTS = ((UNIAXIAL, 1.02, 3.0), (EQUIBIAXIAL, 1.02, 2.2), (PLANAR, 1.02, 2.6))


def shared_data(name):
    """Return a path in the shared data, or skip."""
    path = DATA / name
    if not path.exists():
        pytest.skip(f"the shared data ({name}) are not on this machine")
    return path


def treloar():
    """Treloar's three curves."""
    folder = shared_data("rubber_benchmarks/Treloar_1944")
    form = CurveFormat(columns=("stress_MPa", "stretch"))
    return [read_curve(folder / mode / "stress_stretch.txt", form) for mode in ("UT", "ET", "PS")]


def synthetic(law, *, points=40, noise=0.0, seed=0, tests=THREE_TESTS):
    """Curves of a law, with normal noise as a share of each curve's largest stress."""
    rng = np.random.default_rng(seed)
    made = []
    for mode, low, high in tests:
        stretch = np.linspace(low, high, points)
        stress = nominal_stress(law, stretch, mode)
        scatter = rng.normal(0.0, noise * np.abs(stress).max(), points) if noise else 0.0
        made.append(MeasuredCurve(mode.name, mode, stretch, stress + scatter))
    return made
