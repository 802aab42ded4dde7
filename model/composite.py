"""The crimped-paper composite of region A: soft matrix and a paper layer that is slack at first."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from spavision.errors import InputError

from .materials.slack_fibre import SlackFibre
from .materials.solid import SolidMaterial

CRIMP_RATIO_RANGE = (0.1, 0.4)
"""Crimp ratios for which the assumptions below are meant."""

_STRAIGHT_PAPER_TRANSITION = 0.02
"""Strain over which paper without crimp becomes taut: small, to keep the tension's slope continuous."""


@dataclass(frozen=True)
class PaperLayer:
    """How the crimped paper acts in the composite. All of it is assumed unless a source is given.

    The paper (80 g/m² bond, 0.10 mm thick, 2000 to 7000 MPa by different sources) taken over the
    composite's 5 mm would be 40 to 140 MPa when straight. Against silicones of some 0.1 MPa that is as good
    as inextensible, and so are the lower values below, with which Newton's method converges faster.

    Parameters
    ----------
    transition_factor : float
        Strain at which the composite becomes stiff over the strain that straightens a triangular wave;
        0.690 from the one published transition (38.8 % at crimp ratio 0.3), assumed for the others.
    length_modulus_MPa : float
        Stiffness along the actuator once taut.
    transition_half_width : float
        Half the range of strain over which the paper becomes taut: folds straighten one after another.
        Never more than the slack strain, so that the paper is slack at rest.
    width_modulus_MPa : float
        Stiffness in tension across the width, along the folds, from the start.
    """

    transition_factor: float = 0.690
    length_modulus_MPa: float = 10.0
    transition_half_width: float = 0.1
    width_modulus_MPa: float = 10.0

    def slack_strain(self, crimp_ratio: float) -> float:
        """Return the strain at which the paper becomes taut.

        The path along a triangular wave of amplitude A (mid-line to peak) and wavelength λ is
        √(1 + 16 CR²) per unit length, with the crimp ratio CR = A/λ.

        Raises
        ------
        InputError
            If the crimp ratio is outside `CRIMP_RATIO_RANGE`.
        """
        low, high = CRIMP_RATIO_RANGE
        if not low <= crimp_ratio <= high:
            raise InputError(f"crimp ratio is {crimp_ratio:g}, expected {low:g} to {high:g}")
        return self.transition_factor * float(np.sqrt(1.0 + 16.0 * crimp_ratio**2) - 1.0)


def crimped_composite(matrix: SolidMaterial, *, crimp_ratio: float, paper: PaperLayer) -> SolidMaterial:
    """Return the matrix with the paper's two fibre families, along the length (y) and across the width (z).

    Raises
    ------
    InputError
        If the crimp ratio is out of range.
    """
    slack_strain = paper.slack_strain(crimp_ratio)
    along = SlackFibre(
        direction=(0.0, 1.0, 0.0),
        modulus_MPa=paper.length_modulus_MPa,
        slack_strain=slack_strain,
        transition_half_width=min(paper.transition_half_width, slack_strain),
    )
    across = SlackFibre(
        direction=(0.0, 0.0, 1.0),
        modulus_MPa=paper.width_modulus_MPa,
        slack_strain=_STRAIGHT_PAPER_TRANSITION,
        transition_half_width=_STRAIGHT_PAPER_TRANSITION,
    )
    return replace(matrix, fibres=(*matrix.fibres, along, across))
