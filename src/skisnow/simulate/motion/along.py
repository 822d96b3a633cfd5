"""What the skis do at the nodes of their mesh, for the record of a run."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import PLAIN
from .forces import Forces
from .model import PADDING, Model, State

FloatArray: TypeAlias = npt.NDArray[np.float64]


def shares(node: FloatArray) -> FloatArray:
    """Length of ski (m) that each node stands for."""
    half = -np.diff(node) / 2.0
    return np.asarray(np.append(half, 0.0) + np.append(0.0, half))


@compiled(**PLAIN)
def along_skis(model: Model, state: State, start: Forces, share: FloatArray, out: FloatArray) -> None:
    """Fill `out` (5, 2, m): edge depth (m), force and shear per length (N/m), bending (m), twist (rad) at the nodes.

    Forces of lines go to the two nodes beside them in proportion: their sum is kept. Depths are interpolated.
    """
    node = model.node
    last = len(node) - 1
    for k in range(2):
        count = start.sections[k]
        element = last - 1
        at = last
        for c in range(count):  # from the tail
            s = start.section[k, c, 0]
            while element > 0 and s > node[element]:
                element -= 1
            z = min(max((node[element] - s) / (node[element] - node[element + 1]), 0.0), 1.0)
            for which in range(2):
                value = start.section[k, c, 1 + which]
                out[1 + which, k, element] += (1.0 - z) * value / share[element]
                out[1 + which, k, element + 1] += z * value / share[element + 1]
            before = start.section[k, max(c - 1, 0), 0]
            while at >= 0 and node[at] <= s:
                f = (node[at] - before) / (s - before) if s > before and node[at] > before else 0.0
                out[0, k, at] = start.section[k, c, 3] * f + start.section[k, max(c - 1, 0), 3] * (1.0 - f)
                at -= 1
        while at >= 0 and count > 0:
            out[0, k, at] = start.section[k, count - 1, 3]
            at -= 1
        for i in range(last + 1):
            first = model.dof[i, 0] if i < last else model.dof[last - 1, 1]
            if first >= 0:
                out[3, k, i] = state.bend[k, first + PADDING]
                out[4, k, i] = state.bend[k, first + PADDING + 2]
