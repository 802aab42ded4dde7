"""From an experiment file to what the model takes."""

from __future__ import annotations

from dataclasses import dataclass

from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.model.composite import PaperLayer
from spavision.model.geometry import ActuatorGeometry
from spavision.model.simulation import SimulationSettings

from .composite_inputs import with_composite


@dataclass(frozen=True)
class ModelInputs:
    """Everything that a simulation needs but the pressures.

    Parameters
    ----------
    geometry : ActuatorGeometry
    crimp_ratio : float
    settings : SimulationSettings
    notes : tuple of str
        What to know about the composite, where it was calibrated.
    """

    geometry: ActuatorGeometry
    crimp_ratio: float
    settings: SimulationSettings
    notes: tuple[str, ...] = ()


def model_inputs(experiment: Experiment) -> ModelInputs:
    """Return the model that an experiment describes.

    Raises
    ------
    InputError
        If the crimp ratio is not known or dimensions collide.
    """
    actuator, composite = experiment.actuator, experiment.composite
    if actuator.crimp_ratio is None:
        raise InputError("the crimp ratio is not known; give --crimp 0.2, or crimp_ratio under [actuator]")
    settings = SimulationSettings(
        mesh_level=experiment.model.mesh,
        control=experiment.model.control,
        body_material=actuator.body_material,
        strip_a_material=actuator.body_material,
        strip_b_material=actuator.strip_b_material,
        matrix_material=composite.matrix_material,
        body_stiffness=actuator.body_stiffness,
        strip_b_stiffness=actuator.strip_b_stiffness,
        matrix_stiffness=composite.matrix_stiffness,
        paper=PaperLayer(
            transition_factor=composite.paper_transition_factor,
            transition_half_width=composite.paper_transition_half_width,
            length_modulus_MPa=composite.paper_length_modulus_MPa,
            width_modulus_MPa=composite.paper_width_modulus_MPa,
        ),
        bulk_to_shear=actuator.bulk_to_shear,
        gravity_tilt_deg=actuator.gravity_tilt_deg,
    )
    settings, notes = with_composite(settings, composite, crimp_ratio=actuator.crimp_ratio)
    return ModelInputs(ActuatorGeometry(**actuator.geometry()), actuator.crimp_ratio, settings, notes)
