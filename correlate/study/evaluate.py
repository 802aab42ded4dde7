"""Running one case, wherever that is: here, in another process, on another machine."""

from __future__ import annotations

import time

import numpy as np

from spavision.correlate.gauge import true_pressure_kPa
from spavision.correlate.model_inputs import model_inputs
from spavision.errors import InputError
from spavision.model.reduced.one_thread import one_thread
from spavision.model.reduced.ramp import simulate_reduced
from spavision.model.simulate import simulate
from spavision.tip_path import TipPath

from .case import Case, CaseResult, failed, model_version, version_text


def evaluate(case: Case) -> CaseResult:
    """Run the case's model in one thread; whatever goes wrong becomes the reason of a failed case.

    Raises
    ------
    InputError
        If the case was made for another version of the model than the one here.
    """
    start = time.process_time()
    if case.version != model_version():
        here, wanted = version_text(model_version()), version_text(case.version)
        raise InputError(f"a worker has spavision {here}, the study needs {wanted}; install it there")
    try:
        with one_thread():
            path = _tip_path(case)
    except InputError as error:
        return failed(case, str(error))
    except Exception as error:
        return failed(case, f"internal error: {type(error).__name__}: {error}")
    reached = path.has_reading
    status = "ok" if reached.all() else "stopped" if np.count_nonzero(reached) > 1 else "failed"
    return CaseResult(
        status=status,
        reason=_reason(case, path, status),
        ux_mm=tuple(path.ux_mm.tolist()),
        uy_mm=tuple(path.uy_mm.tolist()),
        seconds=time.process_time() - start,
    )


def _reason(case: Case, path: TipPath, status: str) -> str:
    """Say why the ramp stopped; where it did not, what its first remark is and from where on."""
    remarks = [(p, reason) for p, reason in zip(case.pressures_kPa, path.reason, strict=False) if reason]
    if not remarks:
        return ""
    pressure, first = remarks[0]
    return f"from {pressure:g} kPa on {first}" if status == "ok" else remarks[-1][1]


def _tip_path(case: Case) -> TipPath:
    inputs = model_inputs(case.experiment)
    run = simulate_reduced if case.model == "reduced" else simulate
    found = run(
        inputs.geometry,
        crimp_ratio=inputs.crimp_ratio,
        pressures_kPa=true_pressure_kPa(np.array(case.pressures_kPa), case.experiment.gauge),
        settings=inputs.settings,
    )
    return found.tip_path
