"""Dimensions, their checks and the mesh made of them."""

from __future__ import annotations

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model import memory
from spavision.model.actuator_mesh import MESH_LEVELS, REGIONS, actuator_mesh
from spavision.model.cavity import Cavity
from spavision.model.element_geometry import element_geometry
from spavision.model.geometry import ActuatorGeometry
from spavision.model.observe import locate

SMALL = ActuatorGeometry(void_count=3)
CLOSED_AND_CLAMPED = ActuatorGeometry(void_count=3, void_floor_mm=1.5, clamp_length_mm=7.0)


def test_published_dimensions() -> None:
    geometry = ActuatorGeometry()
    assert geometry.length_mm == 157.5
    # 13 voids of 8 mm, two shortened to 6.75 mm, 10 mm × 15 mm wide; 14 channels of 2.5 mm, 2 mm × 2 mm
    assert geometry.gas_volume_mm3() == pytest.approx((13 * 8 + 2 * 6.75) * 150 + 14 * 2.5 * 4)


def test_a_floor_takes_from_the_voids_but_not_from_the_channel() -> None:
    geometry = ActuatorGeometry(void_floor_mm=1.5)
    assert geometry.gas_volume_mm3() == pytest.approx((13 * 8 + 2 * 6.75) * 10 * 13.5 + 14 * 2.5 * 4)


@pytest.mark.parametrize("level", MESH_LEVELS)
@pytest.mark.parametrize("shape", [SMALL, CLOSED_AND_CLAMPED], ids=["open", "closed"])
def test_mesh_volumes(level: str, shape: ActuatorGeometry) -> None:
    mesh = actuator_mesh(shape, level=level)
    volume = element_geometry(mesh).volumes.sum(axis=1)
    base = shape.length_mm * shape.width_mm / 2
    expected = {
        "composite": 5.0 * base,
        "strip A": 1.0 * base,
        "body": 17.5 * base - 0.5 * shape.gas_volume_mm3(),
        "strip B": 3.0 * base,
    }
    for code, name in enumerate(REGIONS):
        assert volume[mesh.region == code].sum() == pytest.approx(expected[name], rel=1e-12)
    gas = Cavity(mesh.cavity_faces, mesh.order).volume(mesh.nodes_mm)
    assert 2.0 * gas == pytest.approx(shape.gas_volume_mm3(), rel=1e-12)


def test_mesh_without_strip_b() -> None:
    mesh = actuator_mesh(ActuatorGeometry(void_count=2, strip_b_mm=0.0), level="draft")
    assert mesh.nodes_mm[:, 0].max() == pytest.approx(23.5)
    assert set(mesh.region) == {0, 1, 2}


def test_node_sets() -> None:
    mesh = actuator_mesh(SMALL, level="draft")
    assert np.all(mesh.nodes_mm[mesh.node_sets["clamp"], 1] == 0.0)
    assert np.all(mesh.nodes_mm[mesh.node_sets["symmetry"], 2] == 0.0)
    assert len(mesh.node_sets["clamp"]) == np.count_nonzero(mesh.nodes_mm[:, 1] == 0.0)


def test_a_clamp_of_some_length_holds_the_outer_faces() -> None:
    mesh = actuator_mesh(CLOSED_AND_CLAMPED, level="draft")
    x, y, z = mesh.nodes_mm.T
    held = np.zeros(len(x), dtype=bool)
    held[mesh.node_sets["clamp"]] = True
    outside = np.isclose(x, 0.0) | np.isclose(x, 26.5) | np.isclose(z, 7.5)
    np.testing.assert_array_equal(held, (y == 0.0) | (outside & (y <= 7.0)))
    assert np.isclose(y, 7.0).any()


def test_a_clamp_that_ends_at_a_wall_adds_no_sliver() -> None:
    at_wall = ActuatorGeometry(void_count=3, clamp_length_mm=2.4)
    elements = [actuator_mesh(shape, level="draft").elements for shape in (at_wall, SMALL)]
    assert len(elements[0]) == len(elements[1])


def test_located_point_reproduces_a_linear_field() -> None:
    mesh = actuator_mesh(SMALL, level="draft")
    gradient = np.array([[0.1, 0.2, -0.3], [0.0, 0.5, 0.1], [0.2, 0.0, 0.4]])
    position = np.array(SMALL.marker_position_mm)
    point = locate(mesh, position)
    np.testing.assert_allclose(
        point.displacement(mesh.nodes_mm @ gradient.T), gradient @ position, rtol=1e-12
    )


@pytest.mark.parametrize(
    ("change", "names"),
    [
        ({"wall_between_voids_mm": 11.0}, ("wall_between_voids_mm", "pitch_mm")),
        ({"side_wall_mm": 7.5}, ("side_wall_mm", "width_mm")),
        ({"roof_mm": 18.0}, ("roof_mm", "height_mm")),
        ({"channel_width_mm": 10.0}, ("channel_width_mm", "side_wall_mm")),
        ({"channel_height_mm": 15.0}, ("channel_height_mm", "roof_mm")),
        ({"void_floor_mm": 15.0}, ("void_floor_mm", "roof_mm")),
        ({"void_floor_mm": 14.0}, ("channel_height_mm", "void_floor_mm")),
        ({"clamp_length_mm": 160.0}, ("clamp_length_mm", "length")),
        ({"end_wall_mm": 9.5}, ("end_wall_mm", "wall_between_voids_mm")),
        ({"marker_from_tip_mm": 200.0}, ("marker_from_tip_mm", "length")),
        ({"pitch_mm": -1.0}, ("pitch_mm", "expected")),
        ({"void_count": 0}, ("void_count", "expected")),
        ({"composite_mm": float("nan")}, ("composite_mm", "expected")),
    ],
)
def test_bad_dimensions_are_named(change: dict[str, float], names: tuple[str, str]) -> None:
    with pytest.raises(InputError) as caught:
        ActuatorGeometry(**change)  # type: ignore[arg-type]
    assert all(name in str(caught.value) for name in names)


def test_unknown_level() -> None:
    with pytest.raises(InputError, match=r"'coarse'.*draft, default, fine"):
        actuator_mesh(SMALL, level="coarse")


def test_a_mesh_beyond_the_memory_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = actuator_mesh(SMALL, level="draft")
    # measured: some 17 kB an unknown, and what the libraries take
    assert 0.017e-3 * mesh.n_dofs < memory.foreseen_memory_GB(mesh) < 1.0
    memory.refuse_too_large(mesh)
    monkeypatch.setattr(memory, "_installed_memory_GB", lambda: 0.3)
    with pytest.raises(InputError, match=r"GB of memory.*0\.3 GB; take a coarser mesh level"):
        memory.refuse_too_large(mesh)
