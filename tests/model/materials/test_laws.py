"""What the laws take and refuse, and the inverse of Langevin's function."""

import numpy as np
import pytest

from spavision.model.materials.arruda_boyce import ArrudaBoyce
from spavision.model.materials.gent import Gent
from spavision.model.materials.inverse_langevin import inverse_langevin, langevin, langevin_slope
from spavision.model.materials.mooney_rivlin import MooneyRivlin
from spavision.model.materials.neo_hooke import NeoHooke
from spavision.model.materials.yeoh import Yeoh


@pytest.mark.parametrize(
    "make",
    [
        lambda: NeoHooke(-0.1),
        lambda: NeoHooke(float("nan")),
        lambda: MooneyRivlin(0.1, -0.2),
        lambda: Yeoh(0.0, 0.1),
        lambda: Gent(0.1, 0.0),
        lambda: ArrudaBoyce(0.1, 1.0),
    ],
)
def test_parameters_without_a_positive_modulus_are_refused(make):
    with pytest.raises(ValueError, match="expected a positive number"):
        make()


def test_inverse_langevin_against_a_table():
    """L(1) = coth 1 − 1 = 0.3130352855, L(10) = 0.9000000041, L(0.01) = 0.00333331111."""
    ratio = np.array([0.31303528549933130, 0.90000000412230725, 0.0033333111113227])
    np.testing.assert_allclose(inverse_langevin(ratio), [1.0, 10.0, 0.01], rtol=1e-11)
    ends = np.array([0.0, 1e-6, 0.5, 0.999999])
    np.testing.assert_allclose(langevin(inverse_langevin(ends)), ends, rtol=1e-13)


def test_langevin_slope_joins_its_series():
    either_side = langevin_slope(np.array([0.15 - 1e-12, 0.15 + 1e-12]))
    assert abs(np.diff(either_side)[0]) < 1e-12


def test_arruda_boyce_modulus_follows_the_published_series():
    """G₀ = μ (1 + 3/(5N) + 99/(175N²) + 513/(875N³) + 42039/(67375N⁴)) (Arruda and Boyce 1993), N large."""
    n = 25.0
    series = 1 + 3 / (5 * n) + 99 / (175 * n**2) + 513 / (875 * n**3) + 42039 / (67375 * n**4)
    assert ArrudaBoyce(0.2, 5.0).shear_modulus_MPa == pytest.approx(0.2 * series, rel=3e-7)


def test_chains_beyond_locking_are_not_admissible():
    law = ArrudaBoyce(0.1, 1.5)
    beyond = np.array([[np.log(3.0), -0.5 * np.log(3.0), -0.5 * np.log(3.0)]])
    assert np.isinf(law.energy(beyond)[0])
    assert np.all(np.isnan(law.derivatives(beyond)[0]))


def test_long_chains_are_neo_hookean():
    stretch = np.array([[0.4, -0.1, -0.3]])
    chains, rubber = ArrudaBoyce(0.1, 1e4), NeoHooke(0.1)
    # the potential is a difference of numbers λm² times as large
    np.testing.assert_allclose(chains.energy(stretch), rubber.energy(stretch), rtol=1e-6)
    np.testing.assert_allclose(chains.derivatives(stretch)[0], rubber.derivatives(stretch)[0], rtol=1e-7)
