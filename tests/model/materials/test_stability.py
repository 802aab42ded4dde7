"""Drucker's condition against cases that can be worked out by hand."""

import numpy as np
import pytest

from spavision.model.materials.curves import EQUIBIAXIAL, MODES, PLANAR, UNIAXIAL, locking_stretches
from spavision.model.materials.gent import Gent
from spavision.model.materials.mooney_rivlin import MooneyRivlin
from spavision.model.materials.neo_hooke import NeoHooke
from spavision.model.materials.ogden import Ogden
from spavision.model.materials.stability import drucker_margin, stable_range, stable_ranges


@pytest.mark.parametrize("mode", MODES)
def test_margin_of_neo_hooke_is_known(mode):
    """H = 2G diag(λ²): the smaller eigenvalue over G of [[a + c, c], [c, b + c]], a, b, c = 2λᵢ²."""
    stretch = np.array([0.7, 1.0, 2.0])
    a, b, c = 2.0 * np.exp(2.0 * MODES[mode].log_stretch(stretch)).T
    expected = [np.linalg.eigvalsh([[x + z, z], [z, y + z]])[0] for x, y, z in zip(a, b, c, strict=True)]
    np.testing.assert_allclose(drucker_margin(NeoHooke(0.3), stretch, MODES[mode]), expected, rtol=1e-10)


def test_mooney_rivlin_with_a_negative_term_loses_stability_where_hand_calculation_says():
    """Equibiaxial, C₀₁ = −C₁₀/10: of the two increments that keep or break the symmetry, the former has
    dτ/d ln λ ~ C₁₀(4λ² + 8λ⁻⁴) + C₀₁(4λ⁻² + 8λ⁴) and vanishes first."""
    law = MooneyRivlin(1.0, -0.1)
    stretch = np.linspace(1.0, 5.0, 400001)
    symmetric = 4 * stretch**2 + 8 * stretch**-4 - 0.1 * (4 * stretch**-2 + 8 * stretch**4)
    expected = stretch[np.argmax(symmetric < 0.0)]
    found = stable_range(law, EQUIBIAXIAL)
    assert found.highest == pytest.approx(expected, abs=1e-4)
    assert found.highest_is_found
    assert not found.covers(1.0, expected + 0.01)
    assert found.covers(1.0, expected - 0.01)


def test_equibiaxial_tension_is_uniaxial_compression():
    """Stretch x in the one is x⁻² in the other: the same state, so the same limits."""
    law = Ogden((0.2, -0.01), (1.2, 4.0))
    ranges = stable_ranges(law)
    assert ranges["equibiaxial"].highest == pytest.approx(ranges["uniaxial"].lowest ** -0.5, rel=1e-9)
    assert ranges["equibiaxial"].lowest == pytest.approx(ranges["uniaxial"].highest ** -0.5, rel=1e-9)


def test_ogden_with_positive_products_is_stable_everywhere():
    """Each term is convex in the log stretches where μα > 0 (Hill 1970); exponent −21 is hard on rounding."""
    law = Ogden((-6.50266e-6, 0.216863, 0.00137158), (-21.322, 1.1797, 4.88396))
    assert all(each.covers(0.1, 10.0) for each in stable_ranges(law).values())


def test_a_locking_law_is_stable_up_to_its_locking_stretch():
    law = Gent(0.1, 5.0)
    found = stable_range(law, PLANAR)
    assert (found.lowest, found.highest) == pytest.approx(locking_stretches(law, PLANAR))
    assert found.highest_is_found


def test_range_is_printed_with_what_is_known():
    printed = str(stable_range(Ogden((0.2, -0.01), (1.2, 4.0)), UNIAXIAL))
    assert printed.startswith("uniaxial: stretch 0.2")
    assert str(stable_range(NeoHooke(0.1), UNIAXIAL)) == "uniaxial: stretch 0.1 or less to 10 or more"
