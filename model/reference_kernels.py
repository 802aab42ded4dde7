"""The element routine in plain NumPy, written from the formulas, against which the kernels are tested."""

from __future__ import annotations

import numpy as np

from .elements import FloatArray

_VOIGT = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])


def reference_element_tangent(
    *,
    gradients: FloatArray,
    volumes: FloatArray,
    modes: FloatArray,
    F: FloatArray,
    stress: FloatArray,
    moduli: FloatArray,
    pressure: FloatArray,
    bulk_modulus_MPa: float,
) -> FloatArray:
    """Return one element's condensed tangent.

    K = ∫ ∇N · (c + τ⊗1 + pJ(1⊗1 − 1⊠1)) · ∇N dV + κ Σ b⊗b, with b = ∫ ψ J ∇N dV for each pressure mode ψ.

    Parameters
    ----------
    gradients : array, shape (n_points, 3, n_nodes)
        In undeformed coordinates.
    volumes : array, shape (n_points,)
    modes : array, shape (n_points, n_modes)
    F : array, shape (n_points, 3, 3)
    stress : array, shape (n_points, 6)
        Isochoric Kirchhoff stress.
    moduli : array, shape (n_points, 6, 6)
        Isochoric spatial moduli.
    pressure : array, shape (n_modes,)
    bulk_modulus_MPa : float

    Returns
    -------
    array, shape (3, n_nodes, 3, n_nodes)
    """
    J = np.linalg.det(F)
    spatial = np.einsum("qji,qja->qia", np.linalg.inv(F), gradients)
    identity = np.eye(3)
    full = moduli[:, _VOIGT[:, :, None, None], _VOIGT[None, None, :, :]]
    full = full + np.einsum("ij,qrs->qirjs", identity, stress[:, _VOIGT])
    volumetric = np.einsum("ir,js->irjs", identity, identity) - np.einsum("is,jr->irjs", identity, identity)
    full = full + np.einsum("q,irjs->qirjs", J * (modes @ pressure), volumetric)
    tangent = np.einsum("q,qra,qirjs,qsb->iajb", volumes, spatial, full, spatial, optimize=True)
    operator = np.einsum("q,qm,qia->mia", volumes * J, modes, spatial)
    return tangent + bulk_modulus_MPa * np.einsum("mia,mjb->iajb", operator, operator)
