"""Cases on a Dask cluster of this machine."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import pytest

from spavision.correlate.study.case_files import CaseFolder, finished_cases
from spavision.correlate.study.execution import Machine

from .conftest import silent, wall_cases

distributed = pytest.importorskip("distributed")


def test_study_on_a_cluster_whose_worker_is_killed_loses_nothing(
    stand_in: ModuleType, tmp_path: Path
) -> None:
    walls = [2.0, 2.5, 3.0, 3.5, 4.0, 4.95]
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address=None, silence_logs=50
    ) as cluster:
        results = finished_cases(
            CaseFolder(tmp_path / "study"),
            wall_cases(walls),
            machine=Machine(scheduler=cluster.scheduler_address),
            advance=silent,
            evaluate=stand_in.killed_once,
        )
    assert (tmp_path / "killed").exists()
    assert [result.status for result in results] == ["ok"] * 5 + ["failed"]
    assert [result.ux_mm[-1] for result in results[:5]] == [20.0 * wall for wall in walls[:5]]
