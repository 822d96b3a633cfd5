"""A quantity that a user gives a value to, declared once: its name with unit, meaning, range, default and more."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import KW_ONLY, dataclass, replace
from numbers import Real
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple, TypeAlias

from .._support.errors import ParameterError
from .._support.messages import Message, template
from .._support.units import unit_of_name
from .._support.user_files.text_files import shown_value

if TYPE_CHECKING:
    from .._support.arrays import BoolArray, FloatArray


Kind: TypeAlias = Literal["number", "whole number", "text", "switch", "numbers", "three numbers"]
SMALLEST, LARGEST = 1e-100, 1e100
"""Sizes of numbers that can be squared and divided by."""
InputValue: TypeAlias = float | int | str | bool | tuple[float, ...]


def beyond_reason(values: FloatArray) -> BoolArray:
    """True for values, except 0 and NaN, with a magnitude outside `SMALLEST` to `LARGEST`.

    >>> import numpy as np
    >>> beyond_reason(np.array([0.0, 1e-300, -2.0, 1e300, np.nan])).tolist()
    [False, True, False, True, False]
    """
    size = abs(values)
    return (size > LARGEST) | ((size > 0.0) & (size < SMALLEST))


@dataclass(frozen=True, slots=True)
class Search:
    """Scale and default bounds for the identification of a quantity.

    size: typical change, in the unit of the quantity or of its logarithm; derivatives step by 1 to 5 % of it.
    lower, upper: default bounds; if `about` is True, they are added to the start of the search.
    logarithmic: True if the logarithm of the quantity is searched.
    """

    size: float
    lower: float
    upper: float
    about: bool = False
    logarithmic: bool = False


class Allowed(NamedTuple):
    """Allowed values of a quantity, a mark next to it in the annotation of a field; fields as those of `Quantity`."""

    lowest: float = -math.inf
    highest: float = math.inf
    above: bool = False
    below: bool = False
    infinite: bool = False
    usual: tuple[float, float] | None = None
    origin: str = ""


class Label(NamedTuple):
    """Short name and symbol of a quantity for the axes of figures, a mark next to it in the annotation of a field."""

    label: str
    symbol: str = ""


@dataclass(frozen=True, slots=True)
class Condition:
    """Condition on another key without which a quantity has no effect.

    key: the other key.
    value: required value of that key.
    differs: True if every other value than this one is required.
    """

    key: str
    value: InputValue
    differs: bool = False

    def holds(self, actual: object) -> bool:
        """True if the actual value of the other key meets the condition, so that the quantity has an effect."""
        return (actual == self.value) != self.differs

    @property
    def in_words(self) -> Message:
        """The condition for a message.

        >>> print(Condition("shear.law", "machining").in_words)
        shear.law = "machining"
        >>> print(Condition("snow.delayed_share", 0.0, differs=True).in_words)
        snow.delayed_share other than 0
        """
        if self.differs:
            return Message("{key} other than {value:g}", key=self.key, value=self.value)
        return Message('{key} = "{value}"', key=self.key, value=self.value)


@dataclass(frozen=True, slots=True)
class Quantity:
    """Key of an input file or option, declared in the annotation of the field that holds its value; see `declared`.

    name: key with its unit, as users write it; that of a scenario begins with its section.
    meaning: explanation in words.
    lowest, highest: ends of the range in the unit of the name; `above` and `below` exclude the lowest and the highest
        value themselves.
    infinite, blank: True if a number may be infinite; True if a text may be blank.
    origin: source of the default or of the range.
    example: example of the option on the command line, with the meaning of its values.
    label, symbol: short name and symbol for the axes of figures.
    usual: ends of the usual range, in the unit of the name; None: all of the range.
    search: scale and bounds for identification; None: both follow from the start of the search.
    index: index of the quantity in a field with several numbers.
    needed: True if a value is required and the field has no default.
    condition: condition without which any other value than the default is rejected (default: none).
    kind, choices, default, field: completed from the field: its type, the words of a ``Literal``, the default in the
        unit of the name (None without one), the name of the field.

    The range of a list applies to each number.
    """

    name: str
    meaning: str
    _: KW_ONLY
    lowest: float = -math.inf
    highest: float = math.inf
    above: bool = False
    below: bool = False
    infinite: bool = False
    blank: bool = False
    origin: str = ""
    example: str = ""
    label: str = ""
    symbol: str = ""
    usual: tuple[float, float] | None = None
    search: Search | None = None
    index: int | None = None
    kind: Kind = "number"
    choices: tuple[str, ...] = ()
    default: InputValue | None = None
    field: str = ""
    needed: bool = True
    condition: Condition | None = None

    @property
    def unit(self) -> str:
        """The unit's symbol, from the name.

        >>> Quantity("load_N", "load").unit, Quantity("friction.mu_0", "friction").unit
        ('N', '')
        """
        return unit_of_name(self.name).symbol

    @property
    def factor(self) -> float:
        """The unit's size in SI."""
        return unit_of_name(self.name).size

    @property
    def allowed(self) -> Message:
        """The range in words.

        >>> print(Quantity("load_N", "load", lowest=0.0, above=True).allowed)
        above 0
        """
        if self.kind == "switch":
            return Message("true or false")
        if self.kind == "text":
            return _allowed_texts(self.choices, self.blank)
        if self.kind in ("numbers", "three numbers"):
            allowed = replace(self, kind="number").allowed
            if self.kind == "numbers":
                return Message("numbers, each {allowed}", allowed=allowed)
            return Message("three numbers, each {allowed}", allowed=allowed)
        whole = self.kind == "whole number"
        if self.highest < math.inf:
            text = _RANGES[self.above, self.below, whole]
        elif self.lowest > -math.inf:
            text = _HALF_RANGES[self.above, whole]
        else:
            return Message("any whole number") if whole else Message("any finite number")
        return Message(text, low=self.lowest, high=self.highest)

    @property
    def described(self) -> str:
        """Meaning and unit.

        >>> Quantity("load_N", "force on the ski").described
        'force on the ski (N)'
        """
        return f"{self.meaning} ({self.unit})" if self.unit else self.meaning

    @property
    def axis_label(self) -> str:
        """Text of an axis: label, symbol and unit; the name without label and symbol.

        >>> Quantity("load_N", "force on the ski", label="load").axis_label
        'load (N)'
        """
        words = f"{self.label} {self.symbol}".strip()
        return f"{words}{f' ({self.unit})' if self.unit else ''}" if words else self.name

    def outside(self, values: FloatArray) -> BoolArray:
        """True for the values of an array, in the unit of the name, outside the range or `beyond_reason`."""
        low = values <= self.lowest if self.above else values < self.lowest
        return low | (values >= self.highest if self.below else values > self.highest) | beyond_reason(values)

    def in_kind(self, value: object) -> InputValue:
        """Convert a value to the kind of the quantity, a number to float; the range is not checked."""
        if self.kind == "switch" and isinstance(value, bool):
            return value
        if self.kind == "text" and isinstance(value, str):
            return value.strip()
        if self.kind == "three numbers" and isinstance(value, list | tuple) and len(value) == 3:
            one = replace(self, kind="number")
            return tuple(float(one.in_kind(number)) for number in value)  # type: ignore[arg-type]
        if self.kind == "numbers" and isinstance(value, list | tuple) and (value or self.default is not None):
            usual = all(type(number) in (float, int) and SMALLEST <= abs(number) <= LARGEST for number in value)
            numbers = value if usual else [one.in_kind(number) for one, number in self.single_quantities(value)]
            return tuple(float(number) for number in numbers)  # type: ignore[arg-type]
        if self.infinite and value == "inf":
            return math.inf
        if self.kind in ("number", "whole number") and isinstance(value, int | float) and not isinstance(value, bool):
            return self._number_of_kind(value)
        raise ParameterError(_OF_ANOTHER_KIND[self.kind]).tag("wrong_kind", name=self.name, value=shown_value(value))

    def _number_of_kind(self, value: float) -> float | int:
        """Number as a float, or an int for whole numbers; rejects fractions and sizes out of reach."""
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if number and math.isfinite(number) and not SMALLEST <= abs(number) <= LARGEST:
            raise ParameterError(
                "{name} is {value}, not a quantity; allowed are 0 and sizes from {smallest:g} to {largest:g}"
            ).tag("wrong_kind", name=self.name, value=shown_value(value), smallest=SMALLEST, largest=LARGEST)
        if self.kind == "number":
            return number
        if not number.is_integer():
            raise ParameterError("{name} is {value}; it must be a whole number").tag(
                "wrong_kind", name=self.name, value=shown_value(value)
            )
        return int(value)

    def single_quantities(self, values: Iterable[object]) -> Iterator[tuple[Quantity, object]]:
        """Pairs of quantity and value for each number of a list; their names are ``name[1]`` and so on."""
        for place, value in enumerate(values, start=1):
            yield replace(self, kind="number", name=f"{self.name}[{place}]"), value

    def in_range(self, value: object) -> InputValue:
        """Convert a value to the kind of the quantity; an error if it is of another kind or outside the range."""
        checked = self.in_kind(value)
        if self.kind == "numbers" and isinstance(value, list | tuple) and not self._allows(checked):
            for one, element in self.single_quantities(value):
                one.in_range(element)
        if not self._allows(checked):
            raise ParameterError(_NOT_ALLOWED_IN_UNIT if self.unit else _NOT_ALLOWED).tag(
                "out_of_range", name=self.name, value=shown_value(value), allowed=self.allowed, unit=self.unit
            )
        return checked

    @property
    def _unit_of_field(self) -> float:
        """Factor from the unit of the name to that of the field: 1 for a field of the same name, else that to SI."""
        return 1.0 if self.field == self.name.rpartition(".")[2] else self.factor

    def in_si(self, value: Any) -> Any:
        """Value in SI, three numbers as a tuple; values that are not numbers are returned unchanged.

        >>> Quantity("solver.step_ms", "step").in_si(0.5)
        0.0005
        """
        if self.kind in ("numbers", "three numbers"):
            return tuple(number * self._unit_of_field for number in value)
        return value * self._unit_of_field if self.kind == "number" else value

    def in_unit(self, value: Any) -> Any:
        """Give a field's value in the unit of the name, three numbers as a list; None stays.

        >>> Quantity("snow.H_V_N_per_mm3", "snow hardness").in_unit(2e8)
        0.2
        """
        if self.kind in ("numbers", "three numbers") and value is not None:
            return [number / self._unit_of_field for number in value]
        return value / self._unit_of_field if self.kind == "number" and value is not None else value

    def require(self, value: object) -> None:
        """Raise an error for a field's value, in the field's unit, of a wrong kind or outside the range."""
        if self.kind in ("numbers", "three numbers") and isinstance(value, list | tuple):
            self.in_range([_plain(number, self._unit_of_field) for number in value])
        elif self.kind in ("number", "whole number"):
            self.in_range(_plain(value, self._unit_of_field))
        elif self.in_range(value) != value:  # a file's text may have blanks around it
            raise ParameterError(_NOT_ALLOWED).tag(
                "out_of_range", name=self.name, value=shown_value(value), allowed=self.allowed
            )

    def _allows(self, value: InputValue) -> bool:
        """True if a value is within the range or choices; for a tuple, if all its numbers are."""
        if isinstance(value, str):
            return bool(value or self.blank) and (not self.choices or value in self.choices)
        if isinstance(value, bool):
            return True
        if isinstance(value, tuple):
            return all(self._allows(number) for number in value)
        if math.isinf(value):
            return self.infinite and value > 0
        at_end = (self.above and value == self.lowest) or (self.below and value == self.highest)
        return self.lowest <= value <= self.highest and not at_end


_OF_ANOTHER_KIND: Final = {
    "switch": template("{name} is {value}; it must be true or false without quotes"),
    "text": template("{name} is {value}; it must be a text in quotes"),
    "number": template("{name} is {value}; it must be a number"),
    "whole number": template("{name} is {value}; it must be a whole number"),
    "numbers": template("{name} is {value}; it must be a list of numbers in brackets"),
    "three numbers": template("{name} is {value}; it must be [a, b, c]"),
}
_NOT_ALLOWED: Final = template("{name} is {value}; allowed is {allowed}")
_NOT_ALLOWED_IN_UNIT: Final = template("{name} is {value}; allowed is {allowed} {unit}")
_RANGES: Final = {
    (False, False, False): template("from {low:-g} to {high:-g}"),
    (True, False, False): template("above {low:-g} to {high:-g}"),
    (False, True, False): template("from {low:-g} to below {high:-g}"),
    (True, True, False): template("above {low:-g} to below {high:-g}"),
    (False, False, True): template("whole numbers from {low:-g} to {high:-g}"),
    (True, False, True): template("whole numbers above {low:-g} to {high:-g}"),
    (False, True, True): template("whole numbers from {low:-g} to below {high:-g}"),
    (True, True, True): template("whole numbers above {low:-g} to below {high:-g}"),
}
"""By whether the lowest value is excluded, the highest one, and whether only whole numbers are allowed."""
_HALF_RANGES: Final = {
    (False, False): template("{low:-g} or more"),
    (True, False): template("above {low:-g}"),
    (False, True): template("whole numbers {low:-g} or more"),
    (True, True): template("whole numbers above {low:-g}"),
}


def _allowed_texts(choices: Sequence[str], blank: bool) -> Message:
    """Message with the allowed texts: the choices, or any text, which may be blank if `blank`."""
    if len(choices) > 2:
        return Message("one of {choices}", choices=choices)
    if len(choices) == 2:
        return Message("{first} or {second}", first=choices[0], second=choices[1])
    if choices:
        return Message("{choice}", choice=choices[0])
    return Message("a text") if blank else Message("a text that is not blank")


def _plain(value: object, factor: float) -> object:
    """A number divided by the factor of a unit, rounded to 14 digits; any other value unchanged."""
    if isinstance(value, bool) or not isinstance(value, Real):
        return value
    number = float(value) / factor
    return float(f"{number:.14g}")
