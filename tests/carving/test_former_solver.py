"""Equilibria of the solver before the compiled core, recorded when it was removed.

Four boot moments are of the compiled core since its matrix is exact: they moved by up to 3e-6 N m, which is 1e-11 m of
depth, where Newton's method ends. On snow of 10⁻⁵ N/mm³ the ski is in it with both edges, each of which now holds by
itself: the ski twists less, and its side force moved by 5e-4.

34 answers on snow that remembers were recorded again when the places across became functions of the question: they
moved by the error of keeping the groove at a few places (median: radius 5e-6, depth 9e-5, force 1e-4). `test_point.py`
compares with many places.
"""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from skisnow.carving.equilibrium import carve, rest
from skisnow.carving.result import Equilibrium
from skisnow.ski import read_ski

from .synthetic import snow

FORMER: list[dict[str, Any]] = json.loads((Path(__file__).parent / "former_solver.json").read_text("utf-8"))
ROUNDING = 1e-7
"""Of the greatest: equations of 160 elements lose six digits, and Newton's method ends at 10⁻¹¹ m."""
NONE = {"edge_depth": 1e-3, "force_per_length": 1e3, "twist": 1e-3, "boot_pitch_moment": 1.0}
"""Sizes (m, N/m, rad, N m) below which the rounding of others shows."""


def found(*, ski: str, H: float, S: float, angle: float, ratio: Any, bevel: float = 0.0, **asked: Any) -> Equilibrium:
    shape, given = replace(read_ski(ski), base_bevel=bevel), snow(H, S)
    if asked.pop("at_rest", False):
        return rest(shape, given, edge_angle=math.radians(angle), **asked)
    return carve(shape, given, edge_angle=math.radians(angle), unloading_ratio=float(ratio), **asked)


@pytest.mark.parametrize("former", FORMER, ids=lambda former: "-".join(str(v) for v in former["asked"].values()))
def test_the_same_is_found(former: dict[str, Any]) -> None:
    now = found(**former["asked"])
    for name, value in former["found"].items():
        computed = getattr(now, name)
        if value is None or isinstance(value, str):
            assert computed == value
        elif isinstance(value, list):
            places = len(now.station)
            room = ROUNDING * max(NONE[name], *(abs(each) for each in value))
            assert computed[places // 16 :: places // 8] == pytest.approx(value, rel=0.0, abs=room), name
        else:
            assert computed == pytest.approx(value, rel=ROUNDING, abs=ROUNDING * NONE.get(name, 0.0)), name
