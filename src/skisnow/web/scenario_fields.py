"""Fields of a scenario's inputs with name, unit and range, from their declarations."""

from __future__ import annotations

import re
from typing import Any, Final, TypeAlias

from nicegui import ui

from .._support.errors import ParameterError
from .._support.messages import Message
from ..parameters import InputValue, Quantity
from .elements import TypedField, choice, field, named, sentence
from .words import number_text, plain_number, replaced, said

InputField: TypeAlias = TypedField | ui.select | ui.switch

ON: Final = "true"
OFF: Final = "false"
_OF_FILES: Final = re.compile(r'"|\b[a-z]+_[a-z]+\b|omit |default: ')
"""Clauses of a meaning about keys of a file, which do not apply to a form."""
_NUMBER: Final = re.compile(r"[-+−]?\d*[.,]?\d*(e[-+−]?\d+)?")
_DIGITS: Final = 6  # significant digits of a value in a field


def field_label(key: Quantity) -> str:
    """Label of the field of an input: name, symbol and unit.

    >>> from skisnow.scenario.keys import SCENARIO_KEYS
    >>> field_label(SCENARIO_KEYS["slope.angle_deg"]), field_label(SCENARIO_KEYS["snow.H_V_N_per_mm3"])
    ('Slope angle α (°)', 'Snow hardness H_V (N/mm³)')
    """
    label = str(key.label or key.name)
    words = f"{label[0].upper()}{label[1:]} {key.symbol.replace('$', '')}".rstrip()
    return f"{words} ({key.unit})" if key.unit else words


def range_words(key: Quantity) -> str:
    """Meaning of an input, unless its name states it, and allowed values.

    >>> from skisnow.scenario.keys import SCENARIO_KEYS
    >>> range_words(SCENARIO_KEYS["slope.angle_deg"]), range_words(SCENARIO_KEYS["snow.S_f_N_per_mm2"])
    ('Inclination of the plane. Allowed: from 0 to 75.', 'Allowed: above 0.')
    """
    english, shown = key.meaning.split("; "), str(Message(key.meaning)).split("; ")
    clauses = [text for clause, text in zip(english, shown, strict=True) if not _OF_FILES.search(clause)]
    is_named = not clauses or not key.meaning or key.meaning.startswith(key.label)
    words = [] if is_named else [_as_sentence("; ".join(clauses))]
    if not (key.choices or key.kind == "switch"):
        words.append(str(Message("Allowed: {allowed}.", allowed=key.allowed)))
    return " ".join(words)


def _as_sentence(words: str) -> str:
    """A sentence with a capital letter, unless it begins with a symbol."""
    return f"{words[0].upper()}{words[1:]}." if words[:2].isalpha() and words[:2].isascii() else f"{words}."


def typed_form(value: Any) -> str:
    """A value as it is typed on the command line, rounded for a field.

    >>> typed_form([6.0, 8.0]), typed_form(True), typed_form(0.20669325758298024)
    ('[6, 8]', 'true', '0.206693')
    """
    if value is None:
        return ""
    if isinstance(value, bool):
        return ON if value else OFF
    if isinstance(value, tuple | list):
        return f"[{', '.join(typed_form(item) for item in value)}]"
    return f"{value:.{_DIGITS}g}" if isinstance(value, float) else str(value)


def with_point(text: str) -> str:
    """A number with a decimal comma or a minus sign as on the command line; other texts unchanged."""
    return plain_number(text) if _NUMBER.fullmatch(text) else text


class ScenarioField:
    """Field, menu or switch of an input, with its range."""

    def __init__(self, key: Quantity, value: Any, typed: str | None) -> None:
        self.key = key
        self.before = typed_form(value)
        with ui.element("div").classes("input") as self.place:
            self.element = self._create_element(self.before if typed is None else typed)
            named(self.element, field_label(key))
            self._range = sentence(range_words(key), "quiet range")

    def _create_element(self, text: str) -> InputField:
        if self.key.kind == "switch":
            return ui.switch(said(field_label(self.key)), value=text == ON).classes("field")
        if self.key.choices:
            return choice(field_label(self.key), list(self.key.choices), text or None)
        if self.key.kind in ("number", "whole number"):
            return field(field_label(self.key), number_text(text), numeric=True)
        return field(field_label(self.key), text)

    @property
    def text(self) -> str:
        """Current value as on the command line."""
        value = self.element.value
        if isinstance(value, bool):
            return ON if value else OFF
        return with_point(str(value or "").strip())

    @property
    def is_changed(self) -> bool:
        """True if the value differs from that of the scenario."""
        return self.text != self.before

    def check(self) -> InputValue:
        """Check the value and return it; an error is shown at the field.

        Raises ParameterError: the value is not valid for this input.
        """
        self.refuse("")
        try:
            if not self.text:
                raise ParameterError("{key} is empty; {file} has {before}").tag(
                    "empty", key=self.key.name, file=self.where, before=self.before
                )
            return self.key.in_range(self.typed_value())
        except ParameterError as error:
            self.refuse(in_labels(error.message, self.key))
            raise

    where = Message("the scenario")
    """Origin of the first value, for messages."""

    def typed_value(self) -> object:
        """Current value as in a file."""
        from ..scenario.keys import parse_change

        return parse_change(f"{self.key.name}={self.text}")[1]

    def refuse(self, fault: str) -> None:
        """Show an error at the field; "" removes it."""
        if isinstance(self.element, ui.input):
            self.element.error = said(fault, self.element.client) if fault else None
        else:
            self._range.set_text(fault or range_words(self.key))
            self._range.classes(add="bad" if fault else "", remove="" if fault else "bad")

    def focus(self) -> None:
        """Put the focus on the field and select its text."""
        client, id_ = self.element.client, self.element.id
        client.run_javascript(f"lab.goTo({id_})")


def in_labels(message: str, *keys: Quantity) -> str:
    """A message of the library with the names of fields instead of keys.

    >>> from skisnow.scenario.keys import SCENARIO_KEYS
    >>> in_labels("sledge.mass_kg is -5.0; allowed is above 0 to 1000 kg", SCENARIO_KEYS["sledge.mass_kg"])
    'Mass of the sledge m (kg) is -5.0; allowed is above 0 to 1000 kg'
    """
    longest_first = sorted(keys, key=lambda key: -len(key.name))
    return replaced(message, {key.name: field_label(key) for key in longest_first})
