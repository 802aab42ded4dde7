"""What every study command needs: the options, the file, the nominal values, the folder of cases."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from spavision.cli import output
from spavision.cli.options import results_options
from spavision.errors import InputError
from spavision.experiment import Experiment, read_experiment
from spavision.results import ResultsFolder
from spavision.table_text import csv_text
from spavision.workflow.progress import progress_bar

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from spavision.correlate.study.case import Case, CaseResult
    from spavision.correlate.study.case_files import CaseFolder
    from spavision.correlate.study.execution import Machine
    from spavision.correlate.study.parameters import Value
    from spavision.correlate.study.plan import Plan
    from spavision.correlate.study.study_file import StudyFile
    from spavision.correlate.study.suspects import Suspect

Command = TypeVar("Command", bound=Callable[..., Any])

_REASONS_SHOWN = 5


def study_options(command: Command) -> Command:
    """Add the options that every study has."""
    for option in (
        click.option("--retry-failed", is_flag=True, help="Run the cases again that failed before."),
        click.option(
            "--scheduler", default="", help="Dask scheduler that runs the cases, such as tcp://host:8786."
        ),
        click.option(
            "--workers",
            type=click.IntRange(1, 1024),
            default=1,
            show_default=True,
            help="Processes that run the cases.",
        ),
        click.option("--cases", type=int, help="Number of random cases, before the study file's."),
        click.option(
            "--model", type=click.Choice(["reduced", "full"]), help="Model, before the study file's."
        ),
        click.option("--crimp", type=float, help="Crimp ratio, before the study file's."),
    ):
        command = option(command)
    return results_options(command)


@dataclass(frozen=True)
class Setup:
    """A study about to run.

    Parameters
    ----------
    command : str
    file : Path or None
        The study file.
    study : StudyFile
    nominal : Experiment
    cases : CaseFolder
    results : ResultsFolder
        Of this command, inside the folder of the cases.
    machine : Machine
    given : dict
        The options.
    """

    command: str
    file: Path | None
    study: StudyFile
    nominal: Experiment
    cases: CaseFolder
    results: ResultsFolder
    machine: Machine
    given: dict[str, Any]

    @property
    def source(self) -> str:
        """Name of the study file, for messages."""
        return str(self.file) if self.file is not None else "study"

    @property
    def pressures_kPa(self) -> tuple[float, ...]:
        """Pressures of the ramp."""
        return self.study.study.pressures_kPa

    def beside(self, name: str) -> Path:
        """Return the path of a file named in the study file."""
        return (self.file.parent if self.file is not None else Path()) / name

    def suspects(self) -> tuple[Suspect, ...]:
        """Return the study's suspects.

        Raises
        ------
        InputError
            If there is none, or one is not valid.
        """
        from spavision.correlate.study.suspects import suspects_of

        if not self.study.suspects:
            raise InputError(
                f"{self.source}: names no suspect; add sections such as [suspects.side_wall_mm], which "
                "'spavision study starter' prints"
            )
        return suspects_of(self.study, self.nominal, source=self.source)

    def plan(self, suspects: tuple[Suspect, ...], *, n_full: int) -> Plan:
        """Return what a study of these suspects is asked; so many runs of the full model check it."""
        from spavision.correlate.study.plan import Plan

        study = self.study.study
        return Plan(
            suspects=suspects,
            experiment=self.nominal,
            pressures_kPa=self.pressures_kPa,
            n_cases=study.cases,
            n_full=n_full,
            sampling=study.sampling,
            seed=study.seed,
        )

    def case(self, values: dict[str, Value], *, model: str = "", crimp_ratio: float | None = None) -> Case:
        """Return the case in which the given parameters differ from their nominal values.

        Raises
        ------
        InputError
            If a value is out of its range, or the crimp ratio is not known.
        """
        from spavision.correlate.study.case import Case
        from spavision.correlate.study.parameters import laid_over

        ratio = {} if crimp_ratio is None else {"crimp_ratio": crimp_ratio}
        experiment = laid_over(self.nominal, {**ratio, **values})
        if experiment.actuator.crimp_ratio is None:
            raise InputError(
                f"{self.source}: the crimp ratio is not known; give --crimp 0.2, or crimp_ratio in [study]"
            )
        return Case(model or self.study.study.model, experiment, self.pressures_kPa, values)

    def run(self, cases: Sequence[Case], *, title: str) -> list[CaseResult]:
        """Return the results of cases, with progress; what failed is told on standard error."""
        from spavision.correlate.study.case_files import finished_cases

        with progress_bar(title, total=len(cases), quiet=self.given["quiet"]) as advance:
            return finished_cases(
                self.cases,
                cases,
                machine=self.machine,
                advance=advance,
                retry_failed=self.given["retry_failed"],
            )

    def write_cases(self, cases: Sequence[Case], results: Sequence[CaseResult]) -> None:
        """Write ``cases.csv`` and ``failed.csv``, and say on standard error what did not end well."""
        from spavision.correlate.study.case_table import case_table

        frame = case_table(cases, results)
        bad = frame[frame["status"] != "ok"]
        self.results.write_text("cases.csv", csv_text(frame))
        self.results.write_text("failed.csv", csv_text(bad))
        n_beyond = int(((frame["status"] == "ok") & (frame["reason"] != "")).sum())
        if n_beyond:
            output.warn(
                f"{n_beyond} of {len(frame)} cases leave the reduced model's range before the last pressure "
                "(cases.csv says where); lower pressures_kPa, or use --model full"
            )
        for _, row in bad.head(_REASONS_SHOWN).iterrows():
            output.warn(f"case {row['case']} {row['status']}: {row['reason']}")
        if len(bad) > _REASONS_SHOWN:
            output.warn(f"{len(bad)} of {len(frame)} cases failed or stopped; failed.csv lists them all")

    def write_figures(self, figures: dict[str, Figure]) -> None:
        """Write figures by name, as PNG and SVG."""
        from spavision.workflow.pictures import figure_bytes

        for name, figure in figures.items():
            for ending in ("png", "svg"):
                self.results.write_bytes(f"figures/{name}.{ending}", figure_bytes(figure, ending))

    def report(self, content: dict[str, Any], show: Callable[[], None]) -> None:
        """Print the result as JSON, or in words, which ``show`` prints, with its place."""
        if self.given["as_json"]:
            output.print_json({**content, "output": str(self.results.path)})
            return
        if not self.given["quiet"]:
            show()
        output.print_lines([f"Results: {self.results.path}"])

    def record(self, *, crimp_ratio: float | None = None) -> dict[str, Any]:
        """Return what ``run.json`` keeps of the study, at another crimp ratio where one is named."""
        from spavision.correlate.study.case import model_description

        experiment = self.nominal.with_options({"actuator": {"crimp_ratio": crimp_ratio}})
        return {
            "command": f"study {self.command}",
            "study": self.study.model_dump(),
            "experiment": experiment.model_dump(),
            "description": model_description(experiment),
        }


def prepare(command: str, file: Path | None, given: dict[str, Any]) -> Setup:
    """Read the study file and make ready to run.

    Raises
    ------
    InputError
        If the study or experiment file is not valid, or the results folder belongs to something else.
    """
    from spavision.correlate.study.case_files import CaseFolder
    from spavision.correlate.study.execution import Machine
    from spavision.correlate.study.study_file import StudyFile, read_study

    study = read_study(file) if file is not None else StudyFile()
    study = _with_options(study, given)
    nominal = Experiment()
    inputs = [file] if file is not None else []
    if study.study.experiment is not None:
        path = (file.parent if file is not None else Path()) / study.study.experiment
        nominal = read_experiment(path)
        inputs.append(path)
    if study.study.crimp_ratio is not None:
        nominal = nominal.with_options({"actuator": {"crimp_ratio": study.study.crimp_ratio}})
    folder = given["output"] or output.default_output("study", file.stem if file is not None else command)
    cases = CaseFolder(folder)
    results = ResultsFolder(folder / command, force=given["force"])
    results.record_inputs(inputs)
    machine = Machine(workers=given["workers"], scheduler=given["scheduler"])
    return Setup(command, file, study, nominal, cases, results, machine, given)


def _with_options(study: StudyFile, given: dict[str, Any]) -> StudyFile:
    from spavision.checked_settings import checked
    from spavision.correlate.study.study_file import StudyFile

    names = {"cases": "cases", "model": "model", "crimp": "crimp_ratio"}
    options = {key: given[name] for name, key in names.items() if given[name] is not None}
    content = study.model_dump()
    content["study"] |= options
    return checked(StudyFile, content, source="command line")
