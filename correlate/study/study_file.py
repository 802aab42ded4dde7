"""The study file: what is varied and how, what was measured, what is wished."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, field_validator, model_validator

from spavision.checked_settings import Section, checked
from spavision.tables import read_toml

Number = Annotated[float, Field(allow_inf_nan=False)]
Value = Number | str
Pressure = Annotated[float, Field(ge=0, le=500, allow_inf_nan=False)]
CrimpRatio = Annotated[float, Field(ge=0.1, le=0.4, allow_inf_nan=False)]


class StudySection(Section):
    """What is run, and how often."""

    experiment: str | None = Field(None, description="experiment file with the nominal values")
    crimp_ratio: CrimpRatio | None = Field(None, description="crimp ratio, before the experiment file's")
    model: Literal["reduced", "full"] = Field("reduced", description="model of the cases")
    pressures_kPa: tuple[Pressure, ...] = Field(
        tuple(float(p) for p in range(0, 70, 5)), min_length=2, description="pressures of the ramp, kPa"
    )
    cases: int = Field(128, ge=4, le=1_000_000, description="number of random cases")
    sampling: Literal["sobol", "random"] = Field(
        "sobol", description="quasi-random Sobol sequence, or plain Monte Carlo"
    )
    seed: int = Field(1, ge=0, description="seed of the random numbers")

    @field_validator("pressures_kPa")
    @classmethod
    def _increase(cls, pressures: tuple[float, ...]) -> tuple[float, ...]:
        for one, following in pairwise(pressures):
            if following <= one:
                raise ValueError(f"{one:g} is followed by {following:g}, expected increasing ones")
        return pressures


class SuspectSection(Section):
    """One uncertain parameter: a key of the experiment file and its distribution."""

    distribution: Literal["uniform", "normal", "triangular", "choice"]
    plus_minus: float | None = Field(
        None, gt=0, allow_inf_nan=False, description="half the range about the nominal value"
    )
    low: Number | None = None
    high: Number | None = None
    mode: Number | None = Field(None, description="most likely value; the nominal one unless given")
    mean: Number | None = Field(None, description="mean; the nominal value unless given")
    sigma: float | None = Field(None, gt=0, allow_inf_nan=False, description="standard deviation")
    options: tuple[Value, ...] | None = Field(
        None, min_length=2, description="values to choose among; for a material, the library's alternatives"
    )

    @model_validator(mode="after")
    def _is_complete(self) -> SuspectSection:
        spans = self.plus_minus is not None or (self.low is not None and self.high is not None)
        if self.distribution in ("uniform", "triangular") and not spans:
            raise ValueError(f'distribution = "{self.distribution}" needs plus_minus, or low and high')
        if self.distribution == "normal" and self.sigma is None:
            raise ValueError('distribution = "normal" needs sigma')
        if self.low is not None and self.high is not None and not self.low < self.high:
            raise ValueError(f"low is {self.low:g} and high is {self.high:g}, expected low below high")
        return self


class MeasuredSection(Section):
    """A measured tip path."""

    path: str = Field(description="CSV with pressure_kPa, ux_mm, uy_mm, such as a track.csv")
    crimp_ratio: CrimpRatio | None = Field(None, description="the study's unless given")
    first_bend: Literal["right", "left"] | None = Field(
        None, description="side the tip moves to first, the experiment file's unless given"
    )
    pressure_unit: Literal["kPa", "Pa", "bar", "mbar", "psi", "MPa"] = Field(
        "kPa", description="unit of the file's pressures"
    )


class UpdateSection(Section):
    """Which parameters are fitted to the first measured path; the others check."""

    parameters: tuple[str, ...] = Field(min_length=1, description="names of suspects")
    steps: int = Field(5000, ge=100, le=1_000_000, description="steps of each walker of the posterior")


class DesignSection(Section):
    """What a new actuator is to do."""

    mode_change_kPa: Annotated[float, Field(gt=0, le=500)] | None = Field(
        None, description="wished pressure of the mode change, kPa"
    )
    tip_path: str | None = Field(None, description="CSV with the wished path: pressure_kPa, ux_mm, uy_mm")
    crimp_ratios: tuple[CrimpRatio, ...] = Field(
        (0.15, 0.2, 0.25, 0.3, 0.35), min_length=2, description="crimp ratios that are computed"
    )
    strips_mm: tuple[Annotated[float, Field(ge=0, le=20)], ...] = Field(
        (0.0, 1.0, 2.0, 3.0), min_length=1, description="strips on region B to choose from, mm"
    )

    strip_materials: tuple[str, ...] = Field(
        ("Mold Star 15 two-term", "Smooth-Sil 950"), min_length=1, description="silicones of these strips"
    )

    @model_validator(mode="after")
    def _one_wish(self) -> DesignSection:
        if (self.mode_change_kPa is None) == (self.tip_path is None):
            raise ValueError("expected either mode_change_kPa or tip_path")
        return self


class StudyFile(Section):
    """Everything a study file may say."""

    study: StudySection = StudySection()
    suspects: dict[str, SuspectSection] = Field(default_factory=dict)
    grid: dict[str, tuple[Value, ...]] = Field(
        default_factory=dict, description="values of a sweep, by key of the experiment file"
    )
    measured: tuple[MeasuredSection, ...] = ()
    update: UpdateSection | None = None
    design: DesignSection | None = None


def read_study(path: Path) -> StudyFile:
    """Read and check a study file. The paths in it are taken relative to it.

    Raises
    ------
    InputError
        If the file cannot be read, is not TOML, or holds an unknown key or a value out of range.
    """
    return checked(StudyFile, read_toml(path), source=str(path))
