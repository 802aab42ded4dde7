"""Material files: round trip, and what is wrong with them."""

import dataclasses

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.materials.law_tables import law_to_table
from spavision.model.materials.material_files import Material, material_text, parse_material, read_material

from .laws import LAWS

GOOD = """
name = "Rubber"
density_g_per_cm3 = 1.1
source = "a paper"

[law]
kind = "ogden"
convention = "mu/alpha"
mu_MPa = [0.131, 0.003]
alpha = [2, 6.0]
"""


@pytest.mark.parametrize("name", LAWS)
def test_every_law_survives_the_round_trip(name):
    material = Material(
        'Rubber "A"',
        LAWS[name],
        1.07,
        "tests of\n3 µm films",
        uncertain="all",
        strain_range=(-0.3, 2.0),
        alternative_to="Rubber",
    )
    assert parse_material(material_text(material), source="a.toml") == material


def test_material_as_the_solver_takes_it():
    solid = parse_material(GOOD, source="a.toml").solid(bulk_to_shear=500.0)
    # G₀ = (0.131·2 + 0.003·6)/2 = 0.140 MPa (closed-forms.md)
    assert solid.bulk_modulus_MPa == pytest.approx(70.0)
    assert solid.density_tonne_per_mm3 == pytest.approx(1.1e-9)


def test_other_conventions_are_converted():
    """Abaqus writes the same law with μ·α/2 = 0.131 and 0.009 (closed-forms.md, convention)."""
    text = GOOD.replace("mu/alpha", "2mu/alpha^2").replace("[0.131, 0.003]", "[0.131, 0.009]")
    np.testing.assert_allclose(parse_material(text, source="a.toml").law.mu_MPa, [0.131, 0.003], rtol=1e-14)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('name = "Rubber"', "", "name is missing"),
        ('name = "Rubber"', "name = 3", "expected text in quotes"),
        ("density_g_per_cm3 = 1.1", "density_g_per_cm3 = 1100", "expected 0.1 to 10"),
        ("source", "sauce", "unknown key sauce"),
        ('kind = "ogden"', 'kind = "hooke"', "expected one of ogden, neo-hooke"),
        ('convention = "mu/alpha"', "", "convention is missing"),
        ("mu/alpha", "abaqus", "Ogden convention 'abaqus' is unknown"),
        ("[0.131, 0.003]", "0.131", "expected a list of numbers"),
        ("[0.131, 0.003]", '["a", 1]', "expected a number"),
        ("[0.131, 0.003]", "[0.131]", "as many moduli"),
        ("[0.131, 0.003]", "[-0.131, 0.003]", "shear modulus"),
        ("alpha = [2, 6.0]", "alpha = [2, 6.0]\nbeta = 1", "unknown key beta"),
        ('kind = "ogden"', 'kind = "yeoh"', "c10_MPa is missing"),
        ("[law]", "law = 1\n[other]", "expected"),
        ("[law]", "strain_range = [2, 1]\n[law]", "two engineering strains"),
        ("[law]", "[law", "not valid TOML"),
    ],
)
def test_bad_files_are_told(old, new, sentence):
    assert old in GOOD
    with pytest.raises(InputError, match=sentence) as caught:
        parse_material(GOOD.replace(old, new), source="rubber.toml")
    assert str(caught.value).startswith("rubber.toml")


def test_files_that_cannot_be_read_are_told(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_material(tmp_path / "none.toml")
    (tmp_path / "bad.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match="UTF-8"):
        read_material(tmp_path / "bad.toml")


def test_laws_unknown_to_files_are_refused():
    @dataclasses.dataclass(frozen=True)
    class Other:
        shear_modulus_MPa: float = 1.0

    with pytest.raises(TypeError, match="no form in material files"):
        law_to_table(Other())
