"""The snow's pressure on the sections of a ski that lie in it, integrated across in closed form.

Virgin snow bears q = H_V (depth + slope x), x from the edge that is down. Where a cell was pressed deeper by `lift`,
over a ≤ x ≤ b, it bears q - (k_u - H_V) lift, if that is above zero: over u ≤ x ≤ v. So all integrals come from those
of 1, x, x² over what is wet, u to v, less those over a to b, and of lift, lift x and lift² over u to v: nine sums over
a line's cells, four cells in one instruction of 256 bits, and then what they make, four lines in one.

A cell that was met in part bears as if met all over, as it will once the step is accepted. Were the ground that an edge
takes within a step virgin until then, its force would be off by the step's length times the lift beside it.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled

# isort: off
from .columns import (
    DEEP, EDGE_AT, EDGE_DEEP, FALLING, FORCE, L0, L1, L2, MOMENT, PER_FALL, Q0, Q1, Q2, SHARE, SPRING, STIFF0, STIFF1,
    STIFF2, V0, V1, V2, WATERLINE, WET_FROM, WET_TO,
)  # fmt: skip

# isort: on
from .compiled import PLAIN, SUMS
from .lines import CELLS, DEEPEST, ROUNDING

FloatArray: TypeAlias = npt.NDArray[np.float64]


@compiled(**PLAIN, fastmath=SUMS, inline="always")
def sum_cells(
    sheet: FloatArray, i: np.uint64, cells: FloatArray, row: np.uint64, start: int, cell: float, per_cell: float,
    ratio: float,
) -> None:  # fmt: skip
    """Fill the nine sums of line i over its cells that were pressed deeper; `ratio` is k_u/H_V - 1."""
    low, high, edge = sheet[WET_FROM + i], sheet[WET_TO + i], sheet[EDGE_AT + i]
    slope, waterline, per_fall = sheet[FALLING + i], sheet[WATERLINE + i], sheet[PER_FALL + i]
    per_lift, to_right = ratio * per_fall, per_fall > 0.0
    first = min(max(int(np.floor((low + edge) * per_cell)) - start, 0), CELLS) & ~7
    last = min(int(np.floor((high + edge) * per_cell)) - start, CELLS - 1) | 7
    half = 0.5 * cell
    origin = (start + 0.5) * cell - edge
    surface, step = sheet[EDGE_DEEP + i] + slope * origin, slope * cell
    # of xⁿ: over all that bears as virgin snow does, and over u to v; of lift × xⁿ over u to v; of lift²
    q0, q1, q2, w0, w1, w2, l0, l1, l2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    begin, end = np.uint64(first), np.uint64(max(last + 1, first))
    for j in range(begin, end):
        middle = origin + j * cell
        lift = cells[row, DEEPEST + j] - (surface + step * j)
        a = max(low, middle - half)
        b = max(a, min(high, middle + half))
        b = b if lift > ROUNDING else a
        zero = min(max(waterline + per_lift * lift, a), b)
        u, v = zero if to_right else a, b if to_right else zero
        width, covered, both, ends = v - u, b - a, v + u, b + a
        first_moment, second = width * both, width * (both * both - u * v)
        raised = lift * width
        q0 += width - covered
        q1 += first_moment - covered * ends
        q2 += second - covered * (ends * ends - a * b)
        w0 += width
        w1 += first_moment
        w2 += second
        l0 += raised
        l1 += raised * both
        l2 += raised * lift
    sheet[Q0 + i], sheet[Q1 + i], sheet[Q2 + i] = q0, q1, q2
    sheet[V0 + i], sheet[V1 + i], sheet[V2 + i] = w0, w1, w2
    sheet[L0 + i], sheet[L1 + i], sheet[L2 + i] = l0, l1, l2


@compiled(**PLAIN, fastmath=SUMS)
def bear(count: np.uint64, hardness: float, excess: float, sheet: FloatArray) -> None:
    """Make force, moment and stiffness of the sums, for the lines that are wet; the others get no force.

    Per length of ski: ∫p dx, ∫p x dx, ∫∂p/∂ε xⁿ dx for n = 0, 1, 2, each times the line's share, and ∫p²/k_u dx, twice
    the springy energy.
    """
    per_stiff = 1.0 / (hardness + excess)
    for i in range(count):
        low, high, depth, slope = sheet[WET_FROM + i], sheet[WET_TO + i], sheet[EDGE_DEEP + i], sheet[FALLING + i]
        wet = sheet[SHARE + i] > 0.0 and sheet[DEEP + i] > 0.0
        share = sheet[SHARE + i]
        width, both = high - low, high + low
        q0 = sheet[Q0 + i] + width
        q1 = 0.5 * (sheet[Q1 + i] + width * both)
        q2 = (sheet[Q2 + i] + width * (both * both - high * low)) * (1.0 / 3.0)
        l0, l1 = excess * sheet[L0 + i], 0.5 * excess * sheet[L1 + i]
        force = share * (hardness * (depth * q0 + slope * q1) - l0)
        moment = share * (hardness * (depth * q1 + slope * q2) - l1)
        squared = depth * depth * q0 + 2.0 * depth * slope * q1 + slope * slope * q2
        crossed = 2.0 * hardness * (depth * l0 + slope * l1)
        spring = (hardness * hardness * squared - crossed + excess * excess * sheet[L2 + i]) * per_stiff
        sheet[FORCE + i], sheet[MOMENT + i] = force if wet else 0.0, moment if wet else 0.0
        sheet[SPRING + i] = spring if wet else 0.0
        sheet[STIFF0 + i] = share * (hardness * q0 + excess * sheet[V0 + i])
        sheet[STIFF1 + i] = share * (hardness * q1 + 0.5 * excess * sheet[V1 + i])
        sheet[STIFF2 + i] = share * (hardness * q2 + excess * sheet[V2 + i] * (1.0 / 3.0))
