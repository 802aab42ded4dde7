"""The materials that come with the program, and the user's."""

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.materials.curves import UNIAXIAL, nominal_stress
from spavision.model.materials.library import (
    FOLDER_VARIABLE,
    all_materials,
    alternatives,
    find_material,
    published_materials,
)
from spavision.model.materials.material_files import Material, material_text
from spavision.model.materials.neo_hooke import NeoHooke
from spavision.model.materials.sheet import published_sheets
from spavision.model.materials.stability import stable_range

AT_DOUBLE_LENGTH = np.array([2.0])


def at_double_length(name):
    """Nominal stress at stretch 2 in uniaxial tension."""
    return nominal_stress(find_material(name).law, AT_DOUBLE_LENGTH, UNIAXIAL)[0]


def test_default_sets_and_their_moduli():
    """½ Σ μα by hand: 0.13134, 0.53353, 0.037332 MPa."""
    for name, modulus in (
        ("Mold Star 15", 0.131336),
        ("Smooth-Sil 950", 0.533535),
        ("Ecoflex 00-30", 0.037332),
    ):
        assert find_material(name).law.shear_modulus_MPa == pytest.approx(modulus, rel=1e-4)


def test_sources_disagree_as_much_as_told():
    """design.md: Smooth-Sil 950 by 2.5 times at stretch 2, Ecoflex by 1.7 to 2 times."""
    stiff = at_double_length("Smooth-Sil 950, Mooney-Rivlin") / at_double_length("Smooth-Sil 950")
    assert stiff == pytest.approx(2.5, abs=0.5)
    liao = at_double_length("Ecoflex 00-30, Liao 2021") / at_double_length("Ecoflex 00-30, Marechal 2021")
    assert liao == pytest.approx(1.75, abs=0.1)


@pytest.mark.parametrize("name", published_materials())
def test_published_materials_are_complete_and_stable_in_tension(name):
    material = published_materials()[name]
    assert material.source
    assert stable_range(material.law, UNIAXIAL).covers(1.0, 3.0)
    if material.alternative_to:
        assert material in alternatives(material.alternative_to)
        assert find_material(material.alternative_to).alternative_to == ""


def test_paper_weighs_what_its_name_says():
    """80 g/m² over 0.10 mm."""
    (paper,) = published_sheets().values()
    assert 1000.0 * paper.density_g_per_cm3 * paper.thickness_mm == pytest.approx(80.0)
    low, high = paper.youngs_modulus_range_MPa
    assert low < paper.youngs_modulus_MPa < high


def test_user_folder_adds_and_replaces(tmp_path, monkeypatch):
    mine = Material("Mold Star 15", NeoHooke(0.2), 1.15, "our batch of May")
    other = Material("Jelly", NeoHooke(0.002), 1.0, "kitchen")
    for number, material in enumerate((mine, other)):
        (tmp_path / f"{number}.toml").write_text(material_text(material), encoding="utf-8")
    assert find_material("Mold Star 15", tmp_path) == mine
    assert find_material("Jelly", tmp_path) == other
    assert find_material(str(tmp_path / "1.toml")) == other
    assert "Jelly" not in all_materials()
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    assert find_material("Jelly") == other


def test_bad_names_and_folders_are_told(tmp_path):
    with pytest.raises(InputError, match=r"'Jelly' is unknown, expected one of .*Ecoflex 00-30"):
        find_material("Jelly")
    with pytest.raises(InputError, match="is not a folder"):
        all_materials(tmp_path / "none")
    for name in ("a", "b"):
        text = material_text(Material("Jelly", NeoHooke(0.002), 1.0, "kitchen"))
        (tmp_path / f"{name}.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="stands in another file too"):
        all_materials(tmp_path)
