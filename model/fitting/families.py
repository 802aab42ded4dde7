"""The laws that can be fitted, by the names of the command line."""

from __future__ import annotations

import numpy as np

from spavision.errors import InputError
from spavision.model.materials.arruda_boyce import ArrudaBoyce
from spavision.model.materials.gent import Gent
from spavision.model.materials.mooney_rivlin import MooneyRivlin
from spavision.model.materials.neo_hooke import NeoHooke
from spavision.model.materials.ogden import Ogden
from spavision.model.materials.yeoh import Yeoh

from .fit_data import FitData
from .linear_family import LinearFamily
from .measured_curve import FloatArray
from .separable_family import Reported, SeparableFamily

LARGEST_EXPONENT = 30.0
"""Exponents of Ogden's law are looked for up to this. Tension alone hardly tells α from −2α, and large
negative exponents make the law lock in biaxial tension."""

_SMALLEST_EXPONENT = 1e-4
"""An exponent nearer 0 is moved here; the stress changes by less than its share."""

_NEARLY_NEO_HOOKEAN = 1e5
"""Largest Ī₁ − 3 of locking, as a multiple of the data's."""

_ROOM_TO_LOCKING = 1e-6
"""A locking law's limit stays above the data's largest Ī₁ − 3 by this share."""


def _ogden_shape(alpha: float, log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Term of unit shear modulus, 2 (λ^α − 1)/α, smooth through α = 0, and its derivative in α."""
    x = alpha * log_stretch
    near = np.abs(x) < 1e-3
    safe = np.where(near, 1.0, x)
    mean_slope = np.where(near, 1.0 + x * (1 / 2 + x * (1 / 6 + x / 24)), np.expm1(safe) / safe)
    bend = np.where(
        near,
        1 / 2 + x * (1 / 3 + x * (1 / 8 + x / 30)),
        (np.exp(safe) - np.expm1(safe) / safe) / safe,
    )
    return 2.0 * log_stretch * mean_slope, 2.0 * log_stretch**2 * bend


def _ogden_draw(terms: int, rng: np.random.Generator) -> FloatArray:
    """Exponents of either sign between 0.4 and 20, evenly on a logarithmic scale."""
    return rng.choice([-1.0, 1.0], terms) * 10.0 ** rng.uniform(-0.4, 1.3, terms)


def _ogden_report(moduli: FloatArray, alpha: FloatArray) -> Reported:
    """μ = 2G/α of every term, and α."""
    alpha = np.where(np.abs(alpha) < _SMALLEST_EXPONENT, np.copysign(_SMALLEST_EXPONENT, alpha), alpha)
    mu = 2.0 * moduli / alpha
    terms = len(alpha)
    change = np.zeros((2 * terms, 2 * terms))
    for j in range(terms):
        change[2 * j, j] = 2.0 / alpha[j]
        change[2 * j, terms + j] = -mu[j] / alpha[j]
        change[2 * j + 1, terms + j] = 1.0
    return Reported(
        law=Ogden(tuple(mu.tolist()), tuple(alpha.tolist())),
        names=tuple(f"{name}{j + 1}" for j in range(terms) for name in ("mu", "alpha")),
        units=("MPa", "") * terms,
        values=np.stack([mu, alpha], axis=1).ravel(),
        change=change,
    )


def _ogden(terms: int) -> SeparableFamily:
    return SeparableFamily(
        key=f"ogden{terms}",
        label=f"Ogden, {terms} term{'s' if terms > 1 else ''}",
        terms=terms,
        shape=_ogden_shape,
        shape_bounds=lambda _data: (-LARGEST_EXPONENT, LARGEST_EXPONENT),
        draw=lambda rng, _bounds: _ogden_draw(terms, rng),
        report=_ogden_report,
    )


def _gent_shape(log_limit: float, log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
    limit = float(np.exp(log_limit))
    law = Gent(1.0, limit)
    return law.derivatives(log_stretch)[0], limit * law.limit_sensitivity(log_stretch)


def _gent_report(moduli: FloatArray, log_limit: FloatArray) -> Reported:
    modulus, limit = float(moduli[0]), float(np.exp(log_limit[0]))
    return Reported(
        Gent(modulus, limit), ("G", "Jm"), ("MPa", ""), np.array([modulus, limit]), np.diag([1.0, limit])
    )


def _gent_bounds(data: FitData) -> tuple[float, float]:
    largest = data.largest_invariant
    return float(np.log(largest * (1.0 + _ROOM_TO_LOCKING))), float(np.log(largest * _NEARLY_NEO_HOOKEAN))


def _chain_shape(log_locking: float, log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
    locking = float(np.exp(log_locking))
    law = ArrudaBoyce(1.0, locking)
    return law.derivatives(log_stretch)[0], locking * law.locking_sensitivity(log_stretch)


def _chain_report(moduli: FloatArray, log_locking: FloatArray) -> Reported:
    modulus, locking = float(moduli[0]), float(np.exp(log_locking[0]))
    return Reported(
        ArrudaBoyce(modulus, locking),
        ("mu", "lambda_m"),
        ("MPa", ""),
        np.array([modulus, locking]),
        np.diag([1.0, locking]),
    )


def _chain_bounds(data: FitData) -> tuple[float, float]:
    low, high = (1.0 + np.exp(bound) / 3.0 for bound in _gent_bounds(data))
    return float(0.5 * np.log(low)), float(0.5 * np.log(high))


def _anywhere(rng: np.random.Generator, bounds: tuple[float, float]) -> FloatArray:
    return rng.uniform(*bounds, 1)


Family = LinearFamily | SeparableFamily

_EVERY: tuple[Family, ...] = (
    LinearFamily("neo-hooke", "neo-Hooke", ("G",), NeoHooke),
    LinearFamily("mooney2", "Mooney-Rivlin, 2 terms", ("C10", "C01"), MooneyRivlin),
    LinearFamily("mooney3", "Mooney-Rivlin, 3 terms", ("C10", "C01", "C11"), MooneyRivlin),
    LinearFamily("mooney5", "Mooney-Rivlin, 5 terms", ("C10", "C01", "C11", "C20", "C02"), MooneyRivlin),
    LinearFamily("yeoh", "Yeoh", ("C10", "C20", "C30"), Yeoh),
    SeparableFamily("gent", "Gent", 1, _gent_shape, _gent_bounds, _anywhere, _gent_report),
    SeparableFamily("arruda-boyce", "Arruda-Boyce", 1, _chain_shape, _chain_bounds, _anywhere, _chain_report),
    *(_ogden(terms) for terms in (1, 2, 3, 4)),
)

FAMILIES = {family.key: family for family in _EVERY}
"""Every law by its key."""

_SHORT = {"ogden": "ogden3", "mooney": "mooney2", "mooney-rivlin": "mooney2"}


def find_family(name: str) -> Family:
    """Return the law of that name; ``ogden`` stands for three terms, as in the article.

    Raises
    ------
    InputError
        If there is none.
    """
    key = _SHORT.get(name, name)
    if key not in FAMILIES:
        raise InputError(f"law {name!r} is unknown, expected one of {', '.join(FAMILIES)}, or all")
    return FAMILIES[key]
