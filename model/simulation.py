"""What a simulation is asked and what it found."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from spavision.tip_path import TipPath

from .composite import PaperLayer
from .continuation import SteppingSettings
from .elements import FloatArray
from .geometry import ActuatorGeometry
from .hex_mesh import HexMesh
from .materials.material_files import Material
from .newton import NewtonSettings
from .observe import locate
from .volume_control import VolumeStepping

if TYPE_CHECKING:
    import pandas as pd

RAMP_NEWTON = NewtonSettings(
    residual_tolerance=5e-5, correction_tolerance_mm=5e-3, reuse_below_mm=0.05, max_iterations=12
)
"""A factorisation or two a pressure step; the tip is then within 1e-3 mm of full convergence."""


@dataclass(frozen=True)
class SimulationSettings:
    """Everything about a simulation that is not the actuator's shape, crimp ratio or pressure.

    Parameters
    ----------
    mesh_level : str
        ``draft``, ``default`` or ``fine``.
    body_material, strip_a_material, strip_b_material, matrix_material : str
        Names in the material library. Mold Star 15 is by default the two-term law, for the published
        three-term set (``Mold Star 15``) locks in biaxial stretch: with it the composite of crimp ratio 0.3
        is not straightened below 65 kPa, where the article's actuator had long turned round.
    body_stiffness, strip_b_stiffness, matrix_stiffness : float
        Factor on all stresses of the body with strip A, of strip B and of the matrix: scatter of batches.
    paper : PaperLayer
    composite : Material or None
        A homogeneous material in place of matrix and paper.
    gravity : bool
        Whether the actuator hangs under its own weight.
    gravity_tilt_deg : float
        By which the vertical leans from the actuator's axis at the clamp towards region B (+x).
    bulk_to_shear : float
        Bulk over initial shear modulus of every silicone (assumed: nearly incompressible).
    newton : NewtonSettings
    stepping : SteppingSettings
    control : str
        ``pressure``, or ``volume``: the enclosed volume is stepped, which passes limit points. The asked
        pressures are then met where the path first rises through them.
    volume_stepping : VolumeStepping
    """

    mesh_level: str = "default"
    body_material: str = "Mold Star 15 two-term"
    strip_a_material: str = "Mold Star 15 two-term"
    strip_b_material: str = "Mold Star 15 two-term"
    matrix_material: str = "Ecoflex 00-30"
    body_stiffness: float = 1.0
    strip_b_stiffness: float = 1.0
    matrix_stiffness: float = 1.0
    paper: PaperLayer = field(default_factory=PaperLayer)
    composite: Material | None = None
    gravity: bool = True
    gravity_tilt_deg: float = 0.0
    bulk_to_shear: float = 1000.0
    newton: NewtonSettings = RAMP_NEWTON
    stepping: SteppingSettings = field(default_factory=SteppingSettings)
    control: str = "pressure"
    volume_stepping: VolumeStepping = field(default_factory=VolumeStepping)


@dataclass(frozen=True)
class StepRecord:
    """One accepted step of the ramp. Volumes, work and energy are the whole actuator's.

    Parameters
    ----------
    pressure_kPa : float
    newton_iterations : int
    residual : float
        Forces out of balance over external forces.
    negative_pivots : int or None
        Negative eigenvalues of the tangent near the step's end (0: stable), where the solver tells.
    enclosed_volume_mm3 : float
    strain_energy_mJ : float
        Gained since the hanging state.
    gas_work_mJ : float
        ∫ p dV since then, by the trapezoidal rule over the steps.
    gravity_work_mJ : float
        Work of the weight since then.
    released_mJ : float
        Energy given off since then where the body snapped over folds of the path.
    """

    pressure_kPa: float
    newton_iterations: int
    residual: float
    negative_pivots: int | None
    enclosed_volume_mm3: float
    strain_energy_mJ: float
    gas_work_mJ: float
    gravity_work_mJ: float
    released_mJ: float = 0.0

    @property
    def energy_imbalance_mJ(self) -> float:
        """Work done less energy stored or given off: the trapezoidal rule's error, ∝ step squared."""
        return self.gas_work_mJ + self.gravity_work_mJ - self.strain_energy_mJ - self.released_mJ


@dataclass(frozen=True)
class Simulation:
    """What a simulation found.

    Parameters
    ----------
    geometry : ActuatorGeometry
    crimp_ratio : float
    settings : SimulationSettings
    mesh : HexMesh
        Of the half z ≥ 0.
    tip_path : TipPath
        One row for each asked pressure; status ``missing`` and the reason where it was not reached.
    displacement_mm : array, shape (n_pressures, n_nodes, 3)
        From the unstressed shape (not from the hanging one); NaN where not reached.
    enclosed_volume_mm3 : array, shape (n_pressures,)
        Of the whole actuator; NaN where not reached.
    centre_line_mm : array, shape (n_pressures, n_points, 2)
        Material mid-line in the x-y plane; NaN where not reached.
    steps : tuple of StepRecord
    stopped_at_kPa : float or None
        Last pressure reached, if the ramp had to stop.
    stop_reason : str
        Why; empty if it did not stop.
    solver_name : str
        Linear solver used.
    """

    geometry: ActuatorGeometry
    crimp_ratio: float
    settings: SimulationSettings
    mesh: HexMesh
    tip_path: TipPath
    displacement_mm: FloatArray
    enclosed_volume_mm3: FloatArray
    centre_line_mm: FloatArray
    steps: tuple[StepRecord, ...]
    stopped_at_kPa: float | None
    stop_reason: str
    solver_name: str

    def step_table(self) -> pd.DataFrame:
        """Return the steps' records as a DataFrame, one row a step, with what the energy balance misses."""
        import pandas as pd

        rows = [asdict(step) | {"energy_imbalance_mJ": step.energy_imbalance_mJ} for step in self.steps]
        return pd.DataFrame(rows)

    @property
    def marker_at_rest_mm(self) -> FloatArray:
        """Place of the tracked point at the lowest pressure reached, shape (3,).

        Raises
        ------
        ValueError
            If no pressure was reached.
        """
        reached = np.flatnonzero(self.tip_path.has_reading)
        if len(reached) == 0:
            raise ValueError("no pressure was reached, so there is no place at rest")
        marker = np.array(self.geometry.marker_position_mm)
        return marker + locate(self.mesh, marker).displacement(self.displacement_mm[int(reached[0])])
