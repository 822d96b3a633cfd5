"""Snow pressure across one section of the base, integrated in closed form.

Across the ski the depth of the base and the depth of the groove are straight lines between break points, and the
pressure law is piecewise linear, so the force per length of ski is exact: no points across the ski, no error at the
waterline.

The point law (hypoplastic): p = H_V ε on virgin snow, ε ≥ g, with g the deepest this place has ever been pushed;
p = max(0, H_V g - k_u (g - ε)) in the groove. Both in one line: p = max(0, H_V ε - (k_u - H_V) max(g - ε, 0)).
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled

FloatArray: TypeAlias = npt.NDArray[np.float64]

SUMS = 8
"""Length of the array that `add_interval` fills; see there."""


@compiled(error_model="numpy", inline="always")
def _add_linear(
    sums: FloatArray, start: float, length: float, p0: float, p1: float, by_depth: float, by_groove: float
) -> None:
    """Add the part of a linear pressure that is above zero: from p0 at `start` to p1 at `start` + `length`."""
    if p0 <= 0.0 and p1 <= 0.0:
        return
    low, high = 0.0, length
    if p0 < 0.0:
        low = length * p0 / (p0 - p1)
        p0 = 0.0
    elif p1 < 0.0:
        high = length * p0 / (p0 - p1)
        p1 = 0.0
    x, h = start + low, high - low
    force = 0.5 * h * (p0 + p1)
    sums[0] += force
    sums[1] += x * force + h * h * (p0 + 2.0 * p1) / 6.0
    s0, s1, s2 = h, h * (x + 0.5 * h), h * (x * x + x * h + h * h / 3.0)
    sums[2] += by_depth * s0
    sums[3] += by_depth * s1
    sums[4] += by_depth * s2
    sums[5] += by_groove * s0
    sums[6] += by_groove * s1
    sums[7] += by_groove * s2


@compiled(error_model="numpy")
def add_interval(
    sums: FloatArray,
    start: float,
    length: float,
    depth0: float,
    depth1: float,
    groove0: float,
    groove1: float,
    hardness: float,
    excess: float,
) -> None:
    """Add an interval across the ski on which the depths of base and groove are straight lines.

    Parameters
    ----------
    sums
        (8,): ∫p dξ, ∫p ξ dξ; ∫∂p/∂ε ξⁿ dξ for n = 0, 1, 2; ∫∂p/∂g ξⁿ dξ for n = 0, 1, 2. Filled in place.
    start, length
        The interval of ξ (m), the distance from the edge in the snow surface.
    depth0, depth1, groove0, groove1
        ε and g (m) at both ends, below the undisturbed surface; negative: above it.
    hardness, excess
        H_V and k_u - H_V (N/m³).
    """
    lift0, lift1 = groove0 - depth0, groove1 - depth1
    unloading = hardness + excess
    if lift0 <= 0.0 and lift1 <= 0.0:
        _add_linear(sums, start, length, hardness * depth0, hardness * depth1, hardness, 0.0)
    elif lift0 >= 0.0 and lift1 >= 0.0:
        p0, p1 = hardness * depth0 - excess * lift0, hardness * depth1 - excess * lift1
        _add_linear(sums, start, length, p0, p1, unloading, -excess)
    else:
        share = lift0 / (lift0 - lift1)
        first = share * length
        middle = hardness * (depth0 + share * (depth1 - depth0))
        p0, p1 = hardness * depth0 - excess * max(lift0, 0.0), hardness * depth1 - excess * max(lift1, 0.0)
        if lift0 > 0.0:
            _add_linear(sums, start, first, p0, middle, unloading, -excess)
            _add_linear(sums, start + first, length - first, middle, p1, hardness, 0.0)
        else:
            _add_linear(sums, start, first, p0, middle, hardness, 0.0)
            _add_linear(sums, start + first, length - first, middle, p1, unloading, -excess)
