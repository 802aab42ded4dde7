"""Comparison error against validation uncertainty, pressure by pressure (ASME V&V 20-2009)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spavision.tip_path import FloatArray

from .discrepancy import Discrepancy

COVERAGE = 2.0
"""Factor from standard to expanded uncertainty, about 95 % for a normal distribution (V&V 20, section 6)."""


@dataclass(frozen=True)
class Validation:
    """One displacement component's comparison error with the uncertainty that it must be seen against.

    ``u_val² = u_num² + u_input² + u_D²``. A part that nobody has estimated is taken as zero and named in
    `left_out` or `left_out_in_part`: the uncertainty is then a lower bound, and a difference called
    significant might not be.

    Parameters
    ----------
    error_mm : array, shape (n,)
        E = S − D.
    u_num_mm, u_input_mm, u_data_mm : array, shape (n,)
        Standard uncertainties from the mesh, from the model's inputs and of the measurement; NaN where not
        estimated.
    """

    error_mm: FloatArray
    u_num_mm: FloatArray
    u_input_mm: FloatArray
    u_data_mm: FloatArray

    @property
    def u_val_mm(self) -> FloatArray:
        """Standard validation uncertainty, of the parts that are known, shape (n,)."""
        return np.sqrt(np.sum([np.nan_to_num(part) ** 2 for part in self._parts.values()], axis=0))

    @property
    def left_out(self) -> tuple[str, ...]:
        """Parts that are estimated nowhere."""
        return tuple(name for name, part in self._parts.items() if not np.isfinite(part).any())

    @property
    def left_out_in_part(self) -> tuple[str, ...]:
        """Parts that are estimated, but not wherever there is an error."""
        compared = np.isfinite(self.error_mm)
        lacking = (name for name, part in self._parts.items() if np.isnan(part[compared]).any())
        return tuple(name for name in lacking if name not in self.left_out)

    @property
    def _parts(self) -> dict[str, FloatArray]:
        return {"mesh": self.u_num_mm, "inputs": self.u_input_mm, "measurement": self.u_data_mm}

    @property
    def is_significant(self) -> NDArray[np.bool_]:
        """Where the error exceeds the expanded uncertainty: the model is wrong there, shape (n,)."""
        return np.abs(self.error_mm) > COVERAGE * self.u_val_mm


@dataclass(frozen=True)
class ModelUncertainty:
    """Standard uncertainties of the modelled displacement, one entry a pressure; None where not estimated.

    Parameters
    ----------
    mesh_x_mm, mesh_y_mm : array, shape (n,), or None
        From mesh refinement, u_num.
    inputs_x_mm, inputs_y_mm : array, shape (n,), or None
        From tolerances and material scatter, u_input.
    """

    mesh_x_mm: FloatArray | None = None
    mesh_y_mm: FloatArray | None = None
    inputs_x_mm: FloatArray | None = None
    inputs_y_mm: FloatArray | None = None


def validate(discrepancy: Discrepancy, model: ModelUncertainty) -> tuple[Validation, Validation]:
    """Set the comparison errors of x and y against their uncertainties.

    Parameters
    ----------
    discrepancy : Discrepancy
    model : ModelUncertainty

    Returns
    -------
    x, y : Validation
    """
    measured = discrepancy.measured
    x = _validation(discrepancy.error_ux_mm, model.mesh_x_mm, model.inputs_x_mm, measured.sigma_ux_mm)
    y = _validation(discrepancy.error_uy_mm, model.mesh_y_mm, model.inputs_y_mm, measured.sigma_uy_mm)
    return x, y


def _validation(
    error_mm: FloatArray, mesh_mm: FloatArray | None, inputs_mm: FloatArray | None, data_mm: FloatArray
) -> Validation:
    unknown = np.full_like(error_mm, np.nan)
    return Validation(
        error_mm,
        unknown if mesh_mm is None else mesh_mm,
        unknown if inputs_mm is None else inputs_mm,
        data_mm,
    )
