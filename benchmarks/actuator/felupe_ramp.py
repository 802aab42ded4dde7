"""The actuator's ramp in FElupe: its 27-node three-field solid, its Job with cutback, MKL Pardiso.

Mesh, materials, clamp, symmetry and nodal weights are spavision's own, so that both solve the same problem.
FElupe's material interface is fed with the compiled kernels of spavision, much faster than the automatic
differentiation that FElupe offers for principal-stretch laws.
"""

from __future__ import annotations

import felupe
import numpy as np
import pypardiso

from spavision.model.actuator_problem import actuator_problem
from spavision.model.constitutive import Deformation, evaluate_materials
from spavision.model.equilibrium import Equilibrium
from spavision.model.export import vtk_elements
from spavision.model.geometry import ActuatorGeometry
from spavision.model.observe import locate
from spavision.model.simulation import SimulationSettings

TOLERANCE = 5e-5
"""Relative residual, as spavision's own."""

_VOIGT = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])


class Materials:
    """Isochoric part of every material, fibres included, as FElupe's material interface wants it."""

    def __init__(self, problem: Equilibrium) -> None:
        self.x = [np.eye(3), np.zeros(0)]
        self._groups = problem.groups

    def gradient(self, x: list[np.ndarray]) -> list[np.ndarray | None]:
        """First Piola-Kirchhoff stress, shape (3, 3, n_points, n_elements)."""
        state = _deformation(x[0])
        stress = evaluate_materials(self._groups, state).stress[..., _VOIGT]
        nominal = np.einsum("eqir,eqsr->isqe", stress, np.linalg.inv(state.F), optimize=True)
        return [nominal, None]

    def hessian(self, x: list[np.ndarray]) -> list[np.ndarray]:
        """Its derivative by F, shape (3, 3, 3, 3, n_points, n_elements)."""
        state = _deformation(x[0])
        response = evaluate_materials(self._groups, state)
        spatial = response.moduli[..., _VOIGT[:, :, None, None], _VOIGT[None, None]]
        spatial = spatial + np.einsum("ij,eqrs->eqirjs", np.eye(3), response.stress[..., _VOIGT])
        inverse = np.linalg.inv(state.F)
        return [np.einsum("eqar,eqirjs,eqbs->iajbqe", inverse, spatial, inverse, optimize=True)]


def felupe_ramp(
    geometry: ActuatorGeometry,
    *,
    crimp_ratio: float,
    settings: SimulationSettings,
    pressures_kPa: np.ndarray,
    step_kPa: float,
    parallel: bool,
) -> np.ndarray:
    """Return the tip displacement from the hanging state, shape (n_pressures reached, 2)."""
    problem = actuator_problem(geometry, crimp_ratio=crimp_ratio, settings=settings)
    mesh = felupe.Mesh(problem.mesh.nodes_mm, vtk_elements(problem.mesh), "hexahedron27")
    # Its cells keep the order of ours, but not that of the Gauss points: the materials need only the cells.
    field = felupe.FieldsMixed(felupe.RegionTriQuadraticHexahedron(mesh), n=3)
    bulk = problem.bulk_modulus_MPa[None, :]
    law = felupe.NearlyIncompressible(Materials(problem), bulk=bulk)
    law.chunksize = None  # all cells at once: which material a cell has goes by its number
    solid = felupe.SolidBody(law, field)
    weight = felupe.PointLoad(field, np.arange(mesh.npoints), 0.0 * problem.mesh.nodes_mm)
    gas = felupe.SolidBodyPressure(_cavity_field(mesh, problem), pressure=0.0)
    boundaries = {
        "clamp": felupe.Boundary(field[0], mask=np.isclose(mesh.points[:, 1], 0.0)),
        "symmetry": felupe.Boundary(field[0], mask=np.isclose(mesh.points[:, 2], 0.0), skip=(1, 1, 0)),
    }
    items = [solid, weight, gas]
    hanging = felupe.Step(items, ramp={weight: [problem._weight]}, boundaries=boundaries)
    ramp_MPa = 1e-3 * np.arange(step_kPa, pressures_kPa[-1] + 1e-9, step_kPa)
    inflated = felupe.Step(items, ramp={gas: ramp_MPa}, boundaries=boundaries)
    marker = locate(problem.mesh, np.array(geometry.marker_position_mm))
    tips: list[np.ndarray] = []

    def note(context: felupe.Context, _state: object) -> None:
        tips.append(marker.displacement(context.substep.x[0].values)[:2])

    job = felupe.Job([hanging, inflated], plugins=[felupe.CutbackPlugin(), note])
    try:
        job.evaluate(
            x0=field, verbose=False, parallel=parallel, solver=pypardiso.spsolve, tol=TOLERANCE, maxiter=12
        )
    except (felupe.NewtonConvergenceError, ArithmeticError) as error:
        print(f"FElupe stopped after {step_kPa * (len(tips) - 1):g} kPa: {error}")
    relative = np.array(tips[1:]) - tips[0]
    every = round((pressures_kPa[1] - pressures_kPa[0]) / step_kPa)
    return relative[every - 1 :: every]


def _cavity_field(mesh: felupe.Mesh, problem: Equilibrium) -> felupe.FieldContainer:
    is_wet = np.isin(np.arange(mesh.npoints), problem.mesh.cavity_faces)
    region = felupe.RegionTriQuadraticHexahedronBoundary(mesh, only_surface=True, mask=is_wet)
    return felupe.FieldContainer([felupe.Field(region, dim=3)])


def _deformation(F: np.ndarray) -> Deformation:
    """Kinematics at the Gauss points from FElupe's deformation gradients."""
    F = np.ascontiguousarray(F.transpose(3, 2, 0, 1))
    squares, directions = np.linalg.eigh(F @ F.swapaxes(-1, -2))
    return Deformation(F, np.linalg.det(F), 0.5 * np.log(squares), directions)
