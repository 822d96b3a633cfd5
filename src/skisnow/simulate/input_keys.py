"""A key that a user gives a value to: its unit, range, default and where that comes from."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

from ..errors import ParameterError

Kind: TypeAlias = Literal["number", "whole number", "text", "switch", "three numbers"]
SMALLEST, LARGEST = 1e-100, 1e100
"""Sizes of numbers that can be squared and divided by (Choice)."""
InputValue: TypeAlias = float | int | str | bool | tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class InputKey:
    """What may stand under one key.

    Attributes
    ----------
    name
        With its unit, as users write it.
    meaning
        In words.
    kind
        Of its value.
    unit, factor
        The unit's symbol, and its size in SI.
    lowest, highest
        Ends of the range in that unit; `above` leaves the lowest value itself out.
    infinite
        Whether an infinite number has a meaning.
    choices
        The words that are allowed; empty: any.
    default
        None where there is none.
    origin
        Where the default or the range comes from.
    example
        How it is given on the command line, with what its values mean.

    The range of three numbers is that of each.
    """

    name: str
    meaning: str
    kind: Kind = "number"
    unit: str = ""
    factor: float = 1.0
    lowest: float = -math.inf
    highest: float = math.inf
    above: bool = False
    infinite: bool = False
    choices: tuple[str, ...] = ()
    default: InputValue | None = None
    origin: str = ""
    example: str = ""

    @property
    def allowed(self) -> str:
        """The range in words.

        >>> InputKey(name="load_N", meaning="load", lowest=0.0, above=True).allowed
        'above 0'
        """
        if self.kind == "switch":
            return "true or false"
        if self.kind == "text":
            return " or ".join(self.choices) or "a text that is not blank"
        if self.kind == "three numbers":
            return f"three numbers, each {replace(self, kind='number').allowed}"
        kind = "whole numbers " if self.kind == "whole number" else ""
        if self.highest < math.inf:
            return f"{kind}{'above' if self.above else 'from'} {self.lowest:g} to {self.highest:g}"
        if self.lowest > -math.inf:
            return kind + (f"above {self.lowest:g}" if self.above else f"{self.lowest:g} or more")
        return f"any {'whole' if kind else 'finite'} number"

    def of_kind(self, value: object) -> InputValue:
        """Give the value in its kind, a number as float; its range is not looked at.

        Raises
        ------
        ParameterError
            It is of another kind.
        """
        if self.kind == "switch" and isinstance(value, bool):
            return value
        if self.kind == "text" and isinstance(value, str):
            return value.strip()
        if self.kind == "three numbers" and isinstance(value, list | tuple) and len(value) == 3:
            one = replace(self, kind="number")
            return tuple(float(one.of_kind(each)) for each in value)  # type: ignore[arg-type]
        if self.infinite and value == "inf":
            return math.inf
        if self.kind in ("number", "whole number") and isinstance(value, int | float) and not isinstance(value, bool):
            return self._number(value)
        wanted = {
            "switch": "true or false without quotes",
            "text": "a text in quotes",
            "three numbers": "[a, b, c]",
        }.get(self.kind, f"a {self.kind}")
        raise ParameterError(f"{self.name} is {_shown(value)}; it must be {wanted}")

    def _number(self, value: float) -> float | int:
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if number and math.isfinite(number) and not SMALLEST <= abs(number) <= LARGEST:
            what = f"allowed are 0 and sizes from {SMALLEST:g} to {LARGEST:g}"
            raise ParameterError(f"{self.name} is {_shown(value)}, which is no quantity; {what}")
        if self.kind == "number":
            return number
        if not number.is_integer():
            raise ParameterError(f"{self.name} is {_shown(value)}; it must be a whole number")
        return int(value)

    def in_range(self, value: object) -> InputValue:
        """Give the value in its kind.

        Raises
        ------
        ParameterError
            It is of another kind or outside the range.
        """
        checked = self.of_kind(value)
        if not self._allows(checked):
            unit = f" {self.unit}" if self.unit else ""
            raise ParameterError(f"{self.name} is {_shown(value)}; allowed is {self.allowed}{unit}")
        return checked

    def _allows(self, value: InputValue) -> bool:
        if isinstance(value, str):
            return bool(value) and (not self.choices or value in self.choices)
        if isinstance(value, bool):
            return True
        if isinstance(value, tuple):
            return all(self._allows(each) for each in value)
        if math.isinf(value):
            return self.infinite and value > 0
        return self.lowest <= value <= self.highest and not (self.above and value == self.lowest)


def nearest(word: str, known: Iterable[str]) -> str:
    """The known word most like a misspelt one as a question, and all of them."""
    words = list(known)
    return f"{meant(word, words)}There are {', '.join(words)}"


def meant(word: str, known: Iterable[str]) -> str:
    """The known word most like a misspelt one as a question with a space behind; empty where none is like it.

    >>> meant("angel", ["angle", "mass"])
    'Is angle meant? '
    """
    by_small = {each.lower(): each for each in known}
    like = difflib.get_close_matches(word.lower(), by_small, n=1, cutoff=0.5)
    return f"Is {by_small[like[0]]} meant? " if like else ""


def _shown(value: Any, limit: int = 80) -> str:
    """A value for an error message, shortened."""
    try:
        text = repr(value)
    except ValueError:  # an integer of more digits than Python writes
        return "a number of thousands of digits"
    return text if len(text) <= limit else text[:limit] + " …"
