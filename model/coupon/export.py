"""VTU files of a virtual tensile test, for ParaView and other viewers."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np

from .coupon import Coupon

_VTK_QUADRILATERAL = [0, 6, 8, 2, 3, 7, 5, 1, 4]
"""Corners, edges, centre (VTK_BIQUADRATIC_QUAD) in a numbering column by column."""

_VTK_LINE = [0, 2, 1]


def write_vtu_series(coupon: Coupon, folder: Path) -> list[Path]:
    """Write one VTU file for each point of the curve: half a wave of matrix, and the paper as a line.

    Points carry the displacement in mm and, on the paper, the rotation in rad.

    Parameters
    ----------
    coupon : Coupon
    folder : Path
        Made if it does not exist.
    """
    folder.mkdir(parents=True, exist_ok=True)
    mesh, beam = coupon.cell.mesh, coupon.cell.beam
    nodes = np.column_stack([mesh.nodes_mm[:-1], np.zeros(len(mesh.nodes_mm) - 1)])
    cells = [
        ("quad9", mesh.elements[:, :9][:, _VTK_QUADRILATERAL]),
        ("line3", mesh.paper_nodes[beam.nodes][:, _VTK_LINE]),
    ]
    written = []
    for number, state in enumerate(coupon.states):
        displacement, rotation = coupon.cell.fields(state)
        turned = np.zeros(len(nodes))
        turned[mesh.paper_nodes] = rotation
        path = folder / f"coupon_{number:03d}.vtu"
        meshio.Mesh(
            nodes, cells, point_data={"displacement_mm": displacement[:-1], "rotation_rad": turned}
        ).write(path, file_format="vtu")
        written.append(path)
    return written
