"""Inputs of a study: ranges, fields on the page, and study.toml."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Final

from nicegui import ui

from .._support.errors import ParameterError
from .._support.messages import Message, template
from .._support.user_files.text_files import natural_number, toml_text
from ..carving.question import CARVE_KEYS
from ..parameters import Quantity
from .elements import choice, field, named, sentence
from .scenario_fields import field_label, typed_form, with_point
from .words import number_text, replaced, said, typed_number

CARVE: Final = "carved-turn"  # subject of a study of carved turns, instead of the name of a scenario
STUDY: Final = "study.toml"
TABLE: Final = "table.csv"
MOST_POINTS: Final = 10_000  # maximum number of points of a study in the lab, whose page draws all of them


@dataclass(frozen=True, slots=True)
class Range:
    """Range of a varied input: ends, number n of values; `log`: True for evenly spaced logarithms."""

    low: float
    high: float
    n: int
    log: bool = False

    def toml(self) -> str:
        """TOML of the range: from, to, number of values, and log if it is logarithmic."""
        log = ", log = true" if self.log else ""
        return f"{{ from = {self.low!r}, to = {self.high!r}, n = {self.n}{log} }}"

    def words(self) -> str:
        """Message with both ends, the number of values, and whether they are logarithmic."""
        fields = {"low": number_text(typed_form(self.low)), "high": number_text(typed_form(self.high)), "n": self.n}
        if self.log:
            return Message("{low} to {high}, {n} values, logarithmic", **fields)
        return Message("{low} to {high}, {n} values", **fields)


@dataclass(frozen=True, slots=True)
class StudyQuestion:
    """Inputs of a study, from which its files are written.

    of: subject of the study: `CARVE`, or the name of a scenario.
    varied, fixed: ranges and values by key; a list among the values is varied, too.
    beside: contents of the files that fixed values name, by name.
    named: inputs that were chosen by name, in words.
    """

    of: str
    varied: Mapping[str, Range]
    fixed: Mapping[str, Any]
    beside: Mapping[str, bytes] = dataclasses.field(default_factory=dict)
    named: tuple[str, ...] = ()

    def files(self) -> dict[str, bytes]:
        """Contents of all files of the study by name, including `STUDY`."""
        return {**self.beside, STUDY: self.text().encode("utf-8")}

    def text(self) -> str:
        """Text of study.toml with the subject, fixed inputs, lists and varied inputs."""
        lines = [f'out = "{TABLE}"']
        if self.of != CARVE:
            lines.append(f"scenario = {toml_text(self.of)}")
        fixed, listed = (
            [
                f"{_toml_key(name)} = {toml_text(value)}"
                for name, value in self.fixed.items()
                if isinstance(value, list) == several
            ]
            for several in (False, True)
        )
        varied = (f"{_toml_key(name)} = {values.toml()}" for name, values in self.varied.items())
        return "\n".join([*lines, "", "[fixed]", *fixed, "", "[grid]", *listed, *varied, ""])

    def varied_words(self) -> str:
        """Ranges, and inputs that were chosen by name, in words."""
        keys = study_keys(self.of)
        return "; ".join(
            [
                *(f"{field_label(keys[name])}: {values.words()}" for name, values in self.varied.items()),
                *map(str, self.named),
            ]
        )


@cache
def study_keys(of: str) -> Mapping[str, Quantity]:
    """Inputs of a carved turn (`CARVE`) or of a scenario that are numbers, which a study can vary, by name."""
    from ..scenario.keys import SCENARIO_KEYS

    if of != CARVE:
        return {name: key for name, key in SCENARIO_KEYS.items() if is_number(key)}
    other = SCENARIO_KEYS["snow.unloading_ratio"]
    labels = {name: key.label or other.label for name, key in CARVE_KEYS.items() if is_number(key)}
    # the meanings are on the page of carved turns
    return {name: replace(CARVE_KEYS[name], label=label, meaning=label) for name, label in labels.items()}


def is_number(key: Quantity) -> bool:
    """True for an input that can have a range."""
    return key.kind in ("number", "whole number")


def _toml_key(name: str) -> str:
    """Key for TOML, quoted if it has a dot."""
    return f'"{name}"' if "." in name else name


NOTHING: Final = "nothing"
FROM: Final = Message("From")
TO: Final = Message("To")
VALUES: Final = Message("Number of values")
LOG: Final = Message("Even in the logarithm")
_NAMES: Final = {
    FROM: template("{place}: from"),
    TO: template("{place}: to"),
    VALUES: template("{place}: number of values"),
    LOG: template("{place}: even in the logarithm"),
}
"""Names of the fields for screen readers."""
_LOWER_END: Final = template("{input}, the lower end")
_UPPER_END: Final = template("{input}, the upper end")
_USUAL: Final = "10"
_FIRST_RANGES: Final = {
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
"""First ranges by the last part of the input's name: values for a skier on groomed snow (modelling assumption)."""


def first_range(key: Quantity) -> tuple[float, float] | None:
    """Initial range of an input's fields: a known one, or half to twice its default; None without either.

    >>> from skisnow.parameters import Quantity
    >>> first_range(Quantity("load_N", "")), first_range(Quantity("w_m", "", default=0.8, highest=1.0))
    ((400.0, 1200.0), (0.4, 1.0))
    """
    name = key.name.rpartition(".")[2]
    if name in _FIRST_RANGES:
        return _FIRST_RANGES[name]
    default = key.default
    if isinstance(default, bool) or not isinstance(default, int | float) or default <= 0.0:
        return key.usual
    low, high = max(default / 2.0, key.lowest), min(default * 2.0, key.highest)
    if key.kind == "whole number":
        low, high = float(math.ceil(low)), float(math.floor(high))
    return (low, high) if math.isfinite(high) and low < high else None


class AxisFields:
    """Fields of one varied input.

    place: name of the fields, such as "First input".
    keys: inputs that can vary, by name.
    first: initial input and number of values; None: no input, which is then an option.
    changed: function that is called after each change.
    """

    def __init__(
        self,
        place: str,
        keys: Mapping[str, Quantity],
        first: tuple[str, str] | None,
        changed: Callable[[], None],
    ) -> None:
        self._keys, self._changed = keys, changed
        options: dict[str, str] = {} if first else {NOTHING: Message("nothing")}
        name, n = first or (NOTHING, _USUAL)
        with ui.element("div").classes("inputs varied"):
            with ui.element("div").classes("input"):
                self._toml_key = choice(
                    place, {**options, **{field_: field_label(key) for field_, key in keys.items()}}, name
                )
                self._range = sentence("", "quiet range")
            self._ends = [field(words, "", numeric=True) for words in (FROM, TO)]
            self._n = field(VALUES, n, numeric=True)
            self._log = ui.switch(said(LOG)).classes("field")
        for field_, words in zip((*self._ends, self._n, self._log), (FROM, TO, VALUES, LOG), strict=True):
            named(field_, Message(_NAMES[words], place=place))
        self._set_first_range()
        for typed in (*self._ends, self._n):
            typed.on_value_change(changed)
        self._log.on_value_change(changed)
        self._toml_key.on_value_change(self._change_input)
        self._show()

    @property
    def name(self) -> str:
        """Name of the varied input, "" without one."""
        name = str(self._toml_key.value)
        return "" if name == NOTHING else name

    def _change_input(self) -> None:
        """Show the fields of another input with its first range, and announce the change."""
        self._set_first_range()
        self._show()
        self._changed()

    def _set_first_range(self) -> None:
        """Set the ends of the range for the input; empty without one."""
        ends = first_range(self._keys[self.name]) if self.name else None
        for field_, end in zip(self._ends, ends or (None, None), strict=True):
            field_.set_value("" if end is None else number_text(f"{end:g}"))

    def _show(self) -> None:
        """Show the fields and the allowed range, or nothing without an input."""
        for field_ in (*self._ends, self._n, self._log):
            field_.set_visibility(bool(self.name))
        self._range.set_text(Message("Allowed: {allowed}.", allowed=self._keys[self.name].allowed) if self.name else "")

    def range(self) -> Range:
        """The range typed into the fields. Raises ParameterError: the range is not valid for the input."""
        key = self._keys[self.name]
        words = field_label(key)
        if not all(str(field_.value or "").strip() for field_ in self._ends):
            raise ParameterError("{input}: type both ends of its range").tag("missing", input=words)
        low, high = (
            typed_number(Message(end, input=words), str(field_.value or ""))
            for field_, end in zip(self._ends, (_LOWER_END, _UPPER_END), strict=True)
        )
        for end in (low, high):
            try:
                key.in_range(round(end) if key.kind == "whole number" and end == round(end) else end)
            except ParameterError as error:
                raise ParameterError(replaced(error.message, {key.name: said(words)})).tag(error.code) from error
        if not low < high:
            raise ParameterError(
                "{input}: it goes from {low:g} to {high:g}; the first end must be the smaller one"
            ).tag("not_rising", input=words, low=low, high=high)
        if self._log.value and low <= 0.0:
            raise ParameterError("{input}: even in the logarithm, it must begin above 0; it begins at {low:g}").tag(
                "not_positive", input=words, low=low
            )
        return Range(low, high, self.count(), bool(self._log.value))

    def count(self) -> int:
        """Number of values; 1 without a varied input. Raises ParameterError: the text is not an allowed number."""
        if not self.name:
            return 1
        text = with_point(str(self._n.value or "").strip())
        number = natural_number(text)
        if number is None or not 2 <= number <= MOST_POINTS:
            raise ParameterError("{input}: the number of values is {value!r}; it must be from 2 to {most}").tag(
                "out_of_range", input=field_label(self._keys[self.name]), value=text, most=MOST_POINTS
            )
        return number
