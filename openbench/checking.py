"""Whether a result is one: a wrong unit, a missing quantity, a number that is none, told in words."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any, Final, TypeAlias

Json: TypeAlias = dict[str, Any]

UNITS: Final = (
    "m", "N", "J", "s", "kg", "deg", "rad", "1", "J_per_m", "kg_per_m", "kg_m2", "m_per_s", "m2_per_s2", "m_per_s2",
    "N_per_m2", "N_per_m3", "N_m2",
)  # fmt: skip
"""That end keys, from the longest on where one ends another."""
_OTHER: Final = ("mm", "cm", "km", "kN", "MN", "kJ", "mJ", "ms", "g", "mm_per_s", "km_per_h", "kN_per_m3", "N_per_mm3")


def unit_of(key: str) -> str | None:
    """The unit at the end of a key; None where there is none."""
    ends = [unit for unit in UNITS if key.endswith(f"_{unit}")]
    return max(ends, key=len, default=None)


def problems(case: Json, path: Path) -> list[str]:
    """All that is wrong with the file of a result; nothing where it can be scored."""
    where = f"case {case['case']}, {path.name}"
    try:
        result = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return [f"case {case['case']}: no {path.name} was written. Who cannot do a case writes 'declined'."]
    except ValueError as error:
        return [f"{where} is no JSON ({error}). A number that does not exist is null, not nan."]
    if not isinstance(result, dict):
        return [f"{where} holds no object"]
    found = [
        f"{where}: '{key}' is {result.get(key)!r}; it must be {case[key]!r}"
        for key in ("openbench", "case")
        if result.get(key) != case[key]
    ]
    if isinstance(result.get("declined"), str):
        return found
    values = result.get("values")
    if not isinstance(values, dict):
        return [*found, f"{where} has neither 'values' nor 'declined'"]
    asked = {each["key"]: each["count"] for each in case["asked"]}
    found += [_unasked(where, key, asked) for key in values if key not in asked]
    for key, count in asked.items():
        found += _of_key(where, key, count, values)
    return found


def _unasked(where: str, key: str, asked: dict[str, int]) -> str:
    stem = _stem(key)
    for other in asked:
        if _stem(other) == stem:
            told = f"'{key}' is in a wrong unit; asked is '{other}', in {unit_of(other)}"
            return f"{where}: {told}. Convert it and name it so."
    return f"{where}: '{key}' was not asked; asked are {', '.join(asked)}"


def _stem(key: str) -> str:
    ends = [unit for unit in (*UNITS, *_OTHER) if key.endswith(f"_{unit}")]
    return key.removesuffix(f"_{max(ends, key=len)}") if ends else key


def _of_key(where: str, key: str, count: int, values: Json) -> list[str]:
    if key not in values:
        return [f"{where}: '{key}' is missing; a quantity that a program does not compute is null"]
    given = values[key]
    if given is None:
        return []
    if not isinstance(given, list) or len(given) != count:
        had = len(given) if isinstance(given, list) else "none"
        return [f"{where}: '{key}' must be a list of {count} numbers; it has {had}"]
    for place, value in enumerate(given):
        if isinstance(value, bool) or not isinstance(value, int | float):
            return [f"{where}: '{key}' holds {value!r} at place {place}; it must be a number"]
        if not math.isfinite(value):
            return [f"{where}: '{key}' holds {value} at place {place}; it must be finite (null: not computed)"]
    return []
