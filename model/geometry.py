"""The actuator's dimensions and their checks."""

from __future__ import annotations

from dataclasses import dataclass, fields
from itertools import pairwise

from spavision.errors import InputError

_MAY_BE_NONE = ("strip_b_mm", "void_floor_mm", "clamp_length_mm", "marker_from_tip_mm", "marker_from_roof_mm")


@dataclass(frozen=True)
class ActuatorGeometry:
    """Dimensions of the actuator in mm; the defaults are the article's, the rest assumed.

    Published (Ellis and co-workers, bimodal actuator): length 157.5, width 15, height 17.5, 15 connected
    voids, composite 5, strip A 1, strip B 1 to 3. Assumed: the pitch (length over voids), all walls, the
    channel, and that the voids open towards region A, where strip A closes them (no floor).

    The axes: x from the composite's outer face across the height (positive towards region B, the
    direction of the first bending mode), y along the actuator from the clamp to the tip, z across the
    width from the middle plane towards the camera.

    Parameters
    ----------
    void_count : int
    pitch_mm : float
        From one void to the next, along the actuator.
    width_mm, height_mm : float
        Of the body; strips and composite come on top of the height.
    wall_between_voids_mm, side_wall_mm, roof_mm, end_wall_mm : float
        Body walls; the roof is the wall on the side of region B. The first and last void are shortened
        by what the end wall is thicker than half the wall between voids.
    void_floor_mm : float
        Body silicone between the voids and strip A; 0 for voids that open towards strip A. The channel lies
        on it.
    strip_a_mm, composite_mm, strip_b_mm : float
        Thickness of the layers; ``strip_b_mm = 0`` leaves strip B out.
    channel_width_mm, channel_height_mm : float
        Of the channel that connects the voids along the middle plane, on the side of strip A.
    clamp_length_mm : float
        Length of the base whose outer faces the clamp holds; 0 if it holds the base's end face alone. It is
        part of the actuator's length.
    marker_from_tip_mm : float
        Distance of the tracked point, on the side face, from the tip's end face.
    marker_from_roof_mm : float
        Its distance from the body's face on the side of region B (assumed: half the height).

    Raises
    ------
    InputError
        If a dimension is out of range or two of them collide; the message names them.
    """

    void_count: int = 15
    pitch_mm: float = 10.5
    width_mm: float = 15.0
    height_mm: float = 17.5
    wall_between_voids_mm: float = 2.5
    side_wall_mm: float = 2.5
    roof_mm: float = 2.5
    end_wall_mm: float = 2.5
    void_floor_mm: float = 0.0
    strip_a_mm: float = 1.0
    composite_mm: float = 5.0
    strip_b_mm: float = 3.0
    channel_width_mm: float = 2.0
    channel_height_mm: float = 2.0
    clamp_length_mm: float = 0.0
    marker_from_tip_mm: float = 5.0
    marker_from_roof_mm: float = 8.75

    def __post_init__(self) -> None:
        self._check_ranges()
        half_wall = 0.5 * self.wall_between_voids_mm
        self._keep_below("wall_between_voids_mm", self.wall_between_voids_mm, "pitch_mm", self.pitch_mm)
        self._keep_below(
            "end_wall_mm", self.end_wall_mm, "pitch_mm − wall_between_voids_mm / 2", self.pitch_mm - half_wall
        )
        self._keep_below("2 × side_wall_mm", 2.0 * self.side_wall_mm, "width_mm", self.width_mm)
        self._keep_below("roof_mm", self.roof_mm, "height_mm", self.height_mm)
        self._keep_below(
            "void_floor_mm", self.void_floor_mm, "height_mm − roof_mm", self.height_mm - self.roof_mm
        )
        self._keep_below(
            "channel_width_mm", self.channel_width_mm, "width_mm − 2 × side_wall_mm", self.void_width_mm
        )
        self._keep_below(
            "channel_height_mm",
            self.channel_height_mm,
            "height_mm − roof_mm − void_floor_mm",
            self.void_depth_mm,
        )
        self._keep_below("clamp_length_mm", self.clamp_length_mm, "the actuator's length", self.length_mm)
        self._keep_below(
            "marker_from_tip_mm", self.marker_from_tip_mm, "the actuator's length", self.length_mm
        )
        self._keep_below("marker_from_roof_mm", self.marker_from_roof_mm, "height_mm", self.height_mm)

    @property
    def length_mm(self) -> float:
        """Length from clamp to tip."""
        return self.void_count * self.pitch_mm

    @property
    def void_width_mm(self) -> float:
        """Width of a void, across the actuator."""
        return self.width_mm - 2.0 * self.side_wall_mm

    @property
    def void_depth_mm(self) -> float:
        """Depth of a void, from its floor or strip A to the roof."""
        return self.height_mm - self.roof_mm - self.void_floor_mm

    @property
    def body_base_mm(self) -> float:
        """The x coordinate at which the body begins, on strip A."""
        return self.composite_mm + self.strip_a_mm

    @property
    def void_base_mm(self) -> float:
        """The x coordinate at which voids and channel begin."""
        return self.body_base_mm + self.void_floor_mm

    @property
    def marker_position_mm(self) -> tuple[float, float, float]:
        """Undeformed position of the tracked point."""
        return (
            self.body_base_mm + self.height_mm - self.marker_from_roof_mm,
            self.length_mm - self.marker_from_tip_mm,
            0.5 * self.width_mm,
        )

    def void_spans_mm(self) -> list[tuple[float, float]]:
        """Begin and end of each void along the actuator."""
        half_wall = 0.5 * self.wall_between_voids_mm
        spans = [
            (cell * self.pitch_mm + half_wall, (cell + 1) * self.pitch_mm - half_wall)
            for cell in range(self.void_count)
        ]
        spans[0] = (self.end_wall_mm, spans[0][1])
        spans[-1] = (spans[-1][0], self.length_mm - self.end_wall_mm)
        return spans

    def gas_volume_mm3(self) -> float:
        """Volume of voids and channel, by arithmetic."""
        spans = self.void_spans_mm()
        voids = sum(end - begin for begin, end in spans) * self.void_width_mm * self.void_depth_mm
        channel_length = sum(right[0] - left[1] for left, right in pairwise(spans))
        return voids + channel_length * self.channel_width_mm * self.channel_height_mm

    def _check_ranges(self) -> None:
        for one in fields(self):
            value = getattr(self, one.name)
            low = 0.0 if one.name in _MAY_BE_NONE else 0.1
            high = 100.0 if one.name == "void_count" else 1000.0
            if one.name == "void_count":
                low = 1.0
            if not low <= value <= high:
                raise InputError(f"geometry: {one.name} is {value:g}, expected {low:g} to {high:g}")

    def _keep_below(self, name: str, value: float, other_name: str, other: float) -> None:
        if not value < other:
            raise InputError(
                f"geometry: {name} is {value:g} mm and {other_name} is {other:g} mm, "
                "expected the first to be smaller"
            )
