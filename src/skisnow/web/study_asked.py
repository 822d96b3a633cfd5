"""What a study is asked of on a page: as the text of STUDY.toml with the files that it names, and in words."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from .._support.errors import ParameterError
from ..carving.keys import CARVE_KEYS
from .scenario_fields import called, written

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..parameters import Quantity

CARVE: Final = "carved-turn"
"""What stands for the study of carved turns where else a scenario's name stands."""
STUDY: Final = "study.toml"
TABLE: Final = "table.csv"
MOST_POINTS: Final = 10_000
"""Of a study of the lab, whose page draws them all (modelling assumption); the command takes a million."""


@dataclass(frozen=True, slots=True)
class Range:
    """The values of an input that varies: from, to, how many, and whether they are even in the logarithm."""

    low: float
    high: float
    n: int
    log: bool = False

    def toml(self) -> str:
        """As a study's file has it."""
        log = ", log = true" if self.log else ""
        return f"{{ from = {self.low!r}, to = {self.high!r}, n = {self.n}{log} }}"

    def words(self) -> str:
        """In words."""
        log = ", logarithmic" if self.log else ""
        return f"{written(self.low)} to {written(self.high)}, {self.n} values{log}"

    @property
    def middle(self) -> float:
        """Of the range."""
        return (self.low + self.high) / 2.0


@dataclass(frozen=True, slots=True)
class StudyAsked:
    """A study.

    Attributes
    ----------
    of
        `CARVE`, or the name of a scenario.
    varied, fixed
        Ranges and values by key.
    beside
        Texts of files that fixed values name, by their names.
    named
        What is given by name, in words.
    method, unit_s
        See `StudyJob`.
    """

    of: str
    varied: Mapping[str, Range]
    fixed: Mapping[str, Any]
    beside: Mapping[str, bytes] = field(default_factory=dict)
    named: tuple[str, ...] = ()
    method: str = ""
    unit_s: float = 0.0

    def files(self) -> dict[str, bytes]:
        """All files of the study by name, `STUDY` among them."""
        return {**self.beside, STUDY: self.text().encode("utf-8")}

    def text(self) -> str:
        """The study's file, as the command reads it."""
        lines = [f'out = "{TABLE}"']
        if self.of != CARVE:
            lines.append(f"scenario = {_toml(self.of)}")
        fixed = (f"{_key(name)} = {_toml(value)}" for name, value in self.fixed.items())
        varied = (f"{_key(name)} = {values.toml()}" for name, values in self.varied.items())
        return "\n".join([*lines, "", "[fixed]", *fixed, "", "[grid]", *varied, ""])

    def fixed_words(self) -> dict[str, str]:
        """Fixed values that are no names of files."""
        return {name: written(value) for name, value in self.fixed.items() if name in study_keys(self.of)}

    def varied_words(self) -> str:
        """What varies, and what is given by name."""
        keys = study_keys(self.of)
        return "; ".join(
            [*(f"{called(keys[name])}: {each.words()}" for name, each in self.varied.items()), *self.named]
        )


@cache
def study_keys(of: str) -> Mapping[str, Quantity]:
    """The numbers among the inputs of a carved turn or of a scenario, by name: what a study may vary."""
    from ..scenario.keys import SCENARIO_KEYS

    if of != CARVE:
        return {name: key for name, key in SCENARIO_KEYS.items() if is_number(key)}
    other = SCENARIO_KEYS["snow.unloading_ratio"]
    labels = {name: key.label or other.label for name, key in CARVE_KEYS.items() if is_number(key)}
    # what it means is said on the page of carved turns
    return {name: replace(CARVE_KEYS[name], label=label, meaning=label) for name, label in labels.items()}


def is_number(key: Quantity) -> bool:
    """Whether an input is one that a range can be given for."""
    return key.kind in ("number", "whole number")


def most_points_refused(points: int) -> None:
    """Refuse a study that the lab's page cannot show.

    Raises
    ------
    ParameterError
        It has more points than `MOST_POINTS`.
    """
    if points > MOST_POINTS:
        raise ParameterError(
            f"the study has {points} points; the lab takes at most {MOST_POINTS}. Take fewer values, or the command "
            "skisnow study, which takes a million"
        )


def _key(name: str) -> str:
    return f'"{name}"' if "." in name else name


def _toml(value: Any) -> str:
    if isinstance(value, bool | str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, tuple | list):
        return f"[{', '.join(map(_toml, value))}]"
    return repr(value)
