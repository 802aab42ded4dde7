"""The article's comparison of laws (R², strain transition), repeated on assumed bilinear curves.

The article fits Ogden, Gent, Yeoh and three-term Mooney-Rivlin laws to a tension test of the composite at
crimp ratio 0.3. Its data are not public. This script builds curves of that kind from what the finite-element
model assumes (a matrix of Ecoflex 00-30 and a slack fibre), for three shapes of the knee and three ends of
the test, and prints what the same procedure gives. Agreement in order of merit is all that can be asked for.

Run: python benchmarks/materials_comparison.py
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.errors import InputError
from spavision.model.composite import PaperLayer
from spavision.model.fitting.fit import FitSettings, LawFit, fit_law
from spavision.model.fitting.measured_curve import MeasuredCurve
from spavision.model.fitting.transition import StrainTransition, strain_transition, transition_or_none
from spavision.model.materials.curves import UNIAXIAL, fibre_composite_stress
from spavision.model.materials.library import find_material
from spavision.model.materials.slack_fibre import SlackFibre

CRIMP_RATIO = 0.3

PUBLISHED = {
    "ogden3": ("0.779", "2.84"),
    "gent": ("0.757", "8.76"),
    "yeoh": ("0.713", "–"),
    "mooney3": ("0.592", "–"),
}
"""R² and error of the transition strain in per cent (article, section "Modeling")."""


@dataclass(frozen=True)
class Case:
    """One assumed tension test."""

    title: str
    half_width: float
    end_strain: float


KNEES = {
    "sharp knee": 0.005,
    "medium knee": 0.04,
    "gradual knee (the default)": PaperLayer().transition_half_width,
}
END_STRAINS = (0.42, 0.45, 0.50)
CASES = tuple(Case(title, half_width, end) for title, half_width in KNEES.items() for end in END_STRAINS)

_WIDTH = 30


def tension_curve(case: Case) -> MeasuredCurve:
    """Return the nominal stress of matrix and paper, one point each percent of strain."""
    paper = PaperLayer()
    fibre = SlackFibre(
        (0.0, 1.0, 0.0), paper.length_modulus_MPa, paper.slack_strain(CRIMP_RATIO), case.half_width
    )
    stretch = 1.0 + np.arange(0.0, case.end_strain + 1e-9, 0.01)
    stress = fibre_composite_stress(find_material("Ecoflex 00-30").law, fibre, stretch, UNIAXIAL)
    return MeasuredCurve(case.title, UNIAXIAL, stretch, stress)


def row(key: str, curve: MeasuredCurve, measured: StrainTransition, *, allow_unstable: bool) -> list[str]:
    """Return R² and transition error of one law as text."""
    try:
        fit: LawFit = fit_law(key, [curve], FitSettings(allow_unstable=allow_unstable, any_modulus=True))
    except InputError:
        return ["–", "–"]
    found = transition_or_none(curve.strain, fit.stress_of(curve))
    error = f"{100.0 * measured.relative_error_of(found):.1f}" if found else "–"
    return [f"{fit.goodness.r_squared:.3f}{'' if fit.is_stable else ' u'}", error]


def main() -> None:
    print(f"Crimp ratio {CRIMP_RATIO}; assumed curves, not the article's data.")
    print("R² / error of the transition strain in %, of the stable fit | of any fit")
    print("u: unstable or locked within the data or in an untested mode\n")
    print_row("", list(PUBLISHED))
    print_row("article", [" / ".join(pair) for pair in PUBLISHED.values()])
    for case in CASES:
        curve = tension_curve(case)
        measured = strain_transition(curve.strain, curve.stress_MPa, name=case.title)
        cells = [
            " | ".join(
                " / ".join(row(key, curve, measured, allow_unstable=allowed)) for allowed in (False, True)
            )
            for key in PUBLISHED
        ]
        print_row(f"{case.title}, to {case.end_strain:.0%}: transition {measured.strain:.1%}", cells)


def print_row(title: str, cells: list[str]) -> None:
    print(f"{title:{2 * _WIDTH}s}" + "".join(f"{cell:>{_WIDTH}s}" for cell in cells))


if __name__ == "__main__":
    main()
