"""The deck for CalculiX and Abaqus: its cards, and CalculiX's own answer."""

from __future__ import annotations

import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.actuator_mesh import actuator_mesh
from spavision.model.composite import PaperLayer
from spavision.model.deck import write_deck
from spavision.model.deck_fibres import fibre_springs
from spavision.model.deck_materials import material_cards
from spavision.model.export import vtk_elements
from spavision.model.geometry import ActuatorGeometry
from spavision.model.materials.gent import Gent
from spavision.model.materials.mooney_rivlin import MooneyRivlin
from spavision.model.materials.neo_hooke import NeoHooke
from spavision.model.materials.ogden import Ogden
from spavision.model.materials.slack_fibre import SlackFibre
from spavision.model.materials.solid import SolidMaterial
from spavision.model.simulate import SimulationSettings, simulate

SHORT = ActuatorGeometry(void_count=3)
MATRIX_ONLY = SimulationSettings(
    mesh_level="draft", paper=PaperLayer(length_modulus_MPa=0.0, width_modulus_MPa=0.0)
)
PRESSURES_KPA = np.array([0.0, 10.0])


def card(law: object) -> list[str]:
    return material_cards("M", SolidMaterial(law, bulk_modulus_MPa=140.0, density_tonne_per_mm3=1e-9))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("law", "option", "numbers"),
    [
        # closed-forms.md, note on conventions: their moduli are mu alpha/2, here 0.131 and 0.009; D1 = 2/κ
        (Ogden((0.131, 0.003), (2.0, 6.0)), "OGDEN, N=2", [0.131, 2.0, 0.009, 6.0, 2.0 / 140.0, 0.0]),
        (NeoHooke(0.14), "NEO HOOKE", [0.07, 2.0 / 140.0]),
        (MooneyRivlin(0.05, 0.02), "POLYNOMIAL, N=2", [0.05, 0.02, 0.0, 0.0, 0.0, 2.0 / 140.0, 0.0]),
    ],
)
def test_material_cards(law: object, option: str, numbers: list[float]) -> None:
    lines = card(law)
    assert lines[1] == f"*HYPERELASTIC, {option}"
    assert [float(number) for number in lines[2].split(",")] == pytest.approx(numbers)


def test_law_without_counterpart_is_refused() -> None:
    with pytest.raises(InputError, match="do not share the law Gent"):
        card(Gent(0.1, 30.0))


def test_springs_carry_the_force_of_the_fibres() -> None:
    """Fibres along y over the half composite of 5 mm × 7.5 mm, stretched by 0.3 with a slack of 0.1."""
    mesh = actuator_mesh(SHORT, level="draft")
    fibre = SlackFibre((0.0, 1.0, 0.0), 8.0, 0.1, 0.05)
    composite = vtk_elements(mesh)[mesh.region == mesh.region_names.index("composite")]
    total = 0.0
    for group in fibre_springs(mesh, composite, fibre):
        ends = mesh.nodes_mm[group.pairs]
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        force = np.interp(0.3 * length, group.elongation_mm, group.force_N)
        crosses = (ends[:, :, 1].min(axis=1) < 1.0) & (ends[:, :, 1].max(axis=1) > 1.0)
        total += float(force[crosses].sum())
    assert total == pytest.approx(8.0 * 0.2 * 5.0 * 7.5, rel=1e-9)


def run_calculix(folder: Path, settings: SimulationSettings) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of the nodes at the tip, and CalculiX's displacements of all nodes at the last pressure."""
    deck = folder / "actuator.inp"
    write_deck(deck, SHORT, crimp_ratio=0.2, pressures_kPa=PRESSURES_KPA, settings=settings)
    deck.write_text(deck.read_text().replace("NSET=MARKER, FREQ", "NSET=NALL, FREQ"))
    run = subprocess.run(["ccx", "actuator"], cwd=folder, capture_output=True, text=True, timeout=120)
    assert "*ERROR" not in run.stdout
    last = (folder / "actuator.dat").read_text().split("displacements")[-1]
    rows = re.findall(r"^ +(\d+) +(\S+) +(\S+) +(\S+)$", last, flags=re.MULTILINE)
    table = np.array(rows, dtype=float)
    return table[:, 0].astype(int) - 1, table[:, 1:]


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")
@pytest.mark.parametrize("has_paper", [False, True])
def test_calculix_runs_the_deck_and_agrees(tmp_path: Path, has_paper: bool) -> None:
    """Displacement of the tip at 10 kPa; on coarse meshes the elements differ by up to a tenth."""
    settings = replace(MATRIX_ONLY, paper=PaperLayer()) if has_paper else MATRIX_ONLY
    nodes, displacement = run_calculix(tmp_path, settings)
    ours = simulate(SHORT, crimp_ratio=0.2, pressures_kPa=PRESSURES_KPA, settings=settings)
    at_tip = np.isclose(ours.mesh.nodes_mm[nodes, 1], SHORT.length_mm)
    expected = displacement[at_tip, :2].mean(axis=0)
    np.testing.assert_allclose(ours.displacement_mm[-1, nodes[at_tip], :2].mean(axis=0), expected, rtol=0.1)
