"""Which crimp ratio and strip make an actuator do what is wished."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import PchipInterpolator

from spavision.correlate.modes import find_modes
from spavision.errors import InputError
from spavision.model.materials.library import find_material
from spavision.tip_path import FloatArray, TipPath

from .case import CaseResult, displacements
from .explanation import measured_target
from .parameters import Value, bounds
from .plan import Plan, RunCases, refuse_no_common_pressure
from .sampling import draw_shares, values_at

if TYPE_CHECKING:
    import pandas as pd

_FINE_STEPS = 401
_ROUNDS = 2

Score = Callable[[TipPath], float]
"""How far a path is from the wish; NaN where it cannot be said."""


@dataclass(frozen=True)
class Strip:
    """A strip on region B.

    Parameters
    ----------
    thickness_mm : float
        0 for none.
    material : str
        In the material library; empty for none.
    """

    thickness_mm: float
    material: str

    @property
    def values(self) -> dict[str, Value]:
        """The parameters that it sets."""
        made_of: dict[str, Value] = {"strip_b_material": self.material} if self.material else {}
        return {"strip_b_mm": self.thickness_mm, **made_of}

    @property
    def label(self) -> str:
        """The strip in words."""
        return f"{self.thickness_mm:g} mm strip of {self.material}" if self.material else "no strip"


@dataclass(frozen=True)
class Choices:
    """What there is to choose from.

    Parameters
    ----------
    crimp_ratios : tuple of float
        At which the model is run first; the answer lies between them.
    strips : tuple of Strip
    """

    crimp_ratios: tuple[float, ...]
    strips: tuple[Strip, ...]


@dataclass(frozen=True)
class Candidate:
    """The best crimp ratio for one strip.

    Parameters
    ----------
    crimp_ratio : float
    strip : Strip
    path : TipPath
        Of the model there.
    score : float
        Distance from the wish.
    """

    crimp_ratio: float
    strip: Strip
    path: TipPath
    score: float

    @property
    def label(self) -> str:
        """The candidate in words."""
        return f"crimp ratio {self.crimp_ratio:.3f}, {self.strip.label}"


@dataclass(frozen=True)
class Design:
    """What a design found.

    Parameters
    ----------
    candidates : tuple of Candidate
        The best first.
    unit : str
        Of the scores.
    scatter : tuple of CaseResult
        Of the best one under the suspects' scatter; empty where there are none.
    """

    candidates: tuple[Candidate, ...]
    unit: str
    scatter: tuple[CaseResult, ...]

    def table(self) -> pd.DataFrame:
        """Return one row a candidate."""
        import pandas as pd

        rows = []
        for one in self.candidates:
            modes = find_modes(one.path)
            rows.append(
                {
                    "strip_b_mm": one.strip.thickness_mm,
                    "strip_b_material": one.strip.material,
                    "crimp_ratio": one.crimp_ratio,
                    f"off_by_{self.unit}": one.score,
                    "mode_change_kPa": modes.first_extremum_kPa if modes.reverses else float("nan"),
                    "first_extremum_mm": modes.first_extremum_mm,
                }
            )
        return pd.DataFrame(rows)

    def mode_changes_kPa(self) -> FloatArray:
        """Pressures of the mode change over the scatter; NaN where a case does not turn round."""
        pressures = self.candidates[0].path.pressure_kPa
        return np.array([_mode_change(one.path(pressures.tolist())) for one in self.scatter])


def strips_of(thicknesses_mm: Sequence[float], materials: Sequence[str]) -> tuple[Strip, ...]:
    """Return every strip once: each thickness of each material, and none where a thickness is 0.

    Raises
    ------
    InputError
        If a material is unknown.
    """
    for material in materials:
        find_material(material)
    found = [
        Strip(thickness, material if thickness > 0.0 else "")
        for thickness in thicknesses_mm
        for material in materials
    ]
    return tuple(dict.fromkeys(found))


def mode_change_score(wished_kPa: float) -> Score:
    """Return how far a path's mode change is from the wished pressure, in kPa."""
    return lambda path: abs(_mode_change(path) - wished_kPa)


def path_score(wished: TipPath, plan: Plan) -> Score:
    """Return the root mean square distance of a path from the wished one, in mm.

    Raises
    ------
    InputError
        If the two share no pressure.
    """
    refuse_no_common_pressure(plan, wished, what="wished")

    def score(path: TipPath) -> float:
        target = measured_target(wished, path, plan.experiment)
        return float(target.rmse_mm(np.zeros((1, *target.nominal_mm.shape)), np.ones(1))[0])

    return score


def design(plan: Plan, choices: Choices, score: Score, run: RunCases, *, unit: str) -> Design:
    """Find the crimp ratio for each strip, and how much the best one scatters.

    Between the crimp ratios that are computed, the path is interpolated; the model is then run at the best
    place, which joins the computed ones for another round.

    Parameters
    ----------
    plan : Plan
        Its suspects scatter about the best candidate.
    choices : Choices
    score : callable
    run : callable
    unit : str

    Raises
    ------
    InputError
        If no case comes to a result that can be scored.
    """
    pressures = plan.pressures_kPa
    known = {strip: list(choices.crimp_ratios) for strip in choices.strips}
    for _ in range(_ROUNDS):
        for strip, ratios in known.items():
            results = run([_values(ratio, strip) for ratio in ratios])
            best = _interpolated_best(ratios, results, pressures, score)
            if best is not None:
                known[strip] = sorted({*ratios, best})
    candidates = []
    for strip, ratios in known.items():
        results = run([_values(ratio, strip) for ratio in ratios])
        paths = [result.path(pressures) for result in results]
        scores = [score(path) if path.has_reading.any() else float("nan") for path in paths]
        if np.isfinite(scores).any():
            at = int(np.nanargmin(scores))
            candidates.append(Candidate(ratios[at], strip, paths[at], scores[at]))
    if not candidates:
        raise InputError("no case comes near the wish: none turns round in these pressures; widen [design]")
    ordered = sorted(candidates, key=lambda one: one.score)
    return Design(tuple(ordered), unit, tuple(_scatter(plan, ordered[0], run)))


def _values(crimp_ratio: float, strip: Strip) -> dict[str, Value]:
    return {"crimp_ratio": crimp_ratio, **strip.values}


def _interpolated_best(
    ratios: Sequence[float], results: Sequence[CaseResult], pressures: Sequence[float], score: Score
) -> float | None:
    """Return the crimp ratio whose interpolated path scores best; None where too few cases are whole."""
    values = displacements(results)
    whole = np.isfinite(values).all(axis=(1, 2))
    if np.count_nonzero(whole) < 2:
        return None
    computed = np.array(ratios)[whole]
    fine = np.linspace(computed.min(), computed.max(), _FINE_STEPS)
    scores = [
        score(TipPath.modelled(np.array(pressures), ux, uy))
        for ux, uy in PchipInterpolator(computed, values[whole])(fine)
    ]
    return float(round(fine[int(np.nanargmin(scores))], 4)) if np.isfinite(scores).any() else None


def _scatter(plan: Plan, best: Candidate, run: RunCases) -> list[CaseResult]:
    """Run the best candidate with the suspects drawn at random, strip and crimp ratio about its own."""
    chosen = _values(best.crimp_ratio, best.strip)
    # What the strip is made of, and that there is none, is chosen and does not scatter.
    fixed = {"strip_b_material", *(() if best.strip.material else ("strip_b_mm",))}
    suspects = tuple(one for one in plan.inputs if one.name not in fixed)
    if not suspects:
        return []
    points = draw_shares(len(suspects), plan.n_cases, sampling=plan.sampling, seed=plan.seed)
    nominal = {one.name: one.nominal for one in suspects if one.name in chosen}
    cases = []
    for drawn in values_at(suspects, points):
        moved = {
            name: float(np.clip(float(chosen[name]) + float(drawn[name]) - float(at), *bounds(name)))
            for name, at in nominal.items()
        }
        cases.append({**chosen, **drawn, **moved})
    return run(cases)


def _mode_change(path: TipPath) -> float:
    if not path.has_reading.any():
        return float("nan")
    modes = find_modes(path)
    return modes.first_extremum_kPa if modes.reverses else float("nan")
