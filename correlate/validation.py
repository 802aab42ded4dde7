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
    `left_out`: the uncertainty is then a lower bound, and a difference called significant might not be.

    Parameters
    ----------
    error_mm : array, shape (n,)
        E = S − D.
    u_num_mm, u_input_mm, u_data_mm : array, shape (n,)
        Standard uncertainties from the mesh, from the model's inputs and of the measurement.
    left_out : tuple of str
        Parts that are not estimated.
    """

    error_mm: FloatArray
    u_num_mm: FloatArray
    u_input_mm: FloatArray
    u_data_mm: FloatArray
    left_out: tuple[str, ...]

    @property
    def u_val_mm(self) -> FloatArray:
        """Standard validation uncertainty, shape (n,)."""
        return np.sqrt(self.u_num_mm**2 + self.u_input_mm**2 + self.u_data_mm**2)

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
    parts = {"mesh": mesh_mm, "inputs": inputs_mm, "measurement": data_mm}
    estimated = {name: part for name, part in parts.items() if part is not None and np.any(np.isfinite(part))}
    nothing = np.zeros_like(error_mm)
    return Validation(
        error_mm,
        estimated.get("mesh", nothing),
        estimated.get("inputs", nothing),
        estimated.get("measurement", nothing),
        left_out=tuple(name for name in parts if name not in estimated),
    )
