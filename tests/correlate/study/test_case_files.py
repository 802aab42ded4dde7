"""Studies that are interrupted, killed, repeated and mixed up."""

from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from spavision.correlate.study.case_files import STUDY_NAME, CaseFolder, finished_cases
from spavision.correlate.study.case_table import case_table
from spavision.correlate.study.evaluate import evaluate
from spavision.correlate.study.execution import ATTEMPTS, Machine, run_cases
from spavision.errors import InputError

from .conftest import silent, wall_cases

HERE, TWO_WORKERS = Machine(), Machine(workers=2)


def evaluated(folder: Path) -> list[str]:
    return (folder / "evaluated").read_text().split()


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="kills a process by signal")
def test_study_of_200_reduced_cases_loses_nothing_when_a_worker_is_killed_half_way(
    stand_in: ModuleType, tmp_path: Path
) -> None:
    """Each result is that of its own case, and none is missing."""
    walls = [float(wall) for wall in np.linspace(2.0, 4.0, 201)[:200]]
    cases = wall_cases(walls, pressures_kPa=(0.0, 1.0))
    results = finished_cases(
        CaseFolder(tmp_path / "study"),
        cases,
        machine=TWO_WORKERS,
        advance=silent,
        evaluate=stand_in.reduced_killed_once,
    )
    assert (tmp_path / "killed").exists()
    assert [result.status for result in results] == ["ok"] * 200
    moved = np.array([result.ux_mm[1] for result in results])
    assert np.abs(np.diff(moved)).max() < 0.02 * np.ptp(moved), "the tip moves less from wall to wall"
    for row in (0, 100, 199):
        assert moved[row] == pytest.approx(evaluate(cases[row]).ux_mm[1], rel=1e-9)
    assert len(list((tmp_path / "study" / "cases").iterdir())) == 200


@pytest.mark.skipif(os.name != "posix", reason="kills a process by signal")
def test_case_that_kills_every_worker_is_given_up_and_tried_again_later(
    stand_in: ModuleType, tmp_path: Path
) -> None:
    folder, cases = CaseFolder(tmp_path / "study"), wall_cases([2.0, 3.0, 4.0])
    given_up = finished_cases(
        folder, cases, machine=TWO_WORKERS, advance=silent, evaluate=stand_in.killed_always
    )
    assert [result.status for result in given_up] == ["ok", "failed", "ok"]
    assert f"died at each of {ATTEMPTS} attempts" in given_up[1].reason
    again = finished_cases(folder, cases, machine=HERE, advance=silent, evaluate=stand_in.linear)
    assert [result.status for result in again] == ["ok", "ok", "ok"]
    assert evaluated(tmp_path)[2:] == ["3.000000"]


def test_interrupted_study_goes_on_where_it_stopped(stand_in: ModuleType, tmp_path: Path) -> None:
    folder, cases = CaseFolder(tmp_path / "study"), wall_cases([2.0, 2.5, 3.0, 3.5])

    def interrupted(case: object) -> object:
        if case is cases[2]:
            raise KeyboardInterrupt
        return stand_in.linear(case)

    with pytest.raises(KeyboardInterrupt):
        finished_cases(folder, cases, machine=HERE, advance=silent, evaluate=interrupted)
    results = finished_cases(
        CaseFolder(tmp_path / "study"), cases, machine=HERE, advance=silent, evaluate=stand_in.linear
    )
    assert [result.ux_mm[-1] for result in results] == [40.0, 50.0, 60.0, 70.0]
    assert evaluated(tmp_path) == ["2.000000", "2.500000", "3.000000", "3.500000"]


def test_failed_case_keeps_its_row_and_reason(stand_in: ModuleType, tmp_path: Path) -> None:
    folder, cases = CaseFolder(tmp_path / "study"), wall_cases([2.0, 4.95])
    results = finished_cases(folder, cases, machine=HERE, advance=silent, evaluate=stand_in.linear)
    table = case_table(cases, results)
    assert list(table["status"]) == ["ok", "failed"]
    assert list(table["reason"]) == ["", "wall too thick"]
    assert table["side_wall_mm"].tolist() == [2.0, 4.95]
    finished_cases(folder, cases, machine=HERE, advance=silent, evaluate=stand_in.linear)
    assert evaluated(tmp_path) == ["2.000000", "4.950000"]
    finished_cases(folder, cases, machine=HERE, advance=silent, evaluate=stand_in.linear, retry_failed=True)
    assert evaluated(tmp_path)[2:] == ["4.950000"]


def test_half_written_case_is_computed_again(stand_in: ModuleType, tmp_path: Path) -> None:
    folder, cases = CaseFolder(tmp_path / "study"), wall_cases([2.0])
    for _ in range(2):
        (result,) = finished_cases(folder, cases, machine=HERE, advance=silent, evaluate=stand_in.linear)
        assert result.status == "ok"
        file = next((tmp_path / "study" / "cases").iterdir())
        file.write_text(file.read_text()[:40])
    assert len(evaluated(tmp_path)) == 2


def test_geometry_that_collides_is_a_failed_case_with_the_sentence() -> None:
    (case,) = wall_cases([8.0])
    result = evaluate(case)
    assert result.status == "failed"
    assert "2 × side_wall_mm is 16 mm and width_mm is 15 mm" in result.reason


def test_name_of_a_case_follows_its_inputs_alone() -> None:
    thin, thick = wall_cases([2.0, 2.1])
    assert thin.name == wall_cases([2.0])[0].name != thick.name


def test_folder_of_another_version_is_refused_in_one_sentence(tmp_path: Path) -> None:
    record = {"version": {"spavision": "0.0.7", "model": "abc"}}
    (tmp_path / STUDY_NAME).write_text(json.dumps(record))
    with pytest.raises(InputError, match=r"holds results of spavision 0\.0\.7 .*choose another folder"):
        CaseFolder(tmp_path)


def test_folder_of_something_else_is_refused(tmp_path: Path) -> None:
    (tmp_path / "holiday.jpg").touch()
    with pytest.raises(InputError, match="no study's"):
        CaseFolder(tmp_path)


def test_scheduler_that_does_not_answer_is_told(stand_in: ModuleType, monkeypatch, tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("spavision.correlate.study.dask_workers.TIMEOUT_SECONDS", 1)
    silent_address = Machine(scheduler="tcp://127.0.0.1:9")
    with pytest.raises(InputError, match="no scheduler answered within 1 s"):
        finished_cases(
            CaseFolder(tmp_path / "study"),
            wall_cases([2.0]),
            machine=silent_address,
            advance=silent,
            evaluate=stand_in.linear,
        )


@pytest.mark.parametrize(
    ("address", "sentence"),
    [
        ("somewhere", "expected an address such as tcp://host:8786"),
        ("tcp://localhost", "expected an address such as tcp://host:8786"),
        ("tcp://localhost:port", "expected an address such as tcp://host:8786"),
        ("tcp://nobody.invalid:8786", "the host is not known"),
    ],
)
def test_address_that_is_none_is_told_at_once(address: str, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        next(run_cases(evaluate, wall_cases([2.0]), Machine(scheduler=address)))


def test_worker_with_another_version_ends_the_study() -> None:
    (case,) = wall_cases([2.0])
    with pytest.raises(InputError, match=r"the study needs 0\.0\.7 \(model abc\); install it there"):
        evaluate(replace(case, version={"spavision": "0.0.7", "model": "abc"}))
