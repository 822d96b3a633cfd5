"""Cutting of snow by an edge after machining theory (Eqn 10)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray


def cutting_stress(
    dynamic_shear_strength: npt.ArrayLike, edge_angle: npt.ArrayLike, *, transverse_friction: float
) -> FloatArray:
    """Tangential stress F_t/(L e) = 2 S cot((ϑ - β)/2), β = arctan μ_t (Eqn 10 of Mössner and others 2013).

    dynamic_shear_strength: S (N/m²).
    edge_angle: ϑ (rad), β < ϑ ≤ π/2. At and below β the theory has no shear plane: NaN.
    transverse_friction: μ_t ≥ 0, the dynamic friction transverse to the ski.

    Merchant's theory with the shear plane at φ = (ϑ - β)/2 to the snow surface. A vertical blade without friction has
    F_t/(L e) = 2 S. The paper did not find this dependence in the failure shear stress of groomed snow.

    >>> import math
    >>> round(float(cutting_stress(0.0172, math.pi / 2, transverse_friction=0.0)), 4)
    0.0344
    """
    S, half = np.asarray(dynamic_shear_strength, float), _shear_plane(edge_angle, transverse_friction)
    result: FloatArray = 2.0 * S / np.tan(half)
    return result


def cutting_thrust(
    dynamic_shear_strength: npt.ArrayLike, edge_angle: npt.ArrayLike, *, transverse_friction: float
) -> FloatArray:
    """Normal stress of the same cut, F_n/(L e) = S (cot²φ - 1), φ = (ϑ - β)/2, which the paper does not print (N/m²).

    >>> import math
    >>> round(float(cutting_thrust(1.0, math.pi / 2, transverse_friction=0.0)), 12)
    0.0
    """
    S, half = np.asarray(dynamic_shear_strength, float), _shear_plane(edge_angle, transverse_friction)
    result: FloatArray = S * (1.0 / np.tan(half) ** 2 - 1.0)
    return result


def _shear_plane(edge_angle: npt.ArrayLike, transverse_friction: float) -> FloatArray:
    plane = (np.asarray(edge_angle, float) - np.arctan(transverse_friction)) / 2.0
    return np.where(plane > 0, plane, np.nan)
