"""A law made stiffer as a whole."""

from __future__ import annotations

import numpy as np
import pytest

from spavision.model.materials.library import all_materials
from spavision.model.materials.stiffness import stiffened


@pytest.mark.parametrize("name", list(all_materials()))
def test_energy_of_every_law_is_proportional_to_the_factor(name: str) -> None:
    """By definition; the factor changes stresses alone, not the shape of the curve."""
    law = all_materials()[name].law
    log_stretch = np.log([[1.4, 1.0, 1.0 / 1.4], [0.8, 1.1, 1.0 / 0.88]])
    np.testing.assert_allclose(
        stiffened(law, 1.7).energy(log_stretch), 1.7 * law.energy(log_stretch), rtol=1e-12
    )
