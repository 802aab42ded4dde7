"""The virtual tensile test against laminates, homogeneous layers, and its own energy."""

from dataclasses import replace

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.coupon.cell import Cell, CellSettings, CellState
from spavision.model.coupon.coupon import CouponSettings, pull_coupon
from spavision.model.coupon.geometry import CouponGeometry
from spavision.model.coupon.paper import Paper
from spavision.model.coupon.plane_mesh import MeshDensity
from spavision.model.materials.curves import PLANAR, nominal_stress
from spavision.model.materials.library import find_material
from spavision.model.materials.ogden import Ogden
from spavision.model.materials.solid import SolidMaterial

BODY = SolidMaterial(Ogden((0.131, 0.003), (2.0, 6.0)), 140.0, 1.15e-9)
COARSE = MeshDensity(fold=1, leg=5, side=2)
NO_PAPER = Paper(modulus_MPa=0.0)


def pull(crimp_ratio=0.3, *, matrix=BODY, paper=None, lateral="plane-strain", end=1.0, step=0.1, **geometry):
    settings = CouponSettings(step, end, CellSettings(lateral, density=COARSE))
    shape = CouponGeometry(crimp_ratio, **geometry)
    return pull_coupon(shape, matrix=matrix, paper=paper or Paper(), settings=settings)


def stress_at(coupon, strain):
    row = np.flatnonzero(np.isclose(coupon.strain, strain))[0]
    return coupon.stress_MPa[row]


def test_without_paper_the_cell_is_in_pure_shear():
    """Row 4 of the closed forms (BODY, planar), nearly incompressible."""
    stiff = replace(BODY, bulk_modulus_MPa=14000.0)
    coupon = pull(matrix=stiff, paper=NO_PAPER)
    assert stress_at(coupon, 0.5) == pytest.approx(0.180290852, rel=1e-4)
    assert stress_at(coupon, 1.0) == pytest.approx(0.341601563, rel=1e-4)
    np.testing.assert_allclose(coupon.width_strain, 0.0)


def test_without_paper_generalised_plane_stress_is_uniaxial_tension():
    """Row 2 of the closed forms (BODY, κ = 140 MPa): stress and lateral stretch."""
    coupon = pull(paper=NO_PAPER, lateral="plane-stress")
    assert stress_at(coupon, 0.5) == pytest.approx(0.160353990, rel=1e-7)
    assert stress_at(coupon, 1.0) == pytest.approx(0.324480727, rel=1e-7)
    row = np.flatnonzero(np.isclose(coupon.strain, 0.5))[0]
    assert 1.0 + coupon.width_strain[row] == pytest.approx(0.816730215, rel=1e-7)


def test_straight_paper_makes_a_laminate():
    """Rule of mixtures: matrix in planar tension and the sheet's E/(1 − ν²) t side by side."""
    paper = Paper(cross_ratio=1.0, strength_MPa=1e9)
    stiff = replace(BODY, bulk_modulus_MPa=14000.0)
    coupon = pull(0.0, matrix=stiff, paper=paper, end=0.2, step=0.05)
    sheet = paper.modulus_MPa / (1.0 - paper.poissons_ratio**2) * paper.thickness_mm / 5.0
    expected = nominal_stress(BODY.law, 1.0 + coupon.strain, PLANAR) + sheet * coupon.strain
    np.testing.assert_allclose(coupon.stress_MPa, expected, rtol=1e-5, atol=1e-12)


def test_straight_paper_free_to_narrow_carries_its_youngs_modulus():
    """Paper alone in plane stress: the sheet contracts by ν and takes E t; the matrix hardly adds to it."""
    soft = SolidMaterial(Ogden((1e-4,), (2.0,)), 0.1, 1e-9)
    paper = Paper(cross_ratio=1.0, strength_MPa=1e9)
    coupon = pull(0.0, matrix=soft, paper=paper, lateral="plane-stress", end=0.01, step=0.005)
    assert coupon.stress_MPa[-1] == pytest.approx(4500.0 * 0.1 / 5.0 * 0.01, rel=1e-4)
    assert coupon.width_strain[-1] == pytest.approx(-0.3 * 0.01, rel=1e-3)


def test_work_done_is_energy_stored():
    """Trapezoidal rule over the curve against the strain energy, an error of the step squared."""
    coupon = pull(0.3, end=0.4, step=0.01)
    work = np.trapezoid(coupon.stress_MPa, coupon.strain) * 5.0 * 2.5
    assert coupon.cell.energy(coupon.states[-1]) == pytest.approx(work, rel=1e-3)


@pytest.mark.parametrize("lateral", ["plane-strain", "plane-stress"])
def test_tangent_against_finite_differences(lateral):
    cell = Cell(
        CouponGeometry(0.3),
        matrix=BODY,
        paper=Paper(),
        settings=CellSettings(lateral, hinged_folds=True, density=COARSE),
    )
    rng = np.random.default_rng(3)
    state = CellState(0.01 * rng.standard_normal(cell.n_unknowns), cell.at_rest().pressure)
    balance = cell.balance(state)
    state = CellState(state.unknowns, balance.pressure)
    upper, column = cell.tangent(state, balance)
    full = upper.toarray()
    full = full + np.triu(full, 1).T
    move = rng.standard_normal(cell.n_unknowns)
    step = 1e-6
    ends = [cell.balance(CellState(state.unknowns + s * step * move, state.pressure)) for s in (1, -1)]
    expected = (ends[0].forces - ends[1].forces) / (2 * step)
    np.testing.assert_allclose(
        full @ move[:-1] + column * move[-1], expected[:-1], atol=1e-6 * np.abs(expected).max()
    )


def test_crimped_paper_decrimps_before_it_tears():
    """Soft at first, stiff past the strain at which the paper is straight; tears at its strength."""
    matrix = find_material("Ecoflex 00-30").solid()
    coupon = pull(0.3, matrix=matrix, end=1.0, step=0.02)
    assert coupon.ended_by == "tear"
    assert coupon.paper_tension_MPa[-1] == pytest.approx(35.0, rel=2e-3)
    straight = coupon.cell.geometry.straight_strain
    # a paper of 4500 MPa at 35 MPa is stretched by 0.8 %; the rest is a bow that is left
    assert straight - 0.03 < coupon.strain[-1] < straight + 0.008 * (1.0 + straight)
    point = coupon.transition()
    assert point.secondary.modulus_MPa > 10.0 * point.primary.modulus_MPa
    # the paper can only stiffen the matrix, whose plane-strain modulus is 4 G
    assert point.primary.modulus_MPa > 0.9 * 4.0 * matrix.law.shear_modulus_MPa


def test_mesh_is_fine_enough():
    """The default mesh's transition point and moduli against a much finer one."""
    found = []
    for density in (MeshDensity(), MeshDensity(fold=4, leg=16, side=6)):
        settings = CouponSettings(0.03, 0.5, CellSettings(density=density))
        matrix = find_material("Ecoflex 00-30").solid()
        coupon = pull_coupon(CouponGeometry(0.3), matrix=matrix, paper=Paper(), settings=settings)
        point = coupon.transition()
        found.append([point.strain, point.primary.modulus_MPa, point.secondary.modulus_MPa])
    np.testing.assert_allclose(found[0], found[1], rtol=2e-3)


def test_path_length_of_rounded_folds():
    """Straight strain from the arcs' and legs' lengths, summed over a fine polygon."""
    geometry = CouponGeometry(0.25, wavelength_mm=6.0, fold_radius_mm=0.4)
    path = np.linspace(0.0, 0.5 * 6.0 * (1.0 + geometry.straight_strain), 20001)
    points = geometry.points(path)
    length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    assert length / 3.0 - 1.0 == pytest.approx(geometry.straight_strain, rel=1e-6)
    np.testing.assert_allclose(points[-1], [3.0, -points[0, 1]], atol=1e-9)


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ({"crimp_ratio": 0.9}, "crimp ratio"),
        ({"crimp_ratio": float("nan")}, "crimp ratio"),
        ({"crimp_ratio": 0.3, "wavelength_mm": 9.0}, "does not fit"),
        ({"crimp_ratio": 0.3, "wavelength_mm": -1.0}, "wavelength_mm"),
        ({"crimp_ratio": 0.3, "fold_radius_mm": 3.0}, "fold_radius_mm"),
    ],
)
def test_impossible_shapes_are_refused(arguments, word):
    with pytest.raises(InputError, match=word):
        CouponGeometry(**arguments)


@pytest.mark.parametrize(
    ("settings", "word"),
    [
        (CouponSettings(strain_step=0.5), "strain step"),
        (CouponSettings(end_strain=9.0), "end strain"),
        (CouponSettings(cell=CellSettings(lateral="loose")), "lateral"),
    ],
)
def test_impossible_tests_are_refused(settings, word):
    with pytest.raises(InputError, match=word):
        pull_coupon(CouponGeometry(0.3), matrix=BODY, paper=Paper(), settings=settings)
