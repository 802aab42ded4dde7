"""``spavision study design``: crimp ratio and strip for a wished behaviour."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from spavision.errors import InputError
from spavision.table_text import csv_text, number, records

from .runner import Runner
from .setup import Setup, prepare, study_options

if TYPE_CHECKING:
    from spavision.correlate.study.band import Band
    from spavision.correlate.study.design import Design, Score
    from spavision.correlate.study.plan import Plan
    from spavision.correlate.study.study_file import DesignSection


@click.command()
@click.argument("file", required=False, type=click.Path(path_type=Path))
@click.option("--mode-change-kpa", type=float, help="Wished pressure of the mode change.")
@click.option("--tip-path", type=click.Path(path_type=Path), help="CSV with the wished tip path.")
@study_options
def design(file: Path | None, mode_change_kpa: float | None, tip_path: Path | None, **given: Any) -> None:
    """Choose crimp ratio and strip for a wished mode-change pressure or tip path.

    For each strip under FILE's [design], of either silicone or none, the best crimp ratio, found between
    computed ones and confirmed by a run there; for the best of them the band that FILE's suspects leave.
    Writes design.csv, tolerance.csv, figures.
    """
    from spavision.correlate.study.design import Choices, strips_of
    from spavision.correlate.study.design import design as run_design

    setup = prepare("design", file, given)
    wish = _wish(setup, mode_change_kpa, tip_path)
    plan = setup.plan(setup.suspects() if setup.study.suspects else (), n_full=0)
    score, unit = _score(setup, wish, plan)
    runner = Runner(setup)
    choices = Choices(wish.crimp_ratios, strips_of(wish.strips_mm, wish.strip_materials))
    found = run_design(plan, choices, score, runner, unit=unit)
    runner.write_cases()
    sentences = _sentences(found)
    _write(setup, found, sentences)
    content = {"candidates": records(found.table()), "findings": sentences}
    setup.report(content, lambda: _print(found, sentences))


def _print(found: Design, sentences: list[str]) -> None:
    from spavision.cli import output

    frame = found.table()
    rows = [
        [value if isinstance(value, str) else number(value, 4) for value in row]
        for row in frame.itertuples(index=False)
    ]
    output.print_table("Best crimp ratio of each strip", list(frame.columns), rows)
    output.print_lines(sentences)


def _wish(setup: Setup, mode_change_kpa: float | None, tip_path: Path | None) -> DesignSection:
    from spavision.checked_settings import checked
    from spavision.correlate.study.study_file import DesignSection

    if mode_change_kpa is None and tip_path is None:
        if setup.study.design is None:
            raise InputError("design: nothing is wished; give --mode-change-kpa 45 or --tip-path CSV")
        return setup.study.design
    content = {} if setup.study.design is None else setup.study.design.model_dump()
    path = None if tip_path is None else str(tip_path.absolute())
    wish = {"mode_change_kPa": mode_change_kpa, "tip_path": path}
    return checked(DesignSection, {**content, **wish}, source="command line")


def _score(setup: Setup, wish: DesignSection, plan: Plan) -> tuple[Score, str]:
    from spavision.correlate.study.design import mode_change_score, path_score
    from spavision.tables import read_tip_path

    if wish.mode_change_kPa is not None:
        return mode_change_score(wish.mode_change_kPa), "kPa"
    file = setup.beside(wish.tip_path or "")
    setup.results.record_inputs([file])
    return path_score(read_tip_path(file), plan), "mm"


def _sentences(found: Design) -> list[str]:
    import numpy as np

    best = found.candidates[0]
    sentences = [f"Best: {best.label}, off by {best.score:.2g} {found.unit}."]
    changes = found.mode_changes_kPa()
    turning = changes[np.isfinite(changes)]
    if len(turning):
        low, high = np.quantile(turning, [0.025, 0.975])
        sentences.append(
            f"Under the suspects' scatter its mode changes at {low:.1f} to {high:.1f} kPa (95 % of the "
            f"{len(turning)} of {len(changes)} cases that turn round)."
        )
    return sentences


def _write(setup: Setup, found: Design, sentences: list[str]) -> None:
    from spavision.correlate.study.band import band
    from spavision.correlate.study.figures import band_figure, sweep_figure

    results = setup.results
    results.write_text("design.csv", csv_text(found.table()))
    paths = [one.path for one in found.candidates]
    labels = [one.label for one in found.candidates]
    figures = {"design": sweep_figure(paths, labels, title="Best of each strip")}
    if found.scatter:
        around: Band = band(found.candidates[0].path, found.scatter)
        results.write_text("tolerance.csv", csv_text(around.table()))
        figures["tolerance"] = band_figure(around, title=labels[0])
    setup.write_figures(figures)
    results.write_record({**setup.record(), "findings": sentences})
