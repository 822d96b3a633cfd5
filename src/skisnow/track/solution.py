"""Kinds of solutions of satellite receivers: carrier phase with fixed cycles, with float cycles, or code only.

Real-time and post-processed kinematics (RTK, PPK) count cycles of the carrier. With their number fixed to integers a
place is accurate to centimetres, with a float number to decimetres with a drift, and by the code to metres.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt

Solution: TypeAlias = Literal["", "fixed", "float", "code"]
"""Kind of solution of a point; empty if unknown, or without a fix."""
SOLUTIONS: Final[tuple[Solution, ...]] = get_args(Solution)[1:]
"""Kinds of solutions, the most accurate first."""
SolutionArray: TypeAlias = npt.NDArray[np.str_]


def solution_array(solutions: Sequence[Solution]) -> SolutionArray | None:
    """Kinds of solutions of all points (n,); None if all are unknown.

    >>> solution_array(["fixed", ""]), solution_array(["", ""])
    (array(['fixed', ''], dtype='<U5'), None)
    """
    return np.array(solutions, dtype="<U5") if any(solutions) else None


def solution_counts(solution: SolutionArray | None) -> dict[str, int] | None:
    """Number of points by kind of solution; None if all are unknown or code solutions.

    >>> solution_counts(np.array(["fixed", "float", "fixed"]))
    {'fixed': 2, 'float': 1}
    """
    if solution is None or not _by_phase(solution):
        return None
    counts = {name: int(np.sum(solution == name)) for name in SOLUTIONS}
    return {name: count for name, count in counts.items() if count}


def solution_flags(solution: SolutionArray | None, count: int) -> dict[str, npt.NDArray[np.bool_]]:
    """The flags ``float_solution`` and ``code_solution``, each (count,) bool.

    Code solutions are flagged only if other points of the track are phase solutions.
    """
    none = np.zeros(count, bool)
    if solution is None:
        return {"float_solution": none, "code_solution": none.copy()}
    by_code = solution == "code" if _by_phase(solution) else none
    return {"float_solution": np.asarray(solution == "float"), "code_solution": np.asarray(by_code)}


def inexact_sentence(name: str, solution: SolutionArray | None) -> str | None:
    """Warning if only some points of a track are fixed solutions, otherwise None.

    >>> inexact_sentence("a.ubx", np.array(["fixed", "float", "code", "fixed"]))
    'a.ubx: of 4 points 1 float (decimetres off) and 1 by the code alone (metres off); the others are fixed'
    """
    counts = solution_counts(solution) or {}
    words = {"float": "float (decimetres off)", "code": "by the code alone (metres off)"}
    counted = [f"{counts[kind]} {text}" for kind, text in words.items() if counts.get(kind)]
    if not counted or not counts.get("fixed"):
        return None
    return f"{name}: of {sum(counts.values())} points {' and '.join(counted)}; the others are fixed"


def _by_phase(solution: SolutionArray) -> bool:
    return bool(np.isin(solution, ("fixed", "float")).any())
