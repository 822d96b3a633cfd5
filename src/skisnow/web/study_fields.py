"""The question of a study: inputs that vary, ranges, and its STUDY.toml."""

from __future__ import annotations

import dataclasses
import json
import math
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from nicegui import ui

from .._support.errors import ParameterError
from .._support.user_files import natural_number
from ..carving.keys import CARVE_KEYS
from .elements import choice, field, named
from .language import said
from .layout import sentence
from .number_input import typed_number
from .scenario_fields import called, with_point, written

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

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
    beside: Mapping[str, bytes] = dataclasses.field(default_factory=dict)
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


NOTHING: Final = "nothing"
FROM: Final = "From"
TO: Final = "To"
VALUES: Final = "Number of values"
LOG: Final = "Even in the logarithm"
_USUAL: Final = "10"
_BEGINS: Final = {
    "edge_angle_deg": (10.0, 70.0),
    "load_N": (400.0, 1200.0),
    "H_V_N_per_mm3": (0.1, 10.0),
    "S_f_N_per_mm2": (0.05, 0.5),
    "unloading_ratio": (1.0, 50.0),
    "moment_Nm": (-50.0, 50.0),
    "speed_m_per_s": (6.0, 12.0),
    "angle_deg": (5.0, 20.0),
    "mu_0": (0.02, 0.1),
    "drag_area_m2": (0.3, 0.8),
    "mass_kg": (60.0, 120.0),
}
"""By the last part of an input's name what stands in the fields at first, to be typed over (modelling assumption: a
skier on groomed snow)."""


def begins(key: Quantity) -> tuple[float, float] | None:
    """Ends that an input goes through at first; of one with a default from its half to its double, as far as allowed.

    >>> from skisnow.parameters import Quantity
    >>> begins(Quantity("load_N", "")), begins(Quantity("w_m", "", default=0.8, highest=1.0))
    ((400.0, 1200.0), (0.4, 1.0))
    """
    name = key.name.rpartition(".")[2]
    if name in _BEGINS:
        return _BEGINS[name]
    default = key.default
    if isinstance(default, bool) or not isinstance(default, int | float) or default <= 0.0:
        return key.usual
    low, high = max(default / 2.0, key.lowest), min(default * 2.0, key.highest)
    if key.kind == "whole number":
        low, high = float(math.ceil(low)), float(math.floor(high))
    return (low, high) if math.isfinite(high) and low < high else None


class AxisFields:
    """The fields of one input that varies; `changed` is called with each change.

    Parameters
    ----------
    place
        In words: which of the inputs it is.
    keys
        What may vary.
    first
        Its name and number of values at first; None: nothing, which can be chosen then.
    changed
        See above.
    """

    def __init__(
        self,
        place: str,
        keys: Mapping[str, Quantity],
        first: tuple[str, str] | None,
        changed: Callable[[], None],
    ) -> None:
        self._keys, self._changed = keys, changed
        options = {} if first else {NOTHING: NOTHING}
        name, n = first or (NOTHING, _USUAL)
        with ui.element("div").classes("inputs varied"):
            with ui.element("div").classes("input"):
                self._key = choice(place, {**options, **{each: called(key) for each, key in keys.items()}}, name)
                self._range = sentence("", "quiet range")
            self._ends = [field(words, "", numeric=True) for words in (FROM, TO)]
            self._n = field(VALUES, n, numeric=True)
            self._log = ui.switch(said(LOG)).classes("field")
        for each, words in zip((*self._ends, self._n, self._log), (FROM, TO, VALUES, LOG), strict=True):
            named(each, f"{place}: {words[0].lower()}{words[1:]}")
        self._begin()
        for typed in (*self._ends, self._n):
            typed.on_value_change(changed)
        self._log.on_value_change(changed)
        self._key.on_value_change(self._another)
        self._show()

    @property
    def name(self) -> str:
        """Of the input; nothing where none varies."""
        name = str(self._key.value)
        return "" if name == NOTHING else name

    def _another(self) -> None:
        self._begin()
        self._show()
        self._changed()

    def _begin(self) -> None:
        ends = begins(self._keys[self.name]) if self.name else None
        for each, end in zip(self._ends, ends or (None, None), strict=True):
            each.set_value("" if end is None else f"{end:g}")

    def _show(self) -> None:
        for each in (*self._ends, self._n, self._log):
            each.set_visibility(bool(self.name))
        self._range.set_text(f"Allowed: {self._keys[self.name].allowed}." if self.name else "")

    def range(self) -> Range:
        """What is typed.

        Raises
        ------
        ParameterError
            It is no range of the input.
        """
        key = self._keys[self.name]
        words = called(key)
        if not all(str(each.value or "").strip() for each in self._ends):
            raise ParameterError(f"{words}: type both ends of what it goes through")
        low, high = (
            typed_number(f"{words}, the {end} end", str(each.value or ""))
            for each, end in zip(self._ends, ("lower", "upper"), strict=True)
        )
        for end in (low, high):
            try:
                key.in_range(round(end) if key.kind == "whole number" and end == round(end) else end)
            except ParameterError as error:
                raise ParameterError(str(error).replace(key.name, words)) from error
        if not low < high:
            raise ParameterError(f"{words}: it goes from {low:g} to {high:g}; the first end must be the smaller one")
        if self._log.value and low <= 0.0:
            raise ParameterError(f"{words}: even in the logarithm, it must begin above 0; it begins at {low:g}")
        return Range(low, high, self.count(), bool(self._log.value))

    def count(self) -> int:
        """How many values there are; 1 where nothing varies.

        Raises
        ------
        ParameterError
            What is typed is no such number.
        """
        if not self.name:
            return 1
        text = with_point(str(self._n.value or "").strip())
        number = natural_number(text)
        if number is None or not 2 <= number <= MOST_POINTS:
            raise ParameterError(
                f"{called(self._keys[self.name])}: the number of values is {text!r}; it must be from 2 to {MOST_POINTS}"
            )
        return number
