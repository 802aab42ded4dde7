"""Sweep the virtual coupon's assumptions and write docs/materials.md.

Each assumption is changed alone around the defaults at crimp ratio 0.3, where the article publishes the
measured transition strain (38.8 %). Fold radius and sampling, on which most hangs, are changed together. On
the coupon's curves the article's comparison of laws is repeated.

Run: python benchmarks/coupon_sweep.py
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from spavision.correlate.model_inputs import model_inputs
from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.model.coupon.cell import CellSettings
from spavision.model.coupon.coupon import Coupon, CouponSettings, pull_coupon
from spavision.model.coupon.geometry import CouponGeometry
from spavision.model.coupon.paper import paper_of_sheet
from spavision.model.fitting.fit import FitSettings, fit_law
from spavision.model.fitting.transition import transition_or_none
from spavision.model.materials.curves import UNIAXIAL
from spavision.model.materials.library import find_material
from spavision.model.outputs import design_outputs
from spavision.model.simulate import simulate

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "materials.md"
TEXT = ROOT / "benchmarks" / "materials_page.md"
FIGURE = ROOT / "docs" / "images" / "coupon_sweep.png"

PUBLISHED_TRANSITION = 0.388
PUBLISHED = {
    "ogden3": ("Ogden, 3 terms", "0.779", "2.84 %"),
    "gent": ("Gent", "0.757", "8.76 %"),
    "yeoh": ("Yeoh", "0.713", "–"),
    "mooney3": ("Mooney-Rivlin, 3 terms", "0.592", "–"),
}
"""Law, R² and error of the transition strain (article, section "Modeling")."""

PUBLISHED_EXTREMA = ("17.5, pressure not told", "71.25 at 40 kPa")
"""First extremum of x in mm at crimp ratios 0.2 and 0.3 (article, section "Results and Discussion")."""

COMPOSITES: dict[str, dict[str, Any]] = {
    "slack-fibre, as stated": {},
    "ogden, by coupon": {"law": "ogden"},
    "resolved": {"law": "resolved"},
    "resolved, fold radius 0.5 mm": {"law": "resolved", "coupon_fold_radius_mm": 0.5},
}

RADII_MM = (0.0, 0.25, 0.5, 0.75)
SAMPLINGS = (0.0025, 0.005, 0.01, 0.02)
CRIMP_RATIOS = (0.2, 0.25, 0.3)


@dataclass(frozen=True)
class Case:
    """A coupon that differs from the default in what is given."""

    title: str
    crimp_ratio: float = 0.3
    matrix: str = "Ecoflex 00-30"
    geometry: dict[str, float] = field(default_factory=dict)
    paper: dict[str, float] = field(default_factory=dict)
    cell: dict[str, Any] = field(default_factory=dict)
    test: dict[str, float] = field(default_factory=dict)


SINGLE = (
    Case("defaults"),
    *(Case(f"wavelength {x:g} mm", geometry={"wavelength_mm": x}) for x in (3.0, 4.0, 6.5, 8.0)),
    *(Case(f"fold radius {x:g} mm", geometry={"fold_radius_mm": x}) for x in (0.0, 0.1, 0.5, 0.75)),
    Case("folds hinged", cell={"hinged_folds": True}),
    *(Case(f"paper {x:g} MPa", paper={"modulus_MPa": x}) for x in (300.0, 2000.0, 7000.0)),
    *(Case(f"paper {x:g} mm thick", paper={"thickness_mm": x}) for x in (0.08, 0.12)),
    Case("paper elastic in bending", paper={"bending_yield_MPa": float("inf")}),
    *(Case(f"paper yields in bending at {x:g} MPa", paper={"bending_yield_MPa": x}) for x in (15.0, 60.0)),
    *(
        Case(f"paper tears at {x:g} MPa", paper={"strength_MPa": x, "bending_yield_MPa": 35.0})
        for x in (7, 15, 50)
    ),
    Case("matrix Ecoflex, Marechal 2021", matrix="Ecoflex 00-30, Marechal 2021"),
    Case("matrix Ecoflex, Liao 2021", matrix="Ecoflex 00-30, Liao 2021"),
    Case("generalised plane stress", cell={"lateral": "plane-stress"}),
    Case(
        "generalised plane stress, no paper across",
        paper={"cross_ratio": 0.0},
        cell={"lateral": "plane-stress"},
    ),
    *(Case(f"a point each {x:.2%}", test={"strain_step": x}) for x in (0.0025, 0.01, 0.02)),
)


def pull(case: Case) -> Coupon:
    return pull_coupon(
        CouponGeometry(case.crimp_ratio, **case.geometry),
        matrix=find_material(case.matrix).solid(),
        paper=paper_of_sheet("Bond paper 80 gsm", **case.paper),
        settings=CouponSettings(cell=CellSettings(**case.cell), **case.test),
    )


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    alignment = ["---", *["---:"] * (len(header) - 1)]
    return "\n".join("| " + " | ".join(row) + " |" for row in (header, alignment, *rows)) + "\n"


def outcome(case: Case) -> list[str]:
    """Straight strain, end, primary and secondary modulus, transition, as text."""
    coupon = pull(case)
    point = transition_or_none(coupon.strain, coupon.stress_MPa)
    found = (
        ["–", "–", "–"]
        if point is None
        else [
            f"{1e3 * point.primary.modulus_MPa:.0f}",
            f"{point.secondary.modulus_MPa:.2f}",
            f"{100 * point.strain:.1f}",
        ]
    )
    end = f"{100 * coupon.strain[-1]:.1f}" + ("" if coupon.ended_by == "tear" else f" ({coupon.ended_by})")
    return [case.title, f"{100 * coupon.cell.geometry.straight_strain:.1f}", end, *found]


OUTCOME = ("case", "straight at %", "end at %", "primary kPa", "secondary MPa", "transition %")


def radius_and_sampling() -> str:
    rows = []
    for radius in RADII_MM:
        cells = [f"{radius:g}"]
        for step in SAMPLINGS:
            case = Case("", geometry={"fold_radius_mm": radius}, test={"strain_step": step})
            coupon = pull(case)
            point = transition_or_none(coupon.strain, coupon.stress_MPa)
            cells.append("–" if point is None else f"{100 * point.strain:.1f}")
        rows.append(cells)
    return table(["fold radius mm", *(f"a point each {step:.2%}" for step in SAMPLINGS)], rows)


def comparison() -> str:
    """R² and transition error of the article's laws on the coupon's curves."""
    rows = [[name, f"{score} / {error}"] for name, score, error in PUBLISHED.values()]
    header = ["law", "article, test at 0.3"]
    for ratio in CRIMP_RATIOS:
        for step in (0.005, 0.02) if ratio == max(CRIMP_RATIOS) else (0.005,):
            coupon = pull(Case("", crimp_ratio=ratio, test={"strain_step": step}))
            header.append(f"coupon at {ratio:g}, a point each {step:.1%}")
            for row, law in zip(rows, PUBLISHED, strict=True):
                row.append(
                    " | ".join(merit(coupon, law, unstable) for unstable in (False, True)).replace("|", "·")
                )
    return table(header, rows)


def ogden_sets() -> str:
    """Stable three-term Ogden laws fitted to the coupon's curves, where the article has its Table 1."""
    rows = []
    for ratio in CRIMP_RATIOS:
        curve = replace(pull(Case("", crimp_ratio=ratio)).curve(), mode=UNIAXIAL)
        fit = fit_law("ogden", [curve], FitSettings(any_modulus=True))
        pairs = "; ".join(f"{each.name} {each.value:.5g}" for each in fit.parameters)
        rows.append(
            [f"{ratio:g}", pairs, f"{1e3 * fit.law.shear_modulus_MPa:.1f}", f"{fit.goodness.r_squared:.3f}"]
        )
    return table(["crimp ratio", "parameters, μ in MPa", "G0 kPa", "R²"], rows)


def ramps() -> str:
    """First extremum of the actuator's tip with each composite, draft mesh, against the article's tests."""
    rows = [["article, test", *PUBLISHED_EXTREMA]]
    for title, composite in COMPOSITES.items():
        cells = [title]
        for ratio in (0.2, 0.3):
            content = {"actuator": {"crimp_ratio": ratio}, "composite": composite, "model": {"mesh": "draft"}}
            inputs = model_inputs(Experiment.model_validate(content))
            found = simulate(
                inputs.geometry,
                crimp_ratio=ratio,
                pressures_kPa=np.arange(0.0, 66.0, 5.0),
                settings=inputs.settings,
            )
            outputs = design_outputs(found)
            turn = outputs.mode_change_kPa
            end = "no turn up to 65 kPa" if turn is None else f"at {turn:.0f} kPa"
            cells.append(f"{outputs.first_extremum_mm:.0f} {end}")
        rows.append(cells)
    return table(["composite", "x of the first extremum at 0.2, mm", "at 0.3, mm"], rows)


def merit(coupon: Coupon, law: str, allow_unstable: bool) -> str:
    measured = coupon.transition()
    # the curve is read as a uniaxial test, as the article does
    curve = replace(coupon.curve(), mode=UNIAXIAL)
    try:
        fit = fit_law(law, [curve], FitSettings(allow_unstable=allow_unstable, any_modulus=True))
    except InputError:
        return "–"
    found = transition_or_none(curve.strain, fit.stress_of(curve))
    error = "–" if found is None else f"{measured.relative_error_of(found):.1%}"
    return f"{fit.goodness.r_squared:.3f} / {error}{'' if fit.is_stable else ' u'}"


def draw() -> None:
    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    curves, points = figure.subplots(1, 2)
    ratios = np.array([0.15, 0.2, 0.25, 0.3, 0.35])
    for radius, colour in zip(RADII_MM[:3], ("#0072B2", "#009E73", "#D55E00"), strict=True):
        found = []
        for ratio in ratios:
            coupon = pull(
                Case("", crimp_ratio=float(ratio), geometry={"fold_radius_mm": radius, "wavelength_mm": 5.0})
            )
            point = transition_or_none(coupon.strain, coupon.stress_MPa)
            found.append(np.nan if point is None else 100 * point.strain)
            if radius == 0.25 and ratio in CRIMP_RATIOS:
                curves.plot(100 * coupon.strain, 1e3 * coupon.stress_MPa, label=f"crimp ratio {ratio:g}")
        points.plot(
            ratios, found, marker="o", markersize=4, color=colour, label=f"coupon, fold radius {radius:g} mm"
        )
    straight = 100 * (np.sqrt(1 + 16 * ratios**2) - 1)
    points.plot(ratios, straight, "k:", label="sharp triangle straight, √(1 + 16 CR²) − 1")
    points.plot(
        ratios, 0.69 * straight, color="0.5", linestyle="--", label="0.69 of it (the actuator's default)"
    )
    points.plot([0.3], [100 * PUBLISHED_TRANSITION], "k*", markersize=11, label="published test")
    curves.set(xlabel="engineering strain, %", ylabel="nominal stress, kPa")
    points.set(xlabel="crimp ratio", ylabel="strain transition point, %")
    for axes in (curves, points):
        axes.legend(fontsize="small")
        axes.grid(alpha=0.3)
    with rc_context({"svg.hashsalt": "spavision"}):
        figure.savefig(FIGURE, dpi=130, metadata={"Software": None})


def main() -> None:
    parts = {
        "{{SINGLE}}": table(OUTCOME, [outcome(case) for case in SINGLE]),
        "{{RATIOS}}": table(
            OUTCOME,
            [
                outcome(Case(f"crimp ratio {ratio:g}", crimp_ratio=ratio))
                for ratio in (0.15, *CRIMP_RATIOS, 0.35)
            ],
        ),
        "{{RADIUS}}": radius_and_sampling(),
        "{{LAWS}}": comparison(),
        "{{OGDEN}}": ogden_sets(),
        "{{RAMPS}}": ramps(),
    }
    page = TEXT.read_text(encoding="utf-8")
    for mark, text in parts.items():
        page = page.replace(mark + "\n", text)
    PAGE.write_text(page, encoding="utf-8")
    draw()
    print(page)


if __name__ == "__main__":
    main()
