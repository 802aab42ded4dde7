"""``spavision materials``."""

import json

from spavision.model.materials.material_files import Material, material_text
from spavision.model.materials.neo_hooke import NeoHooke


def test_library_is_listed_with_alternatives_and_paper(spavision):
    outcome = spavision("materials")
    assert outcome.code == 0
    for name in (
        "Mold Star 15",
        "Smooth-Sil 950",
        "Ecoflex 00-30",
        "- Ecoflex 00-30, Liao 2021",
        "Bond paper",
    ):
        assert name in outcome.out


def test_one_material_is_shown_in_every_convention(spavision):
    outcome = spavision("materials", "Smooth-Sil 950")
    assert outcome.code == 0
    for word in ("mu/alpha", "2mu/alpha^2", "c/m^2", "stable, planar", "source"):
        assert word in outcome.out
    assert "0.1 mm" not in outcome.out


def test_paper_is_shown(spavision):
    outcome = spavision("materials", "Bond paper 80 gsm", "--json")
    assert json.loads(outcome.out)["thickness_mm"] == 0.1


def test_json_holds_laws_as_in_the_files(spavision):
    listed = json.loads(spavision("materials", "--json").out)
    laws = {each["name"]: each["law"] for each in listed["materials"]}
    assert laws["Ecoflex 00-30, Sorotoki"] == {
        "kind": "yeoh",
        "c10_MPa": 0.017,
        "c20_MPa": -0.0002,
        "c30_MPa": 0.000023,
    }


def test_own_materials_are_listed(spavision, tmp_path):
    text = material_text(Material("Jelly", NeoHooke(0.002), 1.0, "kitchen"))
    (tmp_path / "jelly.toml").write_text(text, encoding="utf-8")
    assert "Jelly" in spavision("materials", "--materials", str(tmp_path)).out


def test_own_alternatives_stand_below_their_material(spavision, tmp_path):
    own = Material("Zebra gel", NeoHooke(0.04), 1.07, "own test", alternative_to="Ecoflex 00-30")
    (tmp_path / "own.toml").write_text(material_text(own), encoding="utf-8")
    listed = json.loads(spavision("materials", "--materials", str(tmp_path), "--json").out)["materials"]
    names = [each["name"] for each in listed]
    assert names.index("Ecoflex 00-30") < names.index("Zebra gel") < names.index("Mold Star 15")


def test_bad_names_and_folders_are_told(spavision):
    assert spavision("materials", "Jelly").is_one_sentence_about("Jelly", "Ecoflex 00-30")
    assert spavision("materials", "--materials", "none").is_one_sentence_about("none", "--materials")
