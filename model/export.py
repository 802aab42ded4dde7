"""VTU files of a simulation, for ParaView and other viewers."""

from __future__ import annotations

from pathlib import Path
from xml.sax.saxutils import quoteattr

import meshio
import numpy as np

from .elements import IntArray, reference_element
from .fields import element_fields
from .hex_mesh import HexMesh
from .simulation import Simulation

_CELL_TYPES = {1: "hexahedron", 2: "hexahedron27"}

# The unit cube's nodes in VTK's order: corners; edges of the floor, of the roof, uprights; faces −x, +x, −y,
# +y, −z, +z; centre (VTK file formats, VTK_TRIQUADRATIC_HEXAHEDRON).
_VTK_NODES = 0.5 * np.array(
    [
        *[(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)],
        *[(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)],
        *[(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)],
        *[(0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1), (1, 1, 0), (1, 1, 2), (1, 1, 1)],
    ]
)


def write_vtu_series(simulation: Simulation, folder: Path) -> list[Path]:
    """Write one VTU file for each pressure reached and a PVD index over them.

    Points carry the displacement from the unstressed shape; cells the region (index into the regions of
    `actuator_mesh`), the largest principal stretch, the solid's pressure, the Cauchy stress (xx, yy, zz, xy,
    yz, xz, which ParaView takes for a symmetric tensor) and von Mises' measure of it.

    Parameters
    ----------
    simulation : Simulation
    folder : Path
        Made if it does not exist.

    Returns
    -------
    list of Path
        The VTU files, in order of pressure, then the index ``ramp.pvd``.
    """
    folder.mkdir(parents=True, exist_ok=True)
    cells = [(_CELL_TYPES[simulation.mesh.order], vtk_elements(simulation.mesh))]
    written: list[tuple[float, Path]] = []
    for row in np.flatnonzero(simulation.tip_path.has_reading):
        pressure_kPa = float(simulation.tip_path.pressure_kPa[row])
        fields = element_fields(simulation, int(row))
        path = folder / f"ramp_{row:03d}.vtu"
        meshio.Mesh(
            simulation.mesh.nodes_mm,
            cells,
            point_data={"displacement_mm": simulation.displacement_mm[row]},
            cell_data={
                "region": [simulation.mesh.region.astype(np.int32)],
                "largest_stretch": [fields.largest_stretch],
                "pressure_MPa": [fields.pressure_MPa],
                "cauchy_stress_MPa": [fields.cauchy_MPa],
                "von_mises_MPa": [fields.von_mises_MPa],
            },
        ).write(path, file_format="vtu")
        written.append((pressure_kPa, path))
    index = folder / "ramp.pvd"
    index.write_text(_pvd(written), encoding="utf-8")
    return [path for _, path in written] + [index]


def vtk_elements(mesh: HexMesh) -> IntArray:
    """Return the elements with their nodes in VTK's order and positive volume."""
    locations = reference_element(mesh.order).node_locations
    wanted = _VTK_NODES[: len(locations)]
    distance = np.abs(wanted[:, None, :] - locations[None, :, :]).max(axis=2)
    ordered = mesh.elements[:, distance.argmin(axis=1)]
    corner = mesh.nodes_mm[ordered]
    edges = corner[:, [1, 3, 4]] - corner[:, :1]
    if np.linalg.det(edges).min() < 0.0:
        mirrored = wanted * np.array([-1.0, 1.0, 1.0]) + np.array([1.0, 0.0, 0.0])
        distance = np.abs(mirrored[:, None, :] - locations[None, :, :]).max(axis=2)
        ordered = mesh.elements[:, distance.argmin(axis=1)]
    return ordered


def _pvd(files: list[tuple[float, Path]]) -> str:
    """ParaView's index; its «time» is the pressure in kPa."""
    rows = "\n".join(
        f'    <DataSet timestep="{pressure:g}" file={quoteattr(path.name)}/>' for pressure, path in files
    )
    return (
        '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
        f"{rows}\n  </Collection>\n</VTKFile>\n"
    )
