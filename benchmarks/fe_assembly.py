"""Assembly of the tangent and the forces: spavision's kernels against scikit-fem's stock BilinearForm.

Both assemble the same thing, a tangent of 27-node hexahedra with displacements only, on the same mesh of the
actuator, from the same stresses and moduli at the same Gauss points, of which neither time includes the
evaluation. scikit-fem's ``BilinearForm`` loops over pairs of basis functions in Python: once as one writes
it, over a vector element, and once cut by hand into six scalar blocks, the lower three left to symmetry. Ours
also condenses the pressure. CPU time in one thread is what counts on a machine that is shared.

Run: python benchmarks/fe_assembly.py
"""

from __future__ import annotations

import os

os.environ.setdefault("NUMBA_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import time
from collections.abc import Callable

import numpy as np
from scipy.sparse import csr_array
from skfem import Basis, BilinearForm, ElementHex2, ElementVector, LinearForm, MeshHex

from spavision.model.element_integrals import force_integrals
from spavision.model.equilibrium import Equilibrium, Load, State
from spavision.model.hex_mesh import TensorGrid, structured_mesh
from spavision.model.materials.ogden import Ogden
from spavision.model.materials.solid import SolidMaterial

CELLS = (6, 20, 5)
SIZE_MM = (24.5, 70.0, 7.5)
REPEATS = 5
VOIGT = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])


def block() -> Equilibrium:
    """A block of 600 elements, clamped at one end."""
    lines = [np.linspace(0.0, size, cells + 1) for size, cells in zip(SIZE_MM, CELLS, strict=True)]
    mesh = structured_mesh(TensorGrid(*lines), order=2)
    solid = SolidMaterial(Ogden((0.131, 0.003), (2.0, 6.0)), 140.0, 1.15e-9)
    is_fixed = np.repeat(np.isclose(mesh.nodes_mm[:, 1:2], 0.0), 3, axis=1)
    return Equilibrium(mesh, {"solid": solid}, is_fixed=is_fixed)


def bent(body: Equilibrium) -> State:
    """A smooth deformation."""
    x, y, z = body.mesh.nodes_mm.T
    field = 0.05 * np.column_stack([y * y / 70.0, 0.3 * x + y, 0.2 * z])
    return State(field * body.is_free, body.unloaded().pressure)


def nominal_moduli(body: Equilibrium, state: State) -> tuple[np.ndarray, np.ndarray]:
    """First Piola-Kirchhoff stress and its derivative by F, components first, as scikit-fem takes them."""
    balance = body.balance(state, Load(0.0, 1.0))
    assert balance is not None
    inverse = np.linalg.inv(balance.kinematics.F)
    tau = balance.response.stress[..., VOIGT]
    spatial = balance.response.moduli[..., VOIGT[:, :, None, None], VOIGT[None, None]]
    spatial = spatial + np.einsum("ij,eqrs->eqirjs", np.eye(3), tau)
    stress = np.einsum("eqir,eqsr->isqe", tau, inverse).transpose(0, 1, 3, 2)
    moduli = np.einsum("eqar,eqirjs,eqbs->iajbeq", inverse, spatial, inverse, optimize=True)
    return np.ascontiguousarray(stress), np.ascontiguousarray(moduli)


def stock_assemblies(state: State, body: Equilibrium) -> tuple[Callable[[], object], Callable[[], object]]:
    """scikit-fem's ways, one form over a vector element and by blocks, bases tabulated beforehand."""
    lines = [np.linspace(0.0, size, cells + 1) for size, cells in zip(SIZE_MM, CELLS, strict=True)]
    basis = Basis(MeshHex.init_tensor(*lines), ElementHex2(), intorder=5)
    stress, moduli = nominal_moduli(body, state)

    whole = Basis(basis.mesh, ElementVector(ElementHex2()), intorder=5)

    def vector_form(u, v, _w):  # type: ignore[no-untyped-def]
        return np.einsum("iaeq,iajbeq,jbeq->eq", v.grad, moduli, u.grad)

    def block_form(i: int, j: int) -> BilinearForm:
        def form(u, v, _w):  # type: ignore[no-untyped-def]
            return np.einsum("aeq,abeq,beq->eq", v.grad, moduli[i, :, j], u.grad)

        return BilinearForm(form)

    def force_form(i: int) -> LinearForm:
        return LinearForm(lambda v, _w: np.einsum("aeq,aeq->eq", v.grad, stress[i]))

    def by_blocks() -> object:
        pairs = [(i, j) for i in range(3) for j in range(i, 3)]
        tangent = [block_form(i, j).assemble(basis) for i, j in pairs]
        return tangent, [force_form(i).assemble(basis) for i in range(3)]

    def as_one() -> object:
        return BilinearForm(vector_form).assemble(whole), [force_form(i).assemble(basis) for i in range(3)]

    return as_one, by_blocks


def own_assembly(state: State, body: Equilibrium) -> Callable[[], csr_array]:
    """The kernels of the package; stresses and moduli have been evaluated by `balance`."""
    load = Load(0.0, 1.0)
    balance = body.balance(state, load)
    assert balance is not None

    def assemble() -> csr_array:
        force_integrals(body.geometry, balance.kinematics, balance.response.stress)
        return body.tangent(state, load, balance)

    return assemble


def cpu_seconds(work: Callable[[], object], repeats: int) -> float:
    """Shortest CPU time of several runs, the first (compilation) left out."""
    work()
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return min(times)


def main() -> None:
    """Print the table."""
    body = block()
    state = bent(body)
    ours = cpu_seconds(own_assembly(state, body), REPEATS)
    as_one, by_blocks = (cpu_seconds(work, 1) for work in stock_assemblies(state, body))
    print(f"{len(body.mesh.elements)} elements of 27 nodes, {body.mesh.n_dofs} unknowns, one thread")
    print(f"{'':44s} CPU s   ratio")
    print(f"{'spavision':44s} {ours:6.3f}")
    print(
        f"{'scikit-fem, BilinearForm, vector element':44s} {as_one:6.3f}  {as_one / ours:6.1f}  (target 40)"
    )
    print(f"{'scikit-fem, six scalar BilinearForms':44s} {by_blocks:6.3f}  {by_blocks / ours:6.1f}")


if __name__ == "__main__":
    main()
