"""What ``spavision coupon`` tells and writes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pandas as pd

from spavision.errors import InputError
from spavision.model.composite import PaperLayer
from spavision.model.coupon.calibration import SlackFibreComposite, calibrated_slack_fibre
from spavision.model.coupon.coupon import Coupon
from spavision.model.fitting.transition import StrainTransition
from spavision.results import ResultsFolder
from spavision.table_text import csv_text, number
from spavision.workflow.pictures import figure_bytes

PUBLISHED = {0.3: 0.388}
"""Measured transition strain by crimp ratio (article, section "Modeling")."""

_CALIBRATED_TO = 3.0
"""Stretch up to which the library's silicones were tested."""


def write_coupon(results: ResultsFolder, coupon: Coupon, *, options: Mapping[str, Any]) -> None:
    """Write the curve, the figure, the fields and ``run.json``."""
    from spavision.model.coupon.export import write_vtu_series
    from spavision.model.coupon.figures import coupon_figure

    # the name tells spavision fit the mode
    results.write_text(f"curve-{coupon.curve().mode.name}.csv", csv_text(curve_table(coupon)))
    figure = coupon_figure(coupon, _transition(coupon))
    for ending in ("png", "svg"):
        results.write_bytes(f"figures/coupon.{ending}", figure_bytes(figure, ending))
    composite = _calibrated(coupon)
    if composite is not None:
        lines = [f"{key} = {value:.6g}" for key, value in composite.experiment_keys().items()]
        results.write_text("composite.toml", "\n".join(["[composite]", *lines]) + "\n")
    fields = results.path / "fields"
    write_vtu_series(coupon, fields)
    results.adopt(fields)
    results.write_record(
        {
            "command": "coupon",
            "options": {key: _plain(value) for key, value in options.items()},
            "coupon": coupon_record(coupon),
        }
    )


def curve_table(coupon: Coupon) -> pd.DataFrame:
    """Return the curve; `spavision fit` takes the file as it is."""
    return pd.DataFrame(
        {
            "strain": coupon.strain,
            "nominal_stress_MPa": coupon.stress_MPa,
            "paper_tension_MPa": coupon.paper_tension_MPa,
            "largest_matrix_elongation": coupon.matrix_stretch,
            "width_change": coupon.width_strain,
        }
    )


def coupon_record(coupon: Coupon) -> dict[str, Any]:
    """Return settings and outcome as JSON takes them."""
    transition, composite = _transition(coupon), _calibrated(coupon)
    return {
        "geometry": asdict(coupon.cell.geometry),
        "paper": {key: _plain(value) for key, value in asdict(coupon.cell.beam.paper).items()},
        "settings": asdict(coupon.settings),
        "points": len(coupon.strain),
        "straight_strain": coupon.cell.geometry.straight_strain,
        "end_strain": float(coupon.strain[-1]),
        "end_stress_MPa": float(coupon.stress_MPa[-1]),
        "ended_by": coupon.ended_by,
        "transition": None
        if transition is None
        else {
            "strain": transition.strain,
            "primary_modulus_MPa": transition.primary.modulus_MPa,
            "secondary_modulus_MPa": transition.secondary.modulus_MPa,
        },
        "composite": None if composite is None else composite.experiment_keys(),
    }


def coupon_rows(coupon: Coupon) -> list[list[str]]:
    """Return rows of quantity, value and remark."""
    transition, geometry = _transition(coupon), coupon.cell.geometry
    torn = coupon.ended_by == "tear"
    rows = [
        [
            "paper straight at strain, %",
            number(100.0 * geometry.straight_strain, 1),
            "path length of the wave",
        ],
        [
            "end of the test at strain, %",
            number(100.0 * float(coupon.strain[-1]), 1),
            "the paper tears" if torn else coupon.ended_by,
        ],
        ["nominal stress there, kPa", number(1e3 * float(coupon.stress_MPa[-1]), 1), ""],
    ]
    if transition is None:
        return rows
    published = PUBLISHED.get(round(geometry.crimp_ratio, 6))
    remark = "" if published is None else f"published test: {100.0 * published:.1f} %"
    return [
        *rows,
        ["primary modulus, kPa", number(1e3 * transition.primary.modulus_MPa, 1), "first 10 % strain"],
        ["secondary modulus, kPa", number(1e3 * transition.secondary.modulus_MPa, 0), "last ten points"],
        ["strain transition point, %", number(100.0 * transition.strain, 1), remark],
    ]


def coupon_notes(coupon: Coupon) -> list[str]:
    """Return what must be known about the result."""
    notes = []
    try:
        coupon.transition()
        composite = _calibrated(coupon)
    except InputError as error:
        notes.append(f"No transition point: {error}")
        composite = None
    if composite is not None:
        notes += [
            *composite.notes,
            "composite.toml holds it for an experiment file, or use --composite resolved",
        ]
    if coupon.ended_by not in ("tear", "end strain"):
        notes.append(f"The test ended early: {coupon.ended_by}")
    if coupon.matrix_stretch[-1] > _CALIBRATED_TO:
        notes.append(f"The matrix is stretched to {coupon.matrix_stretch[-1]:.2f}, beyond its tests")
    notes.append(
        "Assumed: wavelength, fold radius, paper's modulus, strength and yield, perfect bond, and the "
        "sampling of the test; the transition hangs on fold radius and sampling first (docs/materials.md)"
    )
    return notes


def _transition(coupon: Coupon) -> StrainTransition | None:
    try:
        return coupon.transition()
    except InputError:
        return None


def _calibrated(coupon: Coupon) -> SlackFibreComposite | None:
    """Calibrate the actuator's composite, where the crimp ratio is one that it takes."""
    try:
        return calibrated_slack_fibre(
            coupon.curve(),
            matrix=coupon.matrix.law,
            crimp_ratio=coupon.cell.geometry.crimp_ratio,
            paper=PaperLayer(),
        )
    except InputError:
        return None


def _plain(value: Any) -> Any:
    """Return a value as JSON takes it: a path or an infinite number as text."""
    infinite = isinstance(value, float) and not math.isfinite(value)
    return str(value) if infinite or isinstance(value, Path) else value
