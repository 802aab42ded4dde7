"""The experiment file: what a laboratory knows about its set-up, checked key by key."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from spavision.checked_settings import Section, checked
from spavision.tables import read_toml

FILE_NAME = "experiment.toml"

PositiveLength = Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)]
Sigma = Annotated[float, Field(ge=0, le=1000, allow_inf_nan=False)]
Pressure = Annotated[float, Field(ge=0, le=10000, allow_inf_nan=False)]
Stiffness = Annotated[float, Field(ge=0.1, le=10, allow_inf_nan=False)]
CrimpRatio = Annotated[float, Field(ge=0.1, le=0.4, allow_inf_nan=False)]


class BoardSection(Section):
    """The checkerboard behind the actuator."""

    square_mm: float = Field(2.5, ge=0.2, le=100, description="side of one square, mm")
    scale: float = Field(
        1.0, ge=0.8, le=1.25, description="true over nominal length of 100 squares, by ruler"
    )
    sigma_scale: Sigma = Field(
        0.0005, description="standard uncertainty of scale: 0.0005 is 0.125 mm in 250 mm"
    )


class CameraSection(Section):
    """Where the camera and the marker stand with respect to the board."""

    standoff_mm: float | None = Field(
        None, ge=0, le=300, description="marker plane in front of the board, mm"
    )
    distance_mm: float | None = Field(
        None, ge=50, le=20000, description="camera to board, along the normal, mm"
    )
    file: str | None = Field(None, description="camera.toml of spavision calibrate")
    sigma_standoff_mm: Sigma = Field(0.5, description="standard uncertainty of standoff_mm, mm")
    sigma_distance_mm: Sigma = Field(5.0, description="standard uncertainty of distance_mm, mm")


class MarkerSection(Section):
    """The coloured dot near the tip, and a second one at the fixed end where there is one."""

    colour: str = Field("red", description="named colour, or #rrggbb sampled from a photo")
    diameter_mm: float | None = Field(None, gt=0.2, le=50, description="diameter of the dot, mm")
    base_colour: str | None = Field(
        None, description="colour of a second dot at the fixed end, whose motion is taken off"
    )
    base_diameter_mm: float | None = Field(
        None, gt=0.2, le=50, description="its diameter, mm; the first dot's unless given"
    )
    sigma_out_of_plane_mm: Sigma = Field(
        0.2, description="standard uncertainty of the dot's motion towards the camera, mm"
    )


class PhotosSection(Section):
    """How the pressure of each photo is known."""

    pressures: Literal["names", "table", "list", "step"] = Field(
        "names", description="pressure from file names, a CSV, a list or a step"
    )
    table: str | None = Field(
        None, description="CSV with the columns photo, pressure_kPa; for a video time_s, pressure_kPa"
    )
    list_kPa: tuple[Pressure, ...] | None = Field(
        None, min_length=1, description="pressures of the photos in order, kPa"
    )
    step_kPa: float | None = Field(
        None, gt=0, le=500, description="pressure increment between photos in order, kPa"
    )
    largest_megapixels: float = Field(
        200.0, gt=0, le=10000, description="larger photos are not decoded, megapixels"
    )

    @model_validator(mode="after")
    def _source_is_complete(self) -> PhotosSection:
        needed = {"table": self.table, "list": self.list_kPa, "step": self.step_kPa}
        if self.pressures in needed and needed[self.pressures] is None:
            key = {"table": "table", "list": "list_kPa", "step": "step_kPa"}[self.pressures]
            raise ValueError(f'pressures = "{self.pressures}" needs the key {key}')
        return self


class GaugeSection(Section):
    """How the pressure in the actuator follows from the one that was read."""

    pressure_scale: float = Field(
        1.0, ge=0.2, le=5, allow_inf_nan=False, description="true over read pressure, by calibration"
    )
    pressure_offset_kPa: float = Field(
        0.0,
        ge=-50,
        le=50,
        allow_inf_nan=False,
        description="true pressure less that, at readings above 0, kPa",
    )


class ActuatorSection(Section):
    """The actuator: defaults are the article's, or assumed where it is silent."""

    crimp_ratio: CrimpRatio | None = Field(None, description="amplitude over wavelength of the crimped paper")
    first_bend: Literal["right", "left"] = Field(
        "right", description="side of the photo the tip moves to first"
    )
    body_material: str = Field("Mold Star 15 two-term", description="silicone of the body and the 1 mm strip")
    strip_b_material: str = Field(
        "Mold Star 15 two-term", description="silicone of the strip on region B (assumed)"
    )
    void_count: int = Field(15, ge=1, le=60, description="connected voids along the length")
    pitch_mm: PositiveLength = Field(10.5, description="distance from void to void, mm (assumed)")
    width_mm: PositiveLength = Field(15.0, description="width of the body, mm")
    height_mm: PositiveLength = Field(17.5, description="height of the body, mm")
    wall_between_voids_mm: PositiveLength = Field(2.5, description="mm (assumed)")
    side_wall_mm: PositiveLength = Field(2.5, description="mm (assumed)")
    roof_mm: PositiveLength = Field(2.5, description="mm (assumed)")
    end_wall_mm: PositiveLength = Field(2.5, description="mm (assumed)")
    void_floor_mm: float = Field(
        0.0,
        ge=0,
        le=20,
        description="body between voids and strip A, mm; 0: voids open to it (assumed)",
    )
    strip_a_mm: PositiveLength = Field(1.0, description="strip between voids and composite, mm")
    composite_mm: PositiveLength = Field(5.0, description="thickness of the bilinear composite, mm")
    strip_b_mm: float = Field(
        3.0, ge=0, le=20, description="strip glued on region B, mm; 0 for none (assumed)"
    )
    channel_width_mm: PositiveLength = Field(2.0, description="channel that connects the voids, mm (assumed)")
    channel_height_mm: PositiveLength = Field(
        2.0, description="channel that connects the voids, mm (assumed)"
    )
    clamp_length_mm: float = Field(
        0.0, ge=0, le=500, description="length of the base held in the clamp, mm; 0: its end face (assumed)"
    )

    body_stiffness: Stiffness = Field(
        1.0, description="factor on all stresses of the body's and strip A's silicone"
    )
    strip_b_stiffness: Stiffness = Field(1.0, description="factor on all stresses of strip B's silicone")
    bulk_to_shear: float = Field(
        1000.0, ge=20, le=100000, description="bulk over initial shear modulus of the silicones (assumed)"
    )
    gravity_tilt_deg: float = Field(
        0.0,
        ge=-90,
        le=90,
        description="lean of the vertical from the clamped axis to region B, degrees",
    )

    def geometry(self) -> dict[str, Any]:
        """Return the lengths and counts that describe the shape, by key."""
        return self.model_dump(exclude=set(_NOT_GEOMETRY))


_NOT_GEOMETRY = (
    "crimp_ratio",
    "first_bend",
    "body_material",
    "strip_b_material",
    "body_stiffness",
    "strip_b_stiffness",
    "bulk_to_shear",
    "gravity_tilt_deg",
)


class CompositeSection(Section):
    """The crimped-paper composite of region A: soft matrix, and paper that is slack at first."""

    law: Literal["slack-fibre", "ogden", "resolved"] = Field(
        "slack-fibre",
        description="slack fibres in the matrix; ogden: one law fitted to a curve; resolved: by a coupon",
    )
    curve: str | None = Field(
        None, description="file with a tension test of the composite, which calibrates slack-fibre or ogden"
    )
    coupon_wavelength_mm: PositiveLength = Field(
        5.0, description="wavelength of the crimp in the virtual coupon, mm (assumed)"
    )
    coupon_fold_radius_mm: float = Field(
        0.25, ge=0, le=50, description="radius of the folds in the virtual coupon, mm (assumed)"
    )
    coupon_paper_modulus_MPa: float = Field(
        4500.0, gt=0, le=20000, description="modulus of the paper in the virtual coupon, MPa (assumed)"
    )
    matrix_material: str = Field("Ecoflex 00-30", description="silicone around the paper")
    matrix_stiffness: Stiffness = Field(1.0, description="factor on all stresses of that silicone")
    paper_transition_factor: float = Field(
        0.690, ge=0.1, le=1.2, description="strain at which the paper is taut over that of the straight wave"
    )
    paper_transition_half_width: float = Field(
        0.1, ge=0.005, le=0.5, description="half the range of strain over which it becomes taut (assumed)"
    )
    paper_length_modulus_MPa: float = Field(
        10.0, ge=0.01, le=500, description="stiffness along the actuator once taut, MPa (assumed)"
    )
    paper_width_modulus_MPa: float = Field(
        10.0, ge=0, le=500, description="stiffness across the width, along the folds, MPa (assumed)"
    )

    @model_validator(mode="after")
    def _resolved_needs_no_curve(self) -> CompositeSection:
        if self.law == "resolved" and self.curve is not None:
            raise ValueError(
                'law = "resolved" computes its curve: leave the key curve out, or choose another law'
            )
        return self


class ModelSection(Section):
    """Settings of the finite-element model."""

    mesh: Literal["draft", "default", "fine"] = Field("default", description="mesh level")
    control: Literal["pressure", "volume"] = Field(
        "pressure", description="what is stepped; volume passes limit points"
    )


class Experiment(Section):
    """Everything an experiment file may say; each section may be left out."""

    board: BoardSection = BoardSection()
    camera: CameraSection = CameraSection()
    marker: MarkerSection = MarkerSection()
    photos: PhotosSection = PhotosSection()
    gauge: GaugeSection = GaugeSection()
    actuator: ActuatorSection = ActuatorSection()
    composite: CompositeSection = CompositeSection()
    model: ModelSection = ModelSection()

    def with_options(self, options: dict[str, dict[str, Any]], *, source: str = "command line") -> Experiment:
        """Return the experiment with options laid over it.

        Parameters
        ----------
        options : dict
            Section name to a dict of keys; a value of None means that the option was not given.
        source : str
            Where the options come from, for messages.

        Raises
        ------
        InputError
            If an option's value is out of range.
        """
        merged = self.model_dump()
        for section, given in options.items():
            keys = {key: value for key, value in given.items() if value is not None}
            merged[section] = merged.get(section, {}) | keys
        return checked(Experiment, merged, source=source)


def read_experiment(path: Path) -> Experiment:
    """Read and check an experiment file.

    Raises
    ------
    InputError
        If the file cannot be read, is not TOML, or holds an unknown key or a value out of range.
    """
    return checked(Experiment, read_toml(path), source=str(path))
