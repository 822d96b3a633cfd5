"""Hermite bending and St-Venant torsion elements of a straight beam with stiffness that varies along it.

Degrees of freedom of an element between the nodes a and b: (w_a, w'_a, φ_a, w_b, w'_b, φ_b), w the deflection (m), w'
its slope, φ the twist (rad). Bending is Euler-Bernoulli with cubic Hermite shape functions, torsion is linear: bending
and torsion do not couple. Sources: any text on finite elements, Bathe (1996) *Finite element procedures* for one.
"""

from __future__ import annotations

from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]

DOFS_PER_NODE: Final = 3
_BENDING: Final = (0, 1, 3, 4)
_TORSION: Final = (2, 5)
# four points integrate the square of a cubic times a linear density (degree 7) exactly
_POINT, _WEIGHT = np.polynomial.legendre.leggauss(4)
GAUSS_POINTS: Final[FloatArray] = (1.0 + _POINT) / 2.0
GAUSS_WEIGHTS: Final[FloatArray] = _WEIGHT / 2.0


def deflection_shape(local: npt.ArrayLike, length: npt.ArrayLike) -> FloatArray:
    """Shape functions of the deflection at the local coordinate 0 ≤ ζ ≤ 1 of elements of that length: (…, 6)."""
    z, h = np.broadcast_arrays(np.asarray(local, float), np.asarray(length, float))
    shape = np.zeros((*z.shape, 6))
    shape[..., 0] = (1.0 - z) ** 2 * (1.0 + 2.0 * z)
    shape[..., 1] = h * z * (1.0 - z) ** 2
    shape[..., 3] = z**2 * (3.0 - 2.0 * z)
    shape[..., 4] = h * z**2 * (z - 1.0)
    return shape


def slope_shape(local: npt.ArrayLike, length: npt.ArrayLike) -> FloatArray:
    """Derivative of `deflection_shape` along the beam (1/m): (…, 6)."""
    z, h = np.broadcast_arrays(np.asarray(local, float), np.asarray(length, float))
    shape = np.zeros((*z.shape, 6))
    shape[..., 0] = -6.0 * z * (1.0 - z) / h
    shape[..., 1] = (1.0 - z) * (1.0 - 3.0 * z)
    shape[..., 3] = 6.0 * z * (1.0 - z) / h
    shape[..., 4] = z * (3.0 * z - 2.0)
    return shape


def twist_shape(local: npt.ArrayLike) -> FloatArray:
    """Shape functions of the twist at the local coordinate 0 ≤ ζ ≤ 1: (…, 6)."""
    z = np.asarray(local, float)
    shape = np.zeros((*z.shape, 6))
    shape[..., 2] = 1.0 - z
    shape[..., 5] = z
    return shape


def curvature_shape(local: npt.ArrayLike, length: npt.ArrayLike) -> FloatArray:
    """Second derivative of `deflection_shape` along the beam (1/m²): (…, 6)."""
    z, h = np.broadcast_arrays(np.asarray(local, float), np.asarray(length, float))
    shape = np.zeros((*z.shape, 6))
    shape[..., 0] = (12.0 * z - 6.0) / h**2
    shape[..., 1] = (6.0 * z - 4.0) / h
    shape[..., 3] = (6.0 - 12.0 * z) / h**2
    shape[..., 4] = (6.0 * z - 2.0) / h
    return shape


def stiffness_matrices(
    length: FloatArray, bending_stiffness: FloatArray, torsional_stiffness: FloatArray
) -> FloatArray:
    """Stiffness matrices of the elements: (n, 6, 6).

    Parameters
    ----------
    length
        (n,) m, > 0.
    bending_stiffness, torsional_stiffness
        (n, 4) EI and GJ (N m²) at the `GAUSS_POINTS` of each element.
    """
    curvature = curvature_shape(GAUSS_POINTS[None, :], length[:, None])
    rate = np.zeros((len(length), 6))
    rate[:, 2], rate[:, 5] = -1.0 / length, 1.0 / length
    bending = np.einsum("g,n,ng,ngi,ngj->nij", GAUSS_WEIGHTS, length, bending_stiffness, curvature, curvature)
    torsion = np.einsum("g,n,ng,ni,nj->nij", GAUSS_WEIGHTS, length, torsional_stiffness, rate, rate)
    return np.asarray(bending + torsion)


def mass_matrices(
    length: FloatArray, mass_per_length: FloatArray, torsional_inertia_per_length: FloatArray
) -> FloatArray:
    """Consistent mass matrices of the elements: (n, 6, 6).

    Parameters
    ----------
    length
        (n,) m, > 0.
    mass_per_length, torsional_inertia_per_length
        (n, 4) kg/m and kg m at the `GAUSS_POINTS` of each element.
    """
    deflection = deflection_shape(GAUSS_POINTS[None, :], length[:, None])
    twist = twist_shape(GAUSS_POINTS)
    bending = np.einsum("g,n,ng,ngi,ngj->nij", GAUSS_WEIGHTS, length, mass_per_length, deflection, deflection)
    torsion = np.einsum("g,n,ng,gi,gj->nij", GAUSS_WEIGHTS, length, torsional_inertia_per_length, twist, twist)
    return np.asarray(bending + torsion)
