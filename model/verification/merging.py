"""Meshes joined where their nodes coincide."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from spavision.model.elements import reference_face
from spavision.model.hex_mesh import HexMesh

_ROUNDING_MM = 1e-7


def merged(meshes: list[HexMesh]) -> HexMesh:
    """Join meshes of one order at their coincident nodes; node sets are dropped.

    Parameters
    ----------
    meshes : list of HexMesh
        With the same region names.
    """
    starts = np.cumsum([0, *(len(mesh.nodes_mm) for mesh in meshes)])
    nodes = np.concatenate([mesh.nodes_mm for mesh in meshes])
    _, kept, number = np.unique(
        np.round(nodes / _ROUNDING_MM).astype(np.int64), axis=0, return_index=True, return_inverse=True
    )
    return HexMesh(
        order=meshes[0].order,
        nodes_mm=np.ascontiguousarray(nodes[kept]),
        elements=number[
            np.concatenate([mesh.elements + start for mesh, start in zip(meshes, starts[:-1], strict=True)])
        ],
        region=np.concatenate([mesh.region for mesh in meshes]),
        region_names=meshes[0].region_names,
        cavity_faces=number[
            np.concatenate(
                [mesh.cavity_faces + start for mesh, start in zip(meshes, starts[:-1], strict=True)]
            )
        ],
    )


def mirrored(mesh: HexMesh, axis: int) -> HexMesh:
    """Return the mirror image across the plane where a coordinate is 0, cavity normals kept outward."""
    nodes = mesh.nodes_mm.copy()
    nodes[:, axis] *= -1.0
    faces = mesh.cavity_faces[:, reference_face(mesh.order).flipped]
    return replace(mesh, nodes_mm=nodes, cavity_faces=faces, node_sets={})
