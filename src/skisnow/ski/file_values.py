"""Values of a ski file, asked for by key: each is checked, and each error names file, key, value and remedy."""

from __future__ import annotations

import difflib
import math
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
import numpy.typing as npt

from ..errors import ParameterError, RangeWarning
from ..given import read_toml
from .file_keys import KEYS, LIST_KEYS, NUMBER_KEYS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .file_keys import NumberKey

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class FileValues:
    """The keys and values of one ski file.

    Attributes
    ----------
    file
        Its path.
    values
        As parsed.
    """

    file: Path
    values: dict[str, Any]

    def __contains__(self, key: str) -> bool:
        return key in self.values

    def text(self, key: str) -> str | None:
        """Give a text, None where it is absent."""
        value = self.values.get(key)
        if value is not None and not (isinstance(value, str) and value.strip()):
            self.refuse(key, value, "a text in quotes", "Correct it")
        return value

    def beside(self, key: str) -> Path | None:
        """Give the path of a file that the key names, counted from this file's folder."""
        name = self.text(key)
        return self.file.parent / name if name else None

    def switch(self, key: str) -> bool:
        """Give a true or false, false where it is absent."""
        value = self.values.get(key, False)
        if not isinstance(value, bool):
            self.refuse(key, value, "true or false, without quotes", "Correct it")
        return value

    def number(self, key: str) -> float | None:
        """Give a number in SI, None where it is absent."""
        if key not in self.values:
            return None
        value = checked_number(self.file, key, self.values[key], NUMBER_KEYS[key])
        warn_of_unusual(self.file, {key: value}, NUMBER_KEYS[key])
        return value * NUMBER_KEYS[key].unit

    def needed(self, key: str) -> float:
        """Give a number in SI that the file must have."""
        number = self.number(key)
        if number is None:
            raise ParameterError(f"{self.file}: the key {key} is missing. Add it, in the unit that it names.")
        return number

    def numbers(self, key: str) -> FloatArray:
        """Give a list of numbers in SI that the file must have."""
        if key not in self.values:
            raise ParameterError(f"{self.file}: the key {key} is missing. Add a list such as {key} = [100, 440, 100].")
        values = self.values[key]
        if not isinstance(values, list) or not values:
            self.refuse(key, values, "a list of numbers from tip to tail, in brackets", "Put the numbers in brackets")
        named = {f"{key}[{place}]": value for place, value in enumerate(values, start=1)}
        checked = {place: checked_number(self.file, place, value, LIST_KEYS[key]) for place, value in named.items()}
        warn_of_unusual(self.file, checked, LIST_KEYS[key])
        return np.array(list(checked.values())) * LIST_KEYS[key].unit

    def refuse(self, key: str, value: object, allowed: str, action: str) -> NoReturn:
        """Raise the error for a key."""
        refuse(self.file, key, value, allowed, action)

    def refuse_together(self, keys: Iterable[str], other: str, action: str) -> None:
        """Raise an error where one of the keys stands beside another that says the same."""
        for key in keys:
            if key in self.values:
                what = f"{key} = {shown(self.values[key])} cannot stand beside {other}"
                raise ParameterError(f"{self.file}: {what}, which says the same. {action}.")


def refuse(file: Path, place: str, value: object, allowed: str, action: str) -> NoReturn:
    """Raise the error for a value at a place of a file."""
    raise ParameterError(f"{file}: {place} is {shown(value)}; allowed is {allowed}. {action}.")


def checked_number(file: Path, place: str, value: object, key: NumberKey) -> float:
    """Give a number of a file, in the file's unit.

    Raises
    ------
    ParameterError
        It is no finite number, or outside its range; a likely mistake of unit is named.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        refuse(file, place, value, f"a finite number, {key.allowed}", "Write a number with a decimal point, no quotes")
    if not key.lowest <= value <= key.highest:
        remedy = f"Correct it.{key.likely_unit(value)}".removesuffix(".")
        refuse(file, place, value, key.allowed, remedy)
    return float(value)


def warn_of_unusual(file: Path, values: dict[str, float], key: NumberKey) -> None:
    """Warn once of numbers, in the file's unit and by their places, that are beyond what skis usually have."""
    unusual = [(place, value) for place, value in values.items() if value and not key.is_usual(value)]
    if not unusual:
        return
    place, value = unusual[0]
    more = f" (and {len(unusual) - 1} more)" if len(unusual) > 1 else ""
    usual = f"usual is {key.usual[0]:g} to {key.usual[1]:g}"
    text = f"{file}: {place} is {value:g}{more}; {usual}. It is used as it stands.{key.likely_unit(value)}"
    warnings.warn(text, RangeWarning, stacklevel=2)


def file_values(path: Path) -> FileValues:
    """Parse a ski file and check its keys.

    Raises
    ------
    ParameterError
        The file cannot be read, is no TOML, or has a key that no ski file has; the nearest key is named.
    """
    values = read_toml(path)
    for key in values:
        if key not in KEYS:
            raise ParameterError(f"{path}: the key {key} is not known. {nearest(key, KEYS)}")
    return FileValues(path, values)


def nearest(word: str, known: Iterable[str]) -> str:
    """Name the known word most like a misspelt one, and all of them."""
    words = list(known)
    by_small = {each.lower(): each for each in reversed(words)}
    like = difflib.get_close_matches(word.lower(), by_small, n=1, cutoff=0.5)
    question = f"Is {by_small[like[0]]} meant? " if like else ""
    return f"{question}There are {', '.join(words)}."


def shown(value: object, limit: int = 80) -> str:
    """A value for an error message, shortened."""
    try:
        text = repr(value)
    except ValueError:  # an integer of more digits than Python writes
        return "a number of thousands of digits"
    return text if len(text) <= limit else text[:limit] + " …"
