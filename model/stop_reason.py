"""The cause for which a ramp stopped, in one sentence with place and number."""

from __future__ import annotations

import numpy as np

from .constitutive import Deformation, deform
from .continuation import RampStoppedError, StopPlace
from .elements import reference_element
from .equilibrium import Equilibrium
from .geometry import ActuatorGeometry
from .law_use import unstable_use
from .materials.material_files import Material
from .places import place_name
from .self_contact import self_contact

_NEAR_KPA = 1.0
"""A limit point foreseen this near to where the ramp stopped is taken for the cause."""

_NEARLY_FOLDED = 0.5
"""Volume ratio at a point below which an element is about to turn inside out."""


def stop_reason(
    problem: Equilibrium,
    stop: RampStoppedError,
    *,
    geometry: ActuatorGeometry,
    materials: dict[str, Material],
) -> str:
    """Tell why a ramp stopped.

    In this order: a law that is unstable at the stretches met; a limit point of the gas pressure; a part that
    folds in; else what the solver says. A point that has lost half its volume, and an actuator that has
    passed through itself, are added.

    Parameters
    ----------
    problem : Equilibrium
    stop : RampStoppedError
    geometry : ActuatorGeometry
    materials : dict of str to Material
        One for each region.
    """
    if stop.place is None:
        return stop.reason
    state = deform(stop.place.state.displacement, problem.mesh.elements, problem.geometry)
    unstable = unstable_use(materials, problem.mesh, state)
    cause = str(unstable) if unstable else _cause(problem, stop, stop.place, state, geometry)
    return cause + _folded(problem, state, geometry) + _touching(problem, stop.place, geometry)


def _cause(
    problem: Equilibrium,
    stop: RampStoppedError,
    place: StopPlace,
    state: Deformation,
    geometry: ActuatorGeometry,
) -> str:
    is_near = place.limit_kPa - stop.pressure_kPa < _NEAR_KPA
    if place.balloons or is_near:
        limit_kPa = place.limit_kPa if is_near else stop.pressure_kPa
        stretch = np.exp(state.log_stretch).max(axis=2)
        where = _at(problem, int(stretch.argmax()), geometry)
        return (
            f"a limit point, a maximum of the gas pressure, is foreseen at {limit_kPa:.2f} kPa, where the "
            f"{where} is stretched {stretch.max():.1f} times; volume control passes it"
        )
    if place.node is not None:
        where = place_name(geometry, problem.mesh.nodes_mm[place.node])
        return f"the {where} gives way and no stable shape is found beyond ({stop.reason})"
    return stop.reason


def _folded(problem: Equilibrium, state: Deformation, geometry: ActuatorGeometry) -> str:
    worst = float(state.J.min())
    if worst > _NEARLY_FOLDED:
        return ""
    where = _at(problem, int(state.J.argmin()), geometry)
    return f"; an element of the {where} is nearly inside out (volume ratio {worst:.2f} at a point)"


def _touching(problem: Equilibrium, place: StopPlace, geometry: ActuatorGeometry) -> str:
    contact = self_contact(problem.mesh, place.state.displacement)
    if contact is None:
        return ""
    first, second = (place_name(geometry, one) for one in (contact.first_mm, contact.second_mm))
    return f"; the actuator has passed through itself ({first} through {second}), and contact is not modelled"


def _at(problem: Equilibrium, flat_point: int, geometry: ActuatorGeometry) -> str:
    """Name the place of a Gauss point, counted over all elements."""
    values = reference_element(problem.mesh.order).values
    element, point = divmod(flat_point, len(values))
    return place_name(geometry, values[point] @ problem.mesh.nodes_mm[problem.mesh.elements[element]])
