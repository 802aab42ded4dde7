"""One sample of each law, with the textbook slopes ∂W/∂I₁ and ∂W/∂I₂ of those in invariants."""

import numpy as np
from scipy.optimize import brentq

from spavision.model.materials.arruda_boyce import ArrudaBoyce
from spavision.model.materials.gent import Gent
from spavision.model.materials.mooney_rivlin import MooneyRivlin
from spavision.model.materials.neo_hooke import NeoHooke
from spavision.model.materials.ogden import Ogden
from spavision.model.materials.yeoh import Yeoh

BODY = Ogden((0.131, 0.003), (2.0, 6.0))
"""The law "BODY" of closed-forms.md."""


def _chain_slope(i1, _i2):
    """Arruda and Boyce: μ λm/(6 λc) L⁻¹(λc/λm), the inverse found by bisection of coth β − 1/β."""
    chain = np.sqrt(i1 / 3.0)
    beta = brentq(lambda b: 1.0 / np.tanh(b) - 1.0 / b - chain / 3.2, 1e-3, 1e4, xtol=1e-14)
    return 0.1 * 3.2 / (6.0 * chain) * beta


def ogden_stress(stretch, mode):
    """Nominal stress of BODY, Σ μ (λ^(α−1) − λ^(−βα−1)) with β = 1/2, 2, 1 (closed-forms.md, 1, 3, 4)."""
    share = {"uniaxial": 0.5, "equibiaxial": 2.0, "planar": 1.0}[mode]
    terms = zip(BODY.mu_MPa, BODY.alpha, strict=True)
    return sum(mu * (stretch ** (a - 1.0) - stretch ** (-share * a - 1.0)) for mu, a in terms)


def _none(_i1, _i2):
    return 0.0


INVARIANT_LAWS = {
    "neo-Hooke": (NeoHooke(0.14), lambda _i1, _i2: 0.07, _none),
    "Mooney-Rivlin, 2 terms": (MooneyRivlin(0.05, 0.02), lambda _i1, _i2: 0.05, lambda _i1, _i2: 0.02),
    "Mooney-Rivlin, 3 terms": (
        MooneyRivlin(0.05, 0.02, 0.003),
        lambda _i1, i2: 0.05 + 0.003 * (i2 - 3),
        lambda i1, _i2: 0.02 + 0.003 * (i1 - 3),
    ),
    "Mooney-Rivlin, 5 terms": (
        MooneyRivlin(0.05, 0.02, 0.003, 0.004, 0.001),
        lambda i1, i2: 0.05 + 0.003 * (i2 - 3) + 0.008 * (i1 - 3),
        lambda i1, i2: 0.02 + 0.003 * (i1 - 3) + 0.002 * (i2 - 3),
    ),
    "Yeoh": (
        Yeoh(0.06, -0.001, 0.0002),
        lambda i1, _i2: 0.06 - 0.002 * (i1 - 3) + 0.0006 * (i1 - 3) ** 2,
        _none,
    ),
    "Gent": (Gent(0.12, 40.0), lambda i1, _i2: 0.06 * 40.0 / (43.0 - i1), _none),
    "Arruda-Boyce": (ArrudaBoyce(0.1, 3.2), _chain_slope, _none),
}

LAWS = {"Ogden": BODY, **{name: entry[0] for name, entry in INVARIANT_LAWS.items()}}


def textbook_stress(name, stretch, mode):
    """Nominal stress at one stretch from W₁ and W₂ (Holzapfel, Nonlinear Solid Mechanics, section 6.5)."""
    if name == "Ogden":
        return ogden_stress(stretch, mode)
    _, slope_1, slope_2 = INVARIANT_LAWS[name]
    x = stretch
    i1, i2, factor, weight = {
        "uniaxial": (x**2 + 2 / x, 2 * x + x**-2, x - x**-2, 1 / x),
        "equibiaxial": (2 * x**2 + x**-4, x**4 + 2 * x**-2, x - x**-5, x**2),
        "planar": (x**2 + 1 + x**-2, x**2 + 1 + x**-2, x - x**-3, 1.0),
    }[mode]
    return 2.0 * factor * (slope_1(i1, i2) + weight * slope_2(i1, i2))
