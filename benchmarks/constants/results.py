"""How far constants move the ends of the cases, as rows of moved.csv."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeAlias

from .collecting import Constant
from .varying import CASES

MOVED: Final = Path(__file__).with_name("moved.csv")
Ends: TypeAlias = Mapping[str, tuple[str, float | None, float | None]]


@dataclass(frozen=True, slots=True)
class Moved:
    """What a constant times a factor does: by case the distance of both ends (mm), or the other outcome."""

    key: str
    value: str
    factor: float
    ends: tuple[str, ...]

    @classmethod
    def of(cls, constant: Constant, factor: float, base: Ends, other: Ends) -> Moved:
        """Against the ends with its own value."""
        return cls(constant.key, constant.value, factor, tuple(_moved(base[case], other[case]) for case in CASES))


def _moved(base: tuple[str, float | None, float | None], other: tuple[str, float | None, float | None]) -> str:
    if base[0] != other[0] or other[1] is None or other[2] is None or base[1] is None or base[2] is None:
        return other[0]
    return f"{1e3 * math.hypot(other[1] - base[1], other[2] - base[2]):.3g}"


def read_moved() -> list[Moved]:
    """All rows; of a constant and factor the last one."""
    if not MOVED.exists():
        return []
    with MOVED.open(encoding="utf-8", newline="") as file:
        _, *rows = csv.reader(file)
    return list({(row[0], row[2]): Moved(row[0], row[1], float(row[2]), tuple(row[3:])) for row in rows}.values())


def store_moved(moved: Moved) -> None:
    """Add a row, or put it in place of the one of the same constant and factor."""
    others = [each for each in read_moved() if (each.key, each.factor) != (moved.key, moved.factor)]
    whole = sorted([*others, moved], key=lambda each: (each.key, each.factor))
    written = MOVED.with_suffix(".new")
    with written.open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["constant", "value", "factor", *(f"{case} (mm)" for case in CASES)])
        out.writerows([each.key, each.value, f"{each.factor:g}", *each.ends] for each in whole)
    written.replace(MOVED)
