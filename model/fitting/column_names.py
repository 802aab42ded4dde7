"""What a column holds, recognised from its name: strain or stress, which measure, which unit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

STRESS_UNITS_MPa = {
    "MPa": 1.0,
    "kPa": 1e-3,
    "Pa": 1e-6,
    "GPa": 1e3,
    "N/mm2": 1.0,
    "N/cm2": 1e-2,
    "N/m2": 1e-6,
    "bar": 0.1,
    "kgf/cm2": 9.80665e-2,
    "psi": 6.894757e-3,
}
"""Megapascals in one unit (psi: NIST SP 811, appendix B)."""

STRAIN_MEASURES = ("strain", "stretch", "true strain")
STRESS_MEASURES = ("nominal", "true")
STRAIN_UNITS = {"fraction": 1.0, "percent": 0.01}

_TRUE = re.compile(r"\b(true|cauchy|log|logarithmic|hencky)\b")
_NOMINAL = re.compile(r"\b(nominal|engineering|eng|piola|pk1|technical)\b")
_STRETCH = re.compile(r"\b(stretch|lambda|elongation ratio)\b|λ")
_STRAIN = re.compile(r"\b(strain|epsilon)\b|ε")
_STRESS = re.compile(r"\b(stress|sigma)\b|σ")
_PERCENT = re.compile(r"%|\bpercent\b")
_UNITS = (
    ("MPa", re.compile(r"\bmpa\b")),
    ("kPa", re.compile(r"\bkpa\b")),
    ("Pa", re.compile(r"\bpa\b")),
    ("GPa", re.compile(r"\bgpa\b")),
    ("N/mm2", re.compile(r"\bn/mm(2|²|\^2)")),
    ("N/cm2", re.compile(r"\bn/cm(2|²|\^2)")),
    ("N/m2", re.compile(r"\bn/m(2|²|\^2)")),
    ("bar", re.compile(r"\bbar\b")),
    ("kgf/cm2", re.compile(r"\bkgf?/cm(2|²|\^2)")),
    ("psi", re.compile(r"\bpsi\b")),
)


@dataclass(frozen=True)
class Column:
    """A column of strain or stress.

    Parameters
    ----------
    index : int
    measure : str or None
        One of `STRAIN_MEASURES` or `STRESS_MEASURES`; None where the name does not tell.
    unit : str or None
        A key of `STRESS_UNITS_MPa` or `STRAIN_UNITS`; None where the name does not tell.
    """

    index: int
    measure: str | None
    unit: str | None


def strain_columns(names: Sequence[str]) -> list[Column]:
    """Return the columns whose name says strain or stretch, in order."""
    found = []
    for index, text in enumerate(_plain(names)):
        unit = "percent" if _PERCENT.search(text) else None
        if _STRESS.search(text):
            continue
        if _STRETCH.search(text):
            found.append(Column(index, "stretch", unit))
        elif _STRAIN.search(text):
            known = _NOMINAL.search(text) is not None
            measure = "true strain" if _TRUE.search(text) else "strain" if known else None
            found.append(Column(index, measure, unit))
    return found


def stress_columns(names: Sequence[str]) -> list[Column]:
    """Return the columns whose name says stress, in order."""
    found = []
    for index, text in enumerate(_plain(names)):
        if _STRESS.search(text):
            measure = "true" if _TRUE.search(text) else "nominal" if _NOMINAL.search(text) else None
            unit = next((name for name, pattern in _UNITS if pattern.search(text)), None)
            found.append(Column(index, measure, unit))
    return found


def _plain(names: Sequence[str]) -> list[str]:
    """Lower case, with underscores and hyphens as blanks, so that words are words."""
    return [re.sub(r"[_\-\s]+", " ", name).strip().lower() for name in names]
