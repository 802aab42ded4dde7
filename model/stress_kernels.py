"""Numba kernels from deformation to Kirchhoff stress and spatial moduli at the Gauss points.

Symmetric tensors are stored as six numbers in the order 11, 22, 33, 12, 23, 13.
"""

from __future__ import annotations

import numpy as np
from numba import njit, prange

from .elements import FloatArray, IntArray

COALESCENCE = 1e-5
"""Log stretches closer than this are taken as equal in the moduli, an error of its square."""

_SWEEPS = 12
_NEGLIGIBLE = 1e-13
"""Off-diagonal parts that are left over; their effect on the stress is of their order."""
_FAST = {"contract", "reassoc", "nsz", "arcp"}


@njit(cache=True)
def symmetric_eigen(matrix: FloatArray, vectors: FloatArray) -> None:
    """Diagonalise a symmetric 3×3 matrix in place by Jacobi's rotations.

    On return the diagonal of `matrix` holds the eigenvalues and the columns of `vectors` the
    eigenvectors. Exact for equal eigenvalues too, which closed formulas are not. All is kept in single
    variables, and so in the processor's registers: this is most of what the kinematics cost.
    """
    a00, a11, a22 = matrix[0, 0], matrix[1, 1], matrix[2, 2]
    a01, a12, a02 = matrix[0, 1], matrix[1, 2], matrix[0, 2]
    v00, v01, v02 = 1.0, 0.0, 0.0
    v10, v11, v12 = 0.0, 1.0, 0.0
    v20, v21, v22 = 0.0, 0.0, 1.0
    negligible = _NEGLIGIBLE * (abs(a00) + abs(a11) + abs(a22))
    for _ in range(_SWEEPS):
        if abs(a01) + abs(a02) + abs(a12) < negligible:
            break
        tangent, cosine, sine = _rotation(a00, a11, a01)
        a00, a11, a01 = a00 - tangent * a01, a11 + tangent * a01, 0.0
        a02, a12 = _turned(a02, a12, cosine, sine)
        v00, v01 = _turned(v00, v01, cosine, sine)
        v10, v11 = _turned(v10, v11, cosine, sine)
        v20, v21 = _turned(v20, v21, cosine, sine)
        tangent, cosine, sine = _rotation(a00, a22, a02)
        a00, a22, a02 = a00 - tangent * a02, a22 + tangent * a02, 0.0
        a01, a12 = _turned(a01, a12, cosine, sine)
        v00, v02 = _turned(v00, v02, cosine, sine)
        v10, v12 = _turned(v10, v12, cosine, sine)
        v20, v22 = _turned(v20, v22, cosine, sine)
        tangent, cosine, sine = _rotation(a11, a22, a12)
        a11, a22, a12 = a11 - tangent * a12, a22 + tangent * a12, 0.0
        a01, a02 = _turned(a01, a02, cosine, sine)
        v01, v02 = _turned(v01, v02, cosine, sine)
        v11, v12 = _turned(v11, v12, cosine, sine)
        v21, v22 = _turned(v21, v22, cosine, sine)
    matrix[0, 0], matrix[1, 1], matrix[2, 2] = a00, a11, a22
    matrix[0, 1], matrix[1, 2], matrix[0, 2] = a01, a12, a02
    matrix[1, 0], matrix[2, 1], matrix[2, 0] = a01, a12, a02
    vectors[0, 0], vectors[0, 1], vectors[0, 2] = v00, v01, v02
    vectors[1, 0], vectors[1, 1], vectors[1, 2] = v10, v11, v12
    vectors[2, 0], vectors[2, 1], vectors[2, 2] = v20, v21, v22


@njit(cache=True)
def _rotation(first: float, second: float, between: float) -> tuple[float, float, float]:
    """Tangent, cosine and sine of the rotation that annihilates an entry between two diagonal ones."""
    if between == 0.0:
        return 0.0, 1.0, 0.0
    half = 0.5 * (second - first)
    length = np.sqrt(half * half + between * between)
    tangent = between / (half + length if half >= 0.0 else half - length)
    cosine = 1.0 / np.sqrt(tangent * tangent + 1.0)
    return tangent, cosine, tangent * cosine


@njit(cache=True)
def _turned(low: float, high: float, cosine: float, sine: float) -> tuple[float, float]:
    """Rotate a pair."""
    return cosine * low - sine * high, sine * low + cosine * high


@njit(cache=True, parallel=True, fastmath=_FAST)
def deformation(
    displacement: FloatArray,
    elements: IntArray,
    gradients: FloatArray,
    F: FloatArray,
    J: FloatArray,
    log_stretch: FloatArray,
    directions: FloatArray,
) -> None:
    """Compute deformation gradient, volume ratio, principal log stretches and spatial directions.

    Parameters
    ----------
    displacement : array, shape (n_nodes, 3)
    elements : array, shape (n_elements, n_element_nodes)
    gradients : array, shape (n_elements, n_points, 3, n_element_nodes)
    F : array, shape (n_elements, n_points, 3, 3)
        Written, like those below.
    J : array, shape (n_elements, n_points)
    log_stretch : array, shape (n_elements, n_points, 3)
        Of the whole deformation, not of its isochoric part.
    directions : array, shape (n_elements, n_points, 3, 3)
        Column i belongs to stretch i.
    """
    n_elements, n_points, _, n_nodes = gradients.shape
    for e in prange(n_elements):
        local = np.empty((3, n_nodes))
        b = np.empty((3, 3))
        for a in range(n_nodes):
            for i in range(3):
                local[i, a] = displacement[elements[e, a], i]
        for q in range(n_points):
            f = F[e, q]
            for i in range(3):
                for j in range(3):
                    total = 1.0 if i == j else 0.0
                    for a in range(n_nodes):
                        total += local[i, a] * gradients[e, q, j, a]
                    f[i, j] = total
            J[e, q] = (
                f[0, 0] * (f[1, 1] * f[2, 2] - f[1, 2] * f[2, 1])
                - f[0, 1] * (f[1, 0] * f[2, 2] - f[1, 2] * f[2, 0])
                + f[0, 2] * (f[1, 0] * f[2, 1] - f[1, 1] * f[2, 0])
            )
            for i in range(3):
                for j in range(3):
                    b[i, j] = f[i, 0] * f[j, 0] + f[i, 1] * f[j, 1] + f[i, 2] * f[j, 2]
            symmetric_eigen(b, directions[e, q])
            for i in range(3):
                log_stretch[e, q, i] = 0.5 * np.log(max(b[i, i], 1e-300))


@njit(cache=True, parallel=True, fastmath=_FAST)
def principal_stress(
    elements: IntArray, directions: FloatArray, first: FloatArray, stress: FloatArray
) -> None:
    """Assemble the isochoric Kirchhoff stress from the law's first derivatives.

    Parameters
    ----------
    elements : array, shape (n,)
        Those to assemble it for.
    directions : array, shape (n_elements, n_points, 3, 3)
    first : array, shape (n, n_points, 3)
        Derivatives of the energy with respect to the isochoric log stretches.
    stress : array, shape (n_elements, n_points, 6)
        Written.
    """
    for n in prange(len(elements)):
        for q in range(first.shape[1]):
            f, v, s = first[n, q], directions[elements[n], q], stress[elements[n], q]
            mean = (f[0] + f[1] + f[2]) / 3.0
            for i in range(3):
                j = (i + 1) % 3
                s[i] = 0.0
                s[3 + i] = 0.0
                for k in range(3):
                    s[i] += (f[k] - mean) * v[i, k] * v[i, k]
                    # 12, 23, 31 in turn: the places of 12, 23, 13
                    s[3 + i] += (f[k] - mean) * v[i, k] * v[j, k]


@njit(cache=True, parallel=True, fastmath=_FAST)
def principal_moduli(
    elements: IntArray,
    directions: FloatArray,
    log_stretch: FloatArray,
    first: FloatArray,
    second: FloatArray,
    moduli: FloatArray,
) -> None:
    r"""Assemble the isochoric spatial moduli (Lie derivative of the Kirchhoff stress).

    .. math:: c = \sum_{ij} (H_{ij} - 2\tau_i\delta_{ij})\,m_{ii}\otimes m_{jj}
              + \sum_{i<j} 4\,\frac{\tau_i\lambda_j^2-\tau_j\lambda_i^2}{\lambda_i^2-\lambda_j^2}
              \,m_{ij}\otimes m_{ij}

    with :math:`m_{ij}` the symmetric dyads of the principal directions, and the limit
    :math:`(H_{ii}-H_{ij})/2-\tau_i` for equal stretches.

    Parameters
    ----------
    elements : array, shape (n,)
        Those to assemble them for.
    directions : array, shape (n_elements, n_points, 3, 3)
    log_stretch : array, shape (n_elements, n_points, 3)
    first, second : array, shape (n, n_points, 3) and (n, n_points, 3, 3)
        The law's derivatives with respect to the isochoric log stretches.
    moduli : array, shape (n_elements, n_points, 6, 6)
        Written.
    """
    for n in prange(len(elements)):
        e = elements[n]
        scratch = np.empty((16, 6))
        for q in range(first.shape[1]):
            _principal_moduli(
                directions[e, q], log_stretch[e, q], first[n, q], second[n, q], scratch, moduli[e, q]
            )


@njit(cache=True, fastmath=_FAST)
def _principal_moduli(
    v: FloatArray,
    log_stretch: FloatArray,
    first: FloatArray,
    second: FloatArray,
    scratch: FloatArray,
    moduli: FloatArray,
) -> None:
    """Assemble the moduli at one point."""
    dyads, products, hessian, tau = scratch[:6], scratch[6:12], scratch[12:15], scratch[15]
    mean = (first[0] + first[1] + first[2]) / 3.0
    grand = 0.0
    for i in range(3):
        tau[i] = first[i] - mean
        for j in range(3):
            grand += second[i, j] / 9.0
    for i in range(3):
        row = (second[i, 0] + second[i, 1] + second[i, 2]) / 3.0
        for j in range(3):
            column = (second[0, j] + second[1, j] + second[2, j]) / 3.0
            hessian[i, j] = second[i, j] - row - column + grand
    for k in range(6):
        p, q = k % 3, (k % 3 + k // 3) % 3
        for i in range(3):
            j = (i + 1) % 3
            dyads[k, i] = v[i, p] * v[i, q]
            dyads[k, 3 + i] = 0.5 * (v[i, p] * v[j, q] + v[j, p] * v[i, q])
    for i in range(3):
        j = (i + 1) % 3
        gap = log_stretch[i] - log_stretch[j]
        if abs(gap) < COALESCENCE:
            shear = 0.25 * (hessian[i, i] + hessian[j, j]) - 0.5 * hessian[i, j] - 0.5 * (tau[i] + tau[j])
        else:
            ratio = np.exp(-2.0 * gap)
            shear = (tau[i] * ratio - tau[j]) / (1.0 - ratio)
        for s in range(6):
            products[i, s] = (
                hessian[i, 0] * dyads[0, s] + hessian[i, 1] * dyads[1, s] + hessian[i, 2] * dyads[2, s]
            ) - 2.0 * tau[i] * dyads[i, s]
            products[3 + i, s] = 4.0 * shear * dyads[3 + i, s]
    for r in range(6):
        for s in range(6):
            total = 0.0
            for k in range(6):
                total += dyads[k, r] * products[k, s]
            moduli[r, s] = total


@njit(cache=True, parallel=True, fastmath=_FAST)
def add_fibre(
    elements: IntArray,
    spatial_direction: FloatArray,
    stress_factor: FloatArray,
    moduli_factor: FloatArray,
    stress: FloatArray,
    moduli: FloatArray,
) -> None:
    """Add a fibre family: τ += s a⊗a and c += k a⊗a⊗a⊗a, with a = F·(undeformed direction).

    Parameters
    ----------
    elements : array, shape (n,)
        Those that the fibres run through.
    spatial_direction : array, shape (n, n_points, 3)
    stress_factor, moduli_factor : array, shape (n, n_points)
    stress : array, shape (n_elements, n_points, 6)
    moduli : array, shape (n_elements, n_points, 6, 6)
    """
    for n in prange(len(elements)):
        e = elements[n]
        for p in range(stress_factor.shape[1]):
            a = spatial_direction[n, p]
            for r in range(6):
                first = a[r % 3] * a[(r + r // 3) % 3]
                stress[e, p, r] += stress_factor[n, p] * first
                for s in range(6):
                    moduli[e, p, r, s] += moduli_factor[n, p] * first * a[s % 3] * a[(s + s // 3) % 3]
