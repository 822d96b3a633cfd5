"""An input that varies: which one, from where to where, how many values."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from nicegui import ui

from .._support.errors import ParameterError
from .._support.user_files import natural_number
from .fields import choice, field
from .language import said
from .layout import sentence
from .scenario_fields import called, with_point
from .study_asked import MOST_POINTS, Range
from .typed import typed_number
from .worded import named

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ..parameters import Quantity

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
