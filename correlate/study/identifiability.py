"""Whether a measured path tells a parameter, said plainly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .posterior import Posterior
from .suspects import Suspect

IDENTIFIED, PARTLY = 0.5, 0.9
"""Posterior over prior standard deviation below which a parameter is called identified, partly identified."""

_AT_BOUND = 0.97


@dataclass(frozen=True)
class Parameter:
    """What the posterior says of one parameter.

    Parameters
    ----------
    suspect : Suspect
    median, low, high : float
        Of the posterior; 95 % lies between low and high.
    width_ratio : float
        Posterior over prior standard deviation.
    median_share : float
        Place of the median in the prior, 0 to 1.
    """

    suspect: Suspect
    median: float
    low: float
    high: float
    width_ratio: float
    median_share: float

    @property
    def verdict(self) -> str:
        """One of ``identified``, ``partly identified``, ``not identified``, ``at its bound``."""
        if not 1.0 - _AT_BOUND < self.median_share < _AT_BOUND:
            return "at its bound"
        if self.width_ratio < IDENTIFIED:
            return "identified"
        return "partly identified" if self.width_ratio < PARTLY else "not identified"

    def sentence(self) -> str:
        """Say it."""
        number = f"{self.suspect.name} is {self.median:.3g} ({self.low:.3g} to {self.high:.3g}, 95 %)"
        remark = {
            "at its bound": "it runs into the end of its distribution: something else is wrong, or the "
            "distribution is too narrow",
            "identified": f"identified, its width is {self.width_ratio:.2f} of the prior's",
            "partly identified": f"partly identified, its width is {self.width_ratio:.2f} of the prior's",
            "not identified": "not identified, the path says no more of it than was known before",
        }[self.verdict]
        return f"{number}: {remark}."


def identified(posterior: Posterior, index: int) -> Parameter:
    """Judge one parameter of a posterior."""
    suspect, values = posterior.suspects[index], posterior.values[:, index]
    low, median, high = np.quantile(values, [0.025, 0.5, 0.975])
    return Parameter(
        suspect=suspect,
        median=float(median),
        low=float(low),
        high=float(high),
        width_ratio=float(values.std() / suspect.sigma),
        median_share=float(np.median(posterior.points[:, index])),
    )
