"""Slack fibres at the Gauss points, linearised where Newton's method converges fastest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .elements import FloatArray, IntArray
from .materials.slack_fibre import SlackFibre
from .stress_kernels import add_fibre

_DUAL_STIFFNESS = 0.04
"""Fraction of its modulus above which a fibre is linearised at its tension, below it at its stretch."""

_AGREEMENT = 1e-4
"""Stretches this close are one: near convergence the law is linearised where it is evaluated."""

_INVERSION_STEPS = 12
"""Enough for the stretches above the threshold; those below are not used."""


@dataclass(frozen=True)
class FibreResponse:
    """One family's fibres at the Gauss points of its elements, each array (n_elements, n_points).

    Parameters
    ----------
    direction : array, shape (n_elements, n_points, 3)
        Deformed fibre vectors.
    stretch : array
        Their lengths.
    tension, stiffness : array
        Nominal tension at that stretch, and slope, of the tangent to the law at the point of linearisation.
    """

    direction: FloatArray
    stretch: FloatArray
    tension: FloatArray
    stiffness: FloatArray


@dataclass(frozen=True)
class FibreFamily:
    """The fibres of one family, the elements that they run through and their response there.

    Parameters
    ----------
    fibre : SlackFibre
    elements : array, shape (n,)
    response : FibreResponse
    """

    fibre: SlackFibre
    elements: IntArray
    response: FibreResponse

    def tension_change(self, change_of_F: FloatArray) -> FloatArray:
        """Return the linear change of the tension, shape (n, n_points).

        Parameters
        ----------
        change_of_F : array, shape (n, n_points, 3, 3)
            Change of the deformation gradient in the family's elements.
        """
        moved = change_of_F @ np.asarray(self.fibre.direction)
        along = np.einsum("eqi,eqi->eq", self.response.direction, moved) / self.response.stretch
        return self.response.stiffness * along


def fibre_response(fibre: SlackFibre, F: FloatArray, tension: FloatArray | None) -> FibreResponse:
    """Linearise a family of fibres.

    The law hardens by orders of magnitude within a few per cent of strain. Linearised at the stretch that an
    iteration predicts, it overshoots; linearised at the stretch that belongs to the *tension* predicted, it
    does not (Magisano, Leonetti and Garcea, Int. J. Numer. Meth. Eng. 109 (2017) 1237-1262, for the idea of
    iterating in stresses). Where the fibre is too slack for the tension to tell the stretch, the latter is
    used. Both coincide at convergence.

    Parameters
    ----------
    fibre : SlackFibre
    F : array, shape (n_elements, n_points, 3, 3)
        Deformation gradients.
    tension : array, shape (n_elements, n_points), or None
        Tension predicted by the last iteration; None takes the law's own.
    """
    direction = F @ np.asarray(fibre.direction)
    stretch = np.sqrt(np.einsum("eqi,eqi->eq", direction, direction))
    if tension is None:
        return FibreResponse(direction, stretch, fibre.tension(stretch), fibre.stiffness(stretch))
    threshold = _dual_stretch(fibre)
    of_tension = _stretch_at(fibre, tension)
    point = np.where(of_tension > threshold, of_tension, np.minimum(stretch, threshold))
    point = np.where(np.abs(point - stretch) < _AGREEMENT, stretch, point)
    stiffness = fibre.stiffness(point)
    return FibreResponse(direction, stretch, fibre.tension(point) + stiffness * (stretch - point), stiffness)


def add_fibres(family: FibreFamily, stress: FloatArray, moduli: FloatArray) -> None:
    """Add a family's share to all elements' Kirchhoff stress, (n_elements, n_points, 6), and moduli."""
    response = family.response
    per_stretch = response.tension / response.stretch
    curvature = (response.stiffness - per_stretch) / response.stretch**2
    add_fibre(family.elements, response.direction, per_stretch, curvature, stress, moduli)


def _stretch_at(fibre: SlackFibre, tension: FloatArray) -> FloatArray:
    """Invert the convex law by Newton's method from its stiff side; the slack limit where there is none."""
    slack = 1.0 + fibre.slack_strain - fibre.transition_half_width
    stretch = np.full(tension.shape, slack)
    taut = tension > 0.0
    wanted = tension[taut]
    trial = slack + 2.0 * fibre.transition_half_width + wanted / max(fibre.modulus_MPa, 1e-300)
    for _ in range(_INVERSION_STEPS):
        trial = trial - (fibre.tension(trial) - wanted) / np.maximum(fibre.stiffness(trial), 1e-300)
    stretch[taut] = trial
    return stretch


def _dual_stretch(fibre: SlackFibre) -> float:
    """Stretch at which the stiffness is `_DUAL_STIFFNESS` of the modulus."""
    begin = 1.0 + fibre.slack_strain - fibre.transition_half_width
    stretches = np.linspace(begin, begin + 2.0 * fibre.transition_half_width, 1001)
    stiffness = fibre.stiffness(stretches)
    return float(np.interp(_DUAL_STIFFNESS * fibre.modulus_MPa, stiffness, stretches))
