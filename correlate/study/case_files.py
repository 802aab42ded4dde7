"""The files of a study: one a finished case, named by the hash of its inputs."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from spavision.errors import InputError

from .case import STATUSES, Case, CaseResult, failed, model_version, version_text
from .evaluate import evaluate
from .execution import Evaluate, Machine, run_cases

STUDY_NAME = "study.json"
"""File that says which version a folder's cases belong to."""

_CASES = "cases"


class CaseFolder:
    """A folder of finished cases. What is in it is not computed again.

    Parameters
    ----------
    path : Path
        Made when the first case is finished.

    Raises
    ------
    InputError
        If the folder holds something else, or cases of another version of the model.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        if path.exists() and not path.is_dir():
            raise InputError(f"--output {path}: is a file, expected a folder; choose another name")
        record = path / STUDY_NAME
        if record.is_file():
            _refuse_other_version(record)
        elif path.is_dir() and any(path.iterdir()):
            raise InputError(f"--output {path}: holds files that are no study's; choose another folder")

    def find(self, case: Case) -> CaseResult | None:
        """Return the result of a case if it is there and whole."""
        try:
            content = json.loads(self._file(case).read_text(encoding="utf-8"))
            return _from_json(content["result"])
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def keep(self, case: Case, result: CaseResult) -> None:
        """Write the result of a case."""
        record = self.path / STUDY_NAME
        if not record.is_file():
            _write_whole(record, {"version": model_version()})
        _write_whole(
            self._file(case),
            {"values": case.values, "result": _to_json(result), "inputs": case.inputs()},
        )

    def _file(self, case: Case) -> Path:
        return self.path / _CASES / f"{case.name}.json"


def finished_cases(
    folder: CaseFolder,
    cases: Sequence[Case],
    *,
    machine: Machine,
    advance: Callable[[str, float], None],
    retry_failed: bool = False,
    evaluate: Evaluate = evaluate,
) -> list[CaseResult]:
    """Return the results of cases, running those that the folder does not hold.

    Parameters
    ----------
    folder : CaseFolder
    cases : sequence of Case
        Equal ones are run once.
    machine : Machine
    advance : callable
        Told a text and how many cases are done.
    retry_failed : bool
        Whether cases that failed before are run again.
    evaluate : callable
        From `Case` to `CaseResult`.

    Returns
    -------
    list of CaseResult
        In the order of the cases; one that failed or was lost says why.
    """
    names = [case.name for case in cases]
    by_name = dict(zip(names, cases, strict=True))
    found = {name: result for name, case in by_name.items() if (result := folder.find(case)) is not None}
    if retry_failed:
        found = {name: result for name, result in found.items() if result.status != "failed"}
    missing = [name for name in by_name if name not in found]
    n_failed = sum(result.status == "failed" for result in found.values())
    advance(f"{len(found)} of {len(by_name)} cases", len(found))
    for finished in run_cases(evaluate, [by_name[name] for name in missing], machine):
        name = missing[finished.index]
        if finished.result is None:
            # Not the case's own failure: it is tried again when the study goes on.
            found[name] = failed(by_name[name], finished.reason)
        else:
            found[name] = finished.result
            folder.keep(by_name[name], finished.result)
        n_failed += found[name].status == "failed"
        advance(f"{len(found)} of {len(by_name)} cases, {n_failed} failed", len(found))
    return [found[name] for name in names]


def _refuse_other_version(record: Path) -> None:
    try:
        version = json.loads(record.read_text(encoding="utf-8"))["version"]
        theirs, ours = version_text(version), version_text(model_version())
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{record}: is damaged; choose another folder") from error
    if theirs != ours:
        raise InputError(
            f"{record.parent}: holds results of spavision {theirs}, this is {ours}, and the two are not "
            "mixed; choose another folder"
        )


def _write_whole(path: Path, content: dict[str, Any]) -> None:
    """Write under a temporary name and rename: an interrupted study leaves no half file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".partial-{os.getpid()}-{path.name}")
    temporary.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    temporary.replace(path)


def _to_json(result: CaseResult) -> dict[str, Any]:
    content = asdict(result)
    for name in ("ux_mm", "uy_mm"):
        content[name] = [value if math.isfinite(value) else None for value in content[name]]
    return content


def _from_json(content: dict[str, Any]) -> CaseResult:
    if content["status"] not in STATUSES:
        raise ValueError(content["status"])
    columns = {
        name: tuple(float("nan") if value is None else float(value) for value in content[name])
        for name in ("ux_mm", "uy_mm")
    }
    return CaseResult(**{**content, **columns})
