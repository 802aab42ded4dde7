"""Memory that a ramp will need, told before it begins."""

from __future__ import annotations

import os

from spavision.errors import InputError

from .hex_mesh import HexMesh

_BASE_GB = 0.4
_GB_PER_UNKNOWN = 18e-6
"""Measured with Pardiso: 4.3 GB for 246 915 unknowns, 5.2 GB for 346 725; less for coarser meshes."""


def foreseen_memory_GB(mesh: HexMesh) -> float:
    """Return about how much memory a ramp on a mesh takes, most of it for the factorised tangent."""
    return _BASE_GB + _GB_PER_UNKNOWN * mesh.n_dofs


def refuse_too_large(mesh: HexMesh) -> None:
    """Refuse a mesh that the computer has not the memory for, where the system tells how much it has.

    Raises
    ------
    InputError
        If less is installed than foreseen.
    """
    installed_GB = _installed_memory_GB()
    foreseen_GB = foreseen_memory_GB(mesh)
    if foreseen_GB > installed_GB:
        raise InputError(
            f"the mesh has {mesh.n_dofs} unknowns, which take about {foreseen_GB:.1f} GB of memory, and the "
            f"computer has {installed_GB:.1f} GB; take a coarser mesh level or fewer voids"
        )


def _installed_memory_GB() -> float:
    """Return the physical memory; without bound where the system does not tell, as on Windows."""
    names = getattr(os, "sysconf_names", {})
    if "SC_PHYS_PAGES" not in names or "SC_PAGE_SIZE" not in names:
        return float("inf")
    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 1e9
