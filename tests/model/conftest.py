"""Small bodies that several test modules load."""

from __future__ import annotations

import numpy as np
import pytest

from spavision.model.hex_mesh import HexMesh, TensorGrid, structured_mesh
from spavision.model.materials.ogden import Ogden
from spavision.model.materials.solid import SolidMaterial
from spavision.model.newton import NewtonSettings


@pytest.fixture
def body_law() -> Ogden:
    """BODY of the closed forms: shear modulus 0.140 MPa."""
    return Ogden((0.131, 0.003), (2.0, 6.0))


@pytest.fixture
def body_solid(body_law: Ogden) -> SolidMaterial:
    return SolidMaterial(law=body_law, bulk_modulus_MPa=140.0, density_tonne_per_mm3=1e-9)


@pytest.fixture
def tight() -> NewtonSettings:
    return NewtonSettings(residual_tolerance=1e-10, correction_tolerance_mm=1e-6, max_iterations=15)


def cube_mesh(*, order: int, cells: int = 2, enclosed: bool = False, distortion: float = 0.0) -> HexMesh:
    """Unit cube; with `distortion` its inner nodes are displaced, with `enclosed` its skin encloses gas."""
    lines = np.linspace(0.0, 1.0, cells + 1)

    def distorted(nodes: np.ndarray) -> np.ndarray:
        bubble = np.prod(np.sin(np.pi * nodes), axis=1)[:, None]
        return nodes + distortion * bubble * np.array([1.0, -0.6, 0.8]) * np.cos(3.0 * nodes[:, [1, 2, 0]])

    return structured_mesh(
        TensorGrid(lines, lines, lines),
        order=order,
        is_cavity_face=(lambda centres: np.ones(len(centres), dtype=bool)) if enclosed else None,
        mapping=distorted if distortion else None,
    )
