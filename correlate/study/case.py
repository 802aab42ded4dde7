"""One case of a study: a model run with its inputs, and what came of it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

import spavision.model
from spavision.experiment import Experiment
from spavision.model.materials.library import find_material
from spavision.results import sha256
from spavision.tip_path import FloatArray, TipPath

from .parameters import MODEL_SECTIONS, OF_THE_PHOTOS, Value

STATUSES = ("ok", "stopped", "failed")
"""``stopped``: the ramp ended before its last pressure; ``failed``: there is no result at all."""

_MATERIALS = (
    ("actuator", "body_material"),
    ("actuator", "strip_b_material"),
    ("composite", "matrix_material"),
)


def model_description(experiment: Experiment) -> dict[str, Any]:
    """Return everything of an experiment that a model run depends on but the pressures, fit for JSON.

    Raises
    ------
    InputError
        If a material is unknown.
    """
    sections = {name: getattr(experiment, name).model_dump() for name in MODEL_SECTIONS}
    for name in OF_THE_PHOTOS:
        del sections["actuator"][name]
    laws = {key: repr(find_material(sections[section][key])) for section, key in _MATERIALS}
    # The coupon's test data, where the experiment names any.
    curve = experiment.composite.curve
    return {**sections, "materials": laws, "curve": {"sha256": sha256(Path(curve)) if curve else None}}


@cache
def model_version() -> dict[str, str]:
    """Return the version of spavision and a digest of the model's source."""
    digest = hashlib.sha256()
    folder = Path(spavision.model.__path__[0])
    for path in sorted(folder.rglob("*.py")):
        digest.update(path.relative_to(folder).as_posix().encode("utf-8"))
        digest.update(path.read_bytes())
    return {"spavision": metadata.version("spavision"), "model": digest.hexdigest()[:12]}


@dataclass(frozen=True)
class Case:
    """Inputs of a model run.

    Parameters
    ----------
    model : str
        ``reduced`` or ``full``.
    experiment : Experiment
        With the case's values laid over the nominal ones.
    pressures_kPa : tuple of float
    values : dict
        What differs from case to case, by name, for the tables.
    version : dict
        Of the model that is to run it.
    """

    model: str
    experiment: Experiment
    pressures_kPa: tuple[float, ...]
    values: dict[str, Value] = field(default_factory=dict)
    version: dict[str, str] = field(default_factory=model_version)

    def inputs(self) -> dict[str, Any]:
        """Return everything that the result depends on, fit for JSON.

        Raises
        ------
        InputError
            If a material is unknown.
        """
        return {
            "model": self.model,
            "description": model_description(self.experiment),
            "pressures_kPa": list(self.pressures_kPa),
            "version": self.version,
        }

    @property
    def name(self) -> str:
        """Hash of the inputs, which names the result file."""
        text = json.dumps(self.inputs(), sort_keys=True)
        return hashlib.sha256(text.encode("utf-8")).hexdigest()[:20]


@dataclass(frozen=True)
class CaseResult:
    """What came of a case.

    Parameters
    ----------
    status : str
        One of `STATUSES`.
    reason : str
        Why it is not ``ok``; where it is, what is to be known about it, such as a model beyond its range.
    ux_mm, uy_mm : tuple of float
        Tip displacement at the case's pressures; NaN where not reached.
    seconds : float
        Processor time.
    """

    status: str
    reason: str
    ux_mm: tuple[float, ...]
    uy_mm: tuple[float, ...]
    seconds: float

    def path(self, pressures_kPa: Sequence[float]) -> TipPath:
        """Return the tip path."""
        return TipPath.modelled(
            np.asarray(pressures_kPa, dtype=float), np.array(self.ux_mm), np.array(self.uy_mm)
        )


def failed(case: Case, reason: str) -> CaseResult:
    """Return the result of a case that has none."""
    nothing = (float("nan"),) * len(case.pressures_kPa)
    return CaseResult("failed", reason, nothing, nothing, 0.0)


def displacements(results: Sequence[CaseResult]) -> FloatArray:
    """Return the tip displacements of all cases, shape (n_cases, 2, n_pressures)."""
    return np.array([[one.ux_mm, one.uy_mm] for one in results])


def version_text(version: dict[str, str]) -> str:
    """Write a version for readers."""
    return f"{version['spavision']} (model {version['model']})"
