"""A linear elastic foundation: p = H d, without memory (static snow as Federolf and others take it).

``python -m openbench.entries.elastic CASE_FOLDER RESULT``: the reference's lines and cells with k = H.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .files import main
from .numpy_reference import carve, pressing, turn
from .sand_fits import linear_in_depth

Case = dict[str, Any]
Values = dict[str, list[float] | None]


def forgetful(solve: Callable[[Case], Values]) -> Callable[[Case], Values]:
    """The same case on snow that forgets."""

    def solved(case: Case) -> Values:
        ratio = case["snow"]["unloading_ratio_1"]
        elastic = [1.0] * len(ratio) if isinstance(ratio, list) else 1.0
        return solve({**case, "snow": {**case["snow"], "unloading_ratio_1": elastic}})

    return solved


if __name__ == "__main__":
    main(
        "elastic",
        {
            "01-plate": forgetful(pressing.plate),
            "02-edge": forgetful(pressing.edge),
            "03-cycles": forgetful(pressing.cycles),
            "04-glide": forgetful(pressing.glide),
            "05-sand": linear_in_depth,
            "06-carve": forgetful(lambda case: carve.solve(case, knots=12, across=100)),
            "07-turn": forgetful(lambda case: turn.solve(case, turn.Fineness(5e-4, 0.02, 2e-4))),
            "08-crossing": forgetful(pressing.crossing),
        },
        {},
    )
