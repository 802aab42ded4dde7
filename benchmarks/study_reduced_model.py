"""The reduced model against the full one: along the ramp, under the suspects' scatter, processor time.

What a study takes from the reduced model are changes of the path, so these are compared too: for draws of the
suspects of ``spavision study starter``, the change of the tip from the nominal case by either model.

Run: python benchmarks/study_reduced_model.py [--draws 6]
"""

from __future__ import annotations

import os

os.environ.setdefault("NUMBA_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import tomllib

import numpy as np

from spavision.cli.studies.starter import STARTER
from spavision.correlate.modes import find_modes
from spavision.correlate.study.case import Case, CaseResult, displacements
from spavision.correlate.study.evaluate import evaluate
from spavision.correlate.study.parameters import Value, laid_over
from spavision.correlate.study.sampling import draw_shares, values_at
from spavision.correlate.study.study_file import StudyFile
from spavision.correlate.study.suspects import suspects_of
from spavision.experiment import Experiment
from spavision.tip_path import FloatArray

CRIMP_RATIOS = (0.2, 0.25, 0.3)
PRESSURES_KPA = tuple(float(p) for p in range(0, 70, 5))
MODELS = ("full", "reduced")
SEED = 1


def drawn_values(nominal: Experiment, count: int) -> list[dict[str, Value]]:
    """Return the values of so many draws of the starter's suspects."""
    study = StudyFile.model_validate(tomllib.loads(STARTER))
    suspects = tuple(
        one for one in suspects_of(study, nominal, source="starter") if not one.moves_the_measurement
    )
    return values_at(suspects, draw_shares(len(suspects), max(count, 1), sampling="sobol", seed=SEED)[:count])


def run(model: str, nominal: Experiment, values: dict[str, Value]) -> CaseResult:
    """Run one case."""
    return evaluate(Case(model, laid_over(nominal, values), PRESSURES_KPA, values))


def extremum_row(crimp_ratio: float, full: CaseResult, reduced: CaseResult) -> str:
    """Return a row of the table of first extrema."""
    one, other = (find_modes(result.path(PRESSURES_KPA)) for result in (full, reduced))
    off = 100.0 * (other.first_extremum_mm / one.first_extremum_mm - 1.0)
    return (
        f"| {crimp_ratio:g} | {one.first_extremum_mm:.2f} mm "
        f"| {other.first_extremum_mm:.2f} mm ({off:+.1f} %) "
        f"| {one.first_extremum_kPa:.2f} kPa | {other.first_extremum_kPa:.2f} kPa "
        f"| {full.seconds:.1f} | {reduced.seconds:.2f} |"
    )


def distance_mm(difference_mm: FloatArray) -> FloatArray:
    """Return the root mean square length over the cases, shape (n_pressures,)."""
    return np.asarray(np.sqrt(np.nanmean(np.sum(difference_mm**2, axis=-2), axis=0)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--draws", type=int, default=6, help="draws of the suspects for each crimp ratio")
    given = parser.parse_args()
    # Compiled kernels and loaded libraries are not part of a ramp.
    run("reduced", Experiment().with_options({"actuator": {"crimp_ratio": 0.2}}), {})
    extrema, rows = [], []
    for crimp_ratio in CRIMP_RATIOS:
        nominal = Experiment().with_options({"actuator": {"crimp_ratio": crimp_ratio}})
        values = [{}, *drawn_values(nominal, given.draws)]
        found = {model: [run(model, nominal, each) for each in values] for model in MODELS}
        extrema.append(extremum_row(crimp_ratio, found["full"][0], found["reduced"][0]))
        full, reduced = (displacements(found[model]) for model in MODELS)
        changes = full[1:] - full[0], reduced[1:] - reduced[0]
        columns = (
            distance_mm((reduced - full)[:1]),
            distance_mm(full[1:] - full[0]),
            distance_mm(changes[1] - changes[0]),
            np.isfinite(full[1:, 0] - reduced[1:, 0]).sum(axis=0),
        )
        for row, pressure in enumerate(PRESSURES_KPA):
            off, spread, error, count = (float(column[row]) for column in columns)
            share = f"{100 * error / spread:.0f} %" if spread > 0 else "–"
            rows.append(
                f"| {crimp_ratio:g} | {pressure:g} | {off:.2f} | {spread:.2f} | {error:.2f} | {share} "
                f"| {count:.0f} |"
            )
        reasons = [result.reason for model in MODELS for result in found[model] if result.status != "ok"]
        print(*reasons, sep="\n", flush=True)
    print("| crimp ratio | extremum, full | reduced | its pressure, full | reduced | s, full | s, reduced |")
    print("|---|---|---|---|---|---|---|")
    print(*extrema, sep="\n")
    print("\n| crimp ratio | kPa | nominal, apart mm | change by the suspects mm | its error mm | | cases |")
    print("|---|---|---|---|---|---|---|")
    print(*rows, sep="\n")


if __name__ == "__main__":
    main()
