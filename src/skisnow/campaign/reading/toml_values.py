"""Validated values of a parsed TOML file by key; each problem names the path of its key.

Paths count from 1: ``tool[2].length_mm`` is the length of the second tool.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias, TypeVar

from ..._support.errors import ParameterError
from ..._support.messages import Message, joined
from ..._support.user_files.text_files import shown_value
from ...parameters import Quantity, build_declared, own_quantities
from ..problems import Problem, error, warning

_SIMILAR = 0.8  # from here a key is taken for a misspelt one
_MISSING = object()

TomlTable: TypeAlias = "Mapping[str, Any]"
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class TomlValues:
    """One table of a parsed TOML file, whose values are checked as they are read.

    file: name of the file.
    values: parsed table.
    path: path of the table in the file, ``""`` at the top.
    problems: list to which problems are added.
    """

    file: str
    values: TomlTable
    path: str
    problems: list[Problem]

    def path_of(self, key: str) -> str:
        """Key with the path of this table before it, such as "tool.name"."""
        return f"{self.path}.{key}" if self.path else key

    def refuse(
        self,
        key: str,
        allowed: Message,
        action: Message | None = None,
        *,
        code: str = "bad_toml",
        value: object = _MISSING,
    ) -> None:
        """Add an error for a key (default: with its value, and the advice to correct the key) to the problems."""
        action = action or Message("Correct {key}.", key=key)
        shown = self.values.get(key) if value is _MISSING else value
        text = None if shown is None else shown_value(shown, 200, str)
        self.problems.append(
            error(code, self.file, column=self.path_of(key), value=text, allowed=allowed, action=action)
        )

    def refuse_unknown(self, key: str, value: object, words: Iterable[str], allowed: Message, action: Message) -> None:
        """Add an error for an unknown word at a key, with the most similar of the known words."""
        near = difflib.get_close_matches(shown_value(value, 200, str).lower(), list(words), n=1)
        meant = [Message("Did you mean {similar}?", similar=near[0])] if near else []
        self.refuse(key, allowed, joined([*meant, action]), value=value)

    def text(self, key: str, *, blank_allowed: bool = False) -> str | None:
        """Stripped text of a key; None if it is missing, invalid (an error is added) or blank."""
        value = self.values.get(key)
        if value is None:
            return None
        if not isinstance(value, str) or not (value.strip() or blank_allowed):
            blank = Message("a text, in quotes")
            self.refuse(key, blank if blank_allowed else Message("a text that is not blank, in quotes"))
            return None
        return value.strip() or None

    def texts(self, key: str) -> tuple[str, ...]:
        """Texts of a key that has one text or a list of texts; () if missing or invalid."""
        value = self.values.get(key, [])
        items = [value] if isinstance(value, str) else value
        if not isinstance(items, list) or not all(isinstance(item, str) for item in items):
            self.refuse(key, Message("a text or a list of texts, in quotes"))
            return ()
        return tuple(item.strip() for item in items if item.strip())

    def number(self, quantity: Quantity) -> float | None:
        """Number of a quantity's key in the unit of the key; None if missing or invalid."""
        return self._checked(self.values[quantity.name], quantity) if quantity.name in self.values else None

    def numbers(self, quantity: Quantity) -> tuple[float, ...]:
        """Valid numbers of the list at a quantity's key, in the unit of the key."""
        key = quantity.name
        values = self.values.get(key, [])
        if not isinstance(values, list):
            self.refuse(key, Message("a list of numbers in brackets, such as [50, 100, 150]"))
            return ()
        checked = (self._checked(value, one) for one, value in quantity.single_quantities(values))
        return tuple(value for value in checked if value is not None)

    def _checked(self, value: object, quantity: Quantity) -> float | None:
        """Value as a number in the key's unit; None, with an error, if it is not a number or out of range."""
        allowed = Message("a finite number {allowed}", allowed=quantity.allowed)
        if isinstance(value, bool) or not isinstance(value, int | float):
            action = Message("Write a number with a decimal point, without quotes.")
            self.refuse(quantity.name, allowed, action, value=value)
            return None
        try:
            quantity.in_range(value)
        except ParameterError:
            action = Message("Correct the number; its unit is in the key's name.")
            self.refuse(quantity.name, allowed, action, code="out_of_range", value=value)
            return None
        return float(value)

    def table(self, key: str) -> TomlValues:
        """Table at a key below this one; an empty table if missing or invalid."""
        value = self.values.get(key, {})
        if not isinstance(value, dict):
            self.refuse(key, Message("a table, begun by the line [{key}] above its keys", key=key))
            value = {}
        return TomlValues(self.file, value, self.path_of(key), self.problems)

    def tables(self, key: str) -> list[TomlValues]:
        """Tables in the list at a key, such as ``[[tool]]``; [] if missing or invalid."""
        values = self.values.get(key, [])
        if not isinstance(values, list) or not all(isinstance(value, dict) for value in values):
            self.refuse(key, Message("tables, each begun by the line [[{key}]] above its keys", key=key))
            return []
        paths = (f"{self.path_of(key)}[{place}]" for place in range(1, len(values) + 1))
        return [TomlValues(self.file, value, path, self.problems) for value, path in zip(values, paths, strict=True)]

    def declared(self, owner: type[T]) -> T:
        """Build a dataclass from the values of this table; missing and invalid ones have their defaults."""
        quantities = {quantity.name: quantity for quantity in own_quantities(owner)}
        self.refuse_misspelt(quantities)
        values: dict[str, object] = {}
        for key in quantities.keys() & self.values.keys():
            try:
                values[key] = quantities[key].in_range(self.values[key])
            except ParameterError:
                self.refuse(key, quantities[key].allowed)
        return build_declared(owner, values)

    def refuse_misspelt(self, allowed_keys: Iterable[str]) -> None:
        """Report unknown keys: an error if a key is similar to a known one, otherwise a warning."""
        keys: Sequence[str] = tuple(allowed_keys)
        for key in self.values:
            if key in keys:
                continue
            near = difflib.get_close_matches(key.lower(), keys, n=1, cutoff=_SIMILAR)
            if near:
                action = Message("Did you mean {similar}? Correct or remove the key.", similar=near[0])
                self.refuse(key, Message("the key {near}", near=near[0]), action, value=key)
            else:
                allowed = Message("the keys {allowed_keys}", allowed_keys=list(keys))
                action = Message("The key is not used; no action is needed.")
                path = self.path_of(key)
                self.problems.append(
                    warning("unknown_column", self.file, column=path, value=key, allowed=allowed, action=action)
                )
