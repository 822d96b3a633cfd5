"""Checks of values of a ski file, and warnings about those in another unit."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from .._support.errors import ParameterError, RangeWarning
from .._support.messages import Message, joined
from .._support.units import DEGREE
from ..parameters import InputValue, Quantity

_OTHER_UNITS: Final = {
    "mm": (("metres", 1e3), ("centimetres", 10.0), ("inches", 25.4)),
    "m": (("mm", 1e-3), ("cm", 1e-2)),
    "kg": (("grams", 1e-3),),
    "kg/m": (("g/m", 1e-3),),
    "°": (("radians", 1.0 / DEGREE),),
    "N m²": (("N mm²", 1e-6), ("kN m²", 1e3)),
}
"""Units that people write by mistake: name and factor to the key's unit."""


def checked(file: Path, value: object, quantity: Quantity) -> InputValue:
    """The value of a key, in the file's unit, if it is in the quantity's range; otherwise ParameterError."""
    try:
        return quantity.in_range(value)
    except ParameterError as error:
        raise ParameterError("{file}: {problem}. {action}").tag(
            error.code or "out_of_range", file=file, problem=error, action=_remedy_text(value, quantity)
        ) from None


def _remedy_text(value: object, quantity: Quantity) -> Message:
    """Advice for a rejected value: quotes, brackets, or the unit that the numbers suggest."""
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
    """True if a value is in the quantity's usual range, or if it has none."""
    return quantity.usual is None or quantity.usual[0] <= value <= quantity.usual[1]


def _likely_unit(value: float, quantity: Quantity) -> Message | None:
    """Question whether a value is in another unit, in which it would be usual; None without such a unit."""
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
