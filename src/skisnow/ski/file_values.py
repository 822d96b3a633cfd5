"""Values of a ski file by key: each is checked, and each error names file, key, value and fix."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NoReturn

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError, RangeWarning
from .._support.messages import Message, joined
from .._support.units import DEGREE
from .._support.user_files import read_toml, shown_value
from ..parameters import InputValue, Quantity, build_declared, suggest_and_list
from .file_keys import BASE, SKI_KEYS, SkiFile
from .layout import BaseShape

_OTHER_UNITS: Final = {
    "mm": (("metres", 1e3), ("centimetres", 10.0), ("inches", 25.4)),
    "m": (("mm", 1e-3), ("cm", 1e-2)),
    "kg": (("grams", 1e-3),),
    "kg/m": (("g/m", 1e-3),),
    "°": (("radians", 1.0 / DEGREE),),
    "N m²": (("N mm²", 1e-6), ("kN m²", 1e3)),
}
"""Units that people write by mistake: name and factor to the key's unit."""


@dataclass(frozen=True, slots=True)
class FileValues:
    """The keys and values of one ski file.

    values: as parsed.
    said: the same, checked, in SI.
    """

    file: Path
    values: dict[str, Any]
    said: SkiFile

    def __contains__(self, key: str) -> bool:
        return key in self.values

    def beside(self, key: str) -> Path | None:
        """Give the path of a file that the key names, counted from this file's folder."""
        name = getattr(self.said, key)
        return self.file.parent / name if name else None

    def needed(self, key: str) -> float:
        """Give a number in SI that the file must have."""
        number: float | None = getattr(self.said, SKI_KEYS[key].field)
        if number is None:
            raise ParameterError("{file}: the key {key} is missing. Add it, in the unit that it names.").tag(
                "missing", file=self.file, key=key
            )
        return number

    def numbers(self, key: str) -> FloatArray:
        """Give a list of numbers in SI that the file must have."""
        numbers = getattr(self.said, SKI_KEYS[key].field)
        if numbers is None:
            raise ParameterError("{file}: the key {key} is missing. Add a list such as {key} = [100, 440, 100].").tag(
                "missing", file=self.file, key=key
            )
        return np.array(numbers)

    def refuse(self, key: str, value: object, allowed: Message, action: Message) -> NoReturn:
        """Raise the error for a key."""
        refuse(self.file, key, value, allowed, action)

    def refuse_together(self, keys: Iterable[str], other: str | Message, action: Message) -> None:
        """Raise an error if one of the keys occurs together with another for the same quantity."""
        for key in keys:
            if key in self.values:
                raise ParameterError(
                    "{file}: {key} = {value} is stated together with {other} for the same quantity. {action}"
                ).tag(
                    "contradiction",
                    file=self.file,
                    key=key,
                    value=shown_value(self.values[key]),
                    other=other,
                    action=action,
                )


def refuse(file: Path, place: str, value: object, allowed: str, action: Message) -> NoReturn:
    """Raise the error for a value at a place of a file."""
    raise ParameterError("{file}: {place} is {value}; allowed is {allowed}. {action}").tag(
        "out_of_range", file=file, place=place, value=shown_value(value), allowed=allowed, action=action
    )


def checked(file: Path, value: object, quantity: Quantity) -> InputValue:
    """Give a value of a file, in the file's unit; its place is the quantity's name."""
    try:
        return quantity.in_range(value)
    except ParameterError as error:
        raise ParameterError("{file}: {problem}. {action}").tag(
            error.code or "out_of_range", file=file, problem=error, action=_remedy_text(value, quantity)
        ) from None


def _remedy_text(value: object, quantity: Quantity) -> Message:
    numbers: list[Any] = value if isinstance(value, list) else [value]
    if any(isinstance(number, bool) or not isinstance(number, int | float) for number in numbers):
        if quantity.kind in ("text", "switch"):
            return Message("Correct it.")
        if quantity.kind == "numbers":
            return Message("Put the numbers in brackets, no quotes.")
        return Message("Write a number with a decimal point, no quotes.")
    units = [unit for number in numbers if (unit := _likely_unit(float(number), quantity))]
    return joined([Message("Correct it."), *units[:1]])


def _is_usual(value: float, quantity: Quantity) -> bool:
    return quantity.usual is None or quantity.usual[0] <= value <= quantity.usual[1]


def _likely_unit(value: float, quantity: Quantity) -> Message | None:
    """Question for the unit in which an unusual value would be a usual one; None without such a unit."""
    if not _is_usual(value, quantity):
        for name, factor in _OTHER_UNITS.get(quantity.unit, ()):
            if _is_usual(value * factor, quantity):
                return Message("Is it in {unit}? Then write {value:g}.", unit=name, value=value * factor)
    return None


def warn_of_unusual(file: Path, values: Mapping[str, float], quantity: Quantity) -> None:
    """Warn once of numbers, in the file's unit and with their places, outside the usual range of skis."""
    unusual = [(place, value) for place, value in values.items() if value and not _is_usual(value, quantity)]
    if not unusual or quantity.usual is None:
        return
    place, value = unusual[0]
    fields = {"file": file, "place": place, "value": value, "low": quantity.usual[0], "high": quantity.usual[1]}
    text = (
        Message(
            "{file}: {place} is {value:g} (and {count} more); usual is {low:g} to {high:g}. The value is used.",
            **fields,
            count=len(unusual) - 1,
        )
        if len(unusual) > 1
        else Message("{file}: {place} is {value:g}; usual is {low:g} to {high:g}. The value is used.", **fields)
    )
    unit = _likely_unit(value, quantity)
    warnings.warn(RangeWarning(joined([text, unit]) if unit else text).tag("unusual"), stacklevel=2)


def file_values(path: Path) -> FileValues:
    """Parse a ski file and check its keys."""
    return values_of_keys(read_toml(path), path)


def values_of_keys(values: dict[str, Any], path: Path) -> FileValues:
    """Check the keys of a ski file that were parsed already; `path`: the file that errors name."""
    for key in values:
        if key not in SKI_KEYS:
            raise ParameterError("{path}: the key {key} is not known. {allowed}").tag(
                "unknown_name", path=path, key=key, allowed=suggest_and_list(key, SKI_KEYS)
            )
    checked_values = {key: checked(path, value, SKI_KEYS[key]) for key, value in values.items()}
    for key, value in checked_values.items():
        if isinstance(value, tuple):
            warn_of_unusual(path, {f"{key}[{n}]": element for n, element in enumerate(value, start=1)}, SKI_KEYS[key])
        elif isinstance(value, float):
            warn_of_unusual(path, {key: value}, SKI_KEYS[key])
    of_base = tuple((key, value) for key, value in checked_values.items() if key in BASE)
    own = {SKI_KEYS[key].field: SKI_KEYS[key].in_si(value) for key, value in checked_values.items() if key not in BASE}
    return FileValues(path, values, SkiFile(**own, base=_build_base(of_base)))


@functools.lru_cache(maxsize=32)
def _build_base(values: tuple[tuple[str, InputValue], ...]) -> BaseShape:
    return build_declared(BaseShape, dict(values))
