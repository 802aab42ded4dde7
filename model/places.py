"""Names for the parts of the actuator, to say where something happens."""

from __future__ import annotations

from .elements import FloatArray
from .geometry import ActuatorGeometry


def place_name(geometry: ActuatorGeometry, position_mm: FloatArray) -> str:
    """Name the part of the actuator around a point of the undeformed body, with the point itself.

    Voids are counted from the clamp. Read on after "the": "roof over void 7 at (22.1, 70.9, 0.0) mm".

    Parameters
    ----------
    geometry : ActuatorGeometry
    position_mm : array, shape (3,)
    """
    x, y, _ = position_mm
    layer = _layer(geometry, x)
    part = _body_part(geometry, x, y) if layer == "body" else f"{layer} {_beside(geometry, y)}"
    return f"{part} at ({', '.join(f'{one:.1f}' for one in position_mm)}) mm"


def _layer(geometry: ActuatorGeometry, x_mm: float) -> str:
    if x_mm < geometry.composite_mm:
        return "composite"
    if x_mm < geometry.body_base_mm:
        return "strip A"
    return "body" if x_mm <= geometry.body_base_mm + geometry.height_mm else "strip B"


def _body_part(geometry: ActuatorGeometry, x_mm: float, y_mm: float) -> str:
    """Name a wall or roof."""
    spans = geometry.void_spans_mm()
    if y_mm < spans[0][0]:
        return "end wall at the clamp"
    if y_mm > spans[-1][1]:
        return "free end wall"
    for number, (begin, end) in enumerate(spans, start=1):
        if y_mm < begin:
            return f"wall between voids {number - 1} and {number}"
        if y_mm <= end:
            return f"{_around_void(geometry, x_mm)} void {number}"
    raise ValueError(f"y = {y_mm:g} mm is outside the actuator")


def _around_void(geometry: ActuatorGeometry, x_mm: float) -> str:
    if x_mm < geometry.void_base_mm:
        return "floor of"
    return "roof over" if x_mm > geometry.void_base_mm + geometry.void_depth_mm else "side wall of"


def _beside(geometry: ActuatorGeometry, y_mm: float) -> str:
    """Say which void is nearest, or which end."""
    spans = geometry.void_spans_mm()
    if y_mm < spans[0][0]:
        return "at the clamp"
    if y_mm > spans[-1][1]:
        return "at the free end"
    distance = [max(begin - y_mm, y_mm - end) for begin, end in spans]
    return f"by void {distance.index(min(distance)) + 1}"
