"""A family of fibres that carries nothing until its slack is taken up."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class SlackFibre:
    """Fibres along one direction, slack up to a strain, stiff beyond it, with nothing in compression.

    With the stretch λ along the fibre and x = λ − 1 − slack strain, the fibre's nominal tension (force
    over undeformed area of the composite) has the slope ``modulus·s((x + w)/2w)``, where s is the cubic
    smooth step from 0 to 1 and w the half-width of the transition: nothing below x = −w, exactly
    ``modulus·x`` above x = w, and a twice continuously differentiable tension between.

    Parameters
    ----------
    direction : tuple of float
        Unit vector in the undeformed body.
    modulus_MPa : float
        Stiffness when taut, over the composite's whole section.
    slack_strain : float
        Engineering strain at which the fibre becomes taut.
    transition_half_width : float
        Half the range of strain over which it does so, at most the slack strain: no tension at rest.

    Raises
    ------
    ValueError
        If a number is out of its range or the direction is not a unit vector.
    """

    direction: tuple[float, float, float]
    modulus_MPa: float
    slack_strain: float
    transition_half_width: float

    def __post_init__(self) -> None:
        if not np.isclose(np.linalg.norm(self.direction), 1.0):
            raise ValueError(f"fibre direction {self.direction} is not a unit vector")
        if not (self.modulus_MPa >= 0.0 and 0.0 < self.transition_half_width <= self.slack_strain):
            raise ValueError(
                f"fibre modulus {self.modulus_MPa:g} MPa, slack strain {self.slack_strain:g} and transition "
                f"half-width {self.transition_half_width:g}: expected the modulus 0 or more, the half-width "
                "above 0 and at most the slack strain"
            )

    def energy(self, stretch: FloatArray) -> FloatArray:
        """Return the energy density in MPa for stretches λ of any shape."""
        x, w, t = self._excess(stretch)
        inside = 4.0 * w**2 * (t**4 / 4.0 - t**5 / 10.0)
        return self.modulus_MPa * np.where(x < w, inside, 0.5 * x**2 + 0.1 * w**2)

    def tension(self, stretch: FloatArray) -> FloatArray:
        """Return the nominal tension ∂W/∂λ in MPa."""
        x, w, t = self._excess(stretch)
        return self.modulus_MPa * np.where(x < w, 2.0 * w * (t**3 - 0.5 * t**4), x)

    def stiffness(self, stretch: FloatArray) -> FloatArray:
        """Return the slope ∂²W/∂λ² in MPa."""
        _, _, t = self._excess(stretch)
        return self.modulus_MPa * t**2 * (3.0 - 2.0 * t)

    def _excess(self, stretch: FloatArray) -> tuple[FloatArray, float, FloatArray]:
        x = np.asarray(stretch, dtype=float) - 1.0 - self.slack_strain
        w = self.transition_half_width
        return x, w, np.clip((x + w) / (2.0 * w), 0.0, 1.0)
