"""Columns of the sheet on which the lines under a ski are worked out, many at a time.

A sheet is one flat array: the number of line i in column C is `sheet[C + i]`. Columns of one array that lie a known
distance apart are what lets the compiler take several lines in one instruction. Vectors are in the ski's frame.
"""

from __future__ import annotations

from typing import Final

import numpy as np

WIDTH: Final = 136
"""Lines on a sheet; no power of two, or the columns would compete for the same places of the processor's cache."""


def _columns(first: int, count: int) -> tuple[np.uint64, ...]:
    """Unsigned: the compiled loops need not ask whether a place counts from the end."""
    return tuple(np.uint64(WIDTH * i) for i in range(first, first + count))


# the line: its place from the boot, its directions ahead, out of the snow, and along itself to the left
E0, E1, E2, D0, D1, D2, N0, N1, N2, Y0, Y1, Y2 = _columns(0, 12)
# where along the ski the edge crosses it: of the straight axis (m), what half width and height add; place in the table
GAP, TOWARD, UPWARDS, AT = _columns(12, 4)
# the section: its station, the line's share of the spacing, half width and its slope, height of the base and its
# slope, place in its element, that element's length (m)
S, SHARE, HALF, FLARE, HEIGHT, RISE, Z, LENGTH = _columns(16, 8)
# deflection, slope and twist of the nodes before and behind, and their rates
BW, BS, BT, CW, CS, CT, VW, VS, VT, WW, WS, WT = _columns(24, 12)
# sine and cosine of the twist, its slope; sine of the edge angle
SINE, COSINE, TWISTING, TILT = _columns(36, 4)
# the edge that is down: depth of the deepest, and of this one, across from the ski's middle, from the boot upwards
# and to the left, across from the line's origin (m)
DEEP, EDGE_DEEP, REACH, K1, K2, EDGE_AT = _columns(40, 6)
# directions in the surface: across the edge, along it, and one over its length before it was made a unit; how far the
# edge lies aside of the ski's axis for each metre ahead
U0, U1, U2, T0, T1, T2, SIZE, ASIDE = _columns(46, 8)
# the base: its normal along the ski, one over its part along the line's; fall of the depth to the left, growth along
# the edge; width across the base over that along the line; where it begins and ends, and where it is wet (m)
NORMAL_AHEAD, STEEP, FALLING, CLIMB, WIDE, LATERAL, RIGHT, LEFT, WET_FROM, WET_TO = _columns(54, 10)
# the answer of the snow: force (N) and moment, stiffness and its moments, twice the springy energy per length (J/m);
# grip of the edge (N), and the share of it in use
FORCE, MOMENT, STIFF0, STIFF1, STIFF2, SPRING, HOLD, USED = _columns(64, 8)
# centre of pressure (m), its velocity (m/s) and speed along the edge, how far across the base from the ski's middle;
# rate of the twist; what compaction and friction do along the edge, and the shear across it (N)
H0, H1, H2, C0, C1, C2, SLIDING, ARM, TWIST_RATE, RESIST, RUB, SHEARING = _columns(72, 12)
# on the beam: force (N), moment, and the shares that the nodes take of the force
UP, TURNING, W0, W1, W2, W3 = _columns(84, 6)
# speeds of the base's edges along the line (m/s)
RIGHT_MOVES, LEFT_MOVES = _columns(90, 2)
# where the pressure of virgin snow ends (m from the edge), one over the fall of the depth; sums over the cells that
# were pressed deeper, see `pressure`
WATERLINE, PER_FALL, Q0, Q1, Q2, V0, V1, V2, L0, L1, L2 = _columns(92, 11)
COLUMNS: Final = 103
