"""Variables of a design: keys of the ski file, and combinations of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from ..ski.editing import changed_keys

COMBINED: Final = {
    "sidecut_mm": ("tip_width_mm", "tail_width_mm"),
    "EI_factor": ("EI_N_m2",),
    "GJ_factor": ("GJ_N_m2",),
}
"""Added to tip and tail width (mm); factors of a whole list of stiffness."""


@dataclass(frozen=True, slots=True)
class Variable:
    """A variable by its name, with bounds in the unit of the ski file."""

    name: str
    lowest: float
    highest: float

    @property
    def width(self) -> float:
        """Distance of the bounds."""
        return self.highest - self.lowest


def combined_names(name: str) -> tuple[str, ...]:
    """Ski parameters from whose derivatives that of a variable follows."""
    if name == "sidecut_mm":
        return tuple(f"ski.{key}" for key in COMBINED[name])
    if name in COMBINED:
        return (f"edit.{COMBINED[name][0]}",)
    return (f"ski.{name}",)


def start_value(keys: Mapping[str, Any], name: str) -> float:
    """Value of a variable at the ski to begin with."""
    if name in COMBINED:
        return 0.0 if name == "sidecut_mm" else 1.0
    row = name.partition("[")
    if row[1]:
        return float(keys[row[0]][int(row[2].rstrip("]")) - 1])
    return float(keys.get(name, 0.0))


def designed_keys(keys: Mapping[str, Any], variables: Sequence[Variable], values: Sequence[float]) -> dict[str, Any]:
    """Keys of the ski file with the values of the variables; combinations act on top of the keys."""
    named = {variable.name: float(value) for variable, value in zip(variables, values, strict=True)}
    out = changed_keys(keys, {name: value for name, value in named.items() if name not in COMBINED})
    for name, value in named.items():
        if name == "sidecut_mm":
            out |= {key: out[key] + value for key in COMBINED[name]}
        elif name in COMBINED:
            key = COMBINED[name][0]
            out[key] = [value * number for number in out[key]]
    return out
