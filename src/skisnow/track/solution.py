"""How a receiver came to a place: by the carrier's phase with whole cycles, without them, or by the code alone.

Real-time and post-processed kinematics (RTK, PPK) count cycles of the carrier. Once their number is fixed to whole ones
a place is right to centimetres; while it is not ("float") to decimetres, and it wanders; by the code to metres.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt

Solution: TypeAlias = Literal["", "fixed", "float", "code"]
"""Of a point; empty where the file does not say, or there is no fix."""
SOLUTIONS: Final[tuple[Solution, ...]] = get_args(Solution)[1:]
"""From the most exact to the least."""
SolutionArray: TypeAlias = npt.NDArray[np.str_]


def solution_array(solutions: Sequence[Solution]) -> SolutionArray | None:
    """One entry for each point; None where the file says of none.

    >>> solution_array(["fixed", ""]), solution_array(["", ""])
    (array(['fixed', ''], dtype='<U5'), None)
    """
    return np.array(solutions, dtype="<U5") if any(solutions) else None


def solution_counts(solution: SolutionArray | None) -> dict[str, int] | None:
    """How many points have each; None where nothing is known, or all are by the code.

    >>> solution_counts(np.array(["fixed", "float", "fixed"]))
    {'fixed': 2, 'float': 1}
    """
    if solution is None or not _by_phase(solution):
        return None
    counts = {name: int(np.sum(solution == name)) for name in SOLUTIONS}
    return {name: count for name, count in counts.items() if count}


def solution_flags(solution: SolutionArray | None, count: int) -> dict[str, npt.NDArray[np.bool_]]:
    """The flags ``float_solution`` and ``code_solution``, each (count,) bool.

    The second only where other points are by the phase: a receiver that never is says nothing by it.
    """
    none = np.zeros(count, bool)
    if solution is None:
        return {"float_solution": none, "code_solution": none.copy()}
    by_code = solution == "code" if _by_phase(solution) else none
    return {"float_solution": np.asarray(solution == "float"), "code_solution": np.asarray(by_code)}


def inexact_sentence(name: str, solution: SolutionArray | None) -> str | None:
    """A warning where a track has exact points and others; None where it has not.

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
