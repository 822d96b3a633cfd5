"""Quantities that dataclasses declare: found, checked in constructors, read from values as given and written back.

The annotation of a field declares its quantity, with its `Label`, `Allowed`, `Condition` and `Search`:

>>> @dataclass(frozen=True)
... class Air:
...     density: Annotated[float, Quantity("air.density_kg_per_m3", "density of the air"), Allowed(0.0)] = 1.2
...
...     def __post_init__(self) -> None:
...         require_declared(self)
>>> (density,) = quantities(Air)
>>> density.unit, density.default, str(density.allowed)
('kg/m³', 1.2, '0 or more')
>>> build_declared(Air, {"air.density_kg_per_m3": 1.1})
Air(density=1.1)
>>> Air(-1.0)
Traceback (most recent call last):
skisnow._support.errors.ParameterError: air.density_kg_per_m3 is -1.0; allowed is 0 or more kg/m³
"""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Callable, Collection, Mapping
from dataclasses import MISSING, Field, dataclass, fields, is_dataclass, replace
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Final, Literal, NamedTuple, TypeVar, Union, get_args, get_origin

from .._support.errors import ParameterError, suggest_and_list
from .quantity import Allowed, Condition, Kind, Label, Quantity, Search

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Word(Quantity):
    """Quantity whose value in a file is a text, such as a name, which the reader of the file interprets.

    word_of: function from a value of the field to its text in a file (default: no text describes the value).
    names_file: True if the text is the path of a file.
    """

    kind: Kind = "text"
    needed: bool = False
    word_of: Callable[[Any], object] = lambda _: None
    names_file: bool = False


class Section(NamedTuple):
    """Section of a file with the quantities of a nested dataclass; `otherwise`: True if a word may replace it."""

    name: str
    otherwise: bool = False


APART: Final = "apart"
"""Marks a field whose dataclass is in a separate file: its quantities do not belong to the owner."""


class _Slot(NamedTuple):
    """A field of a dataclass with its annotation: its quantities, the nested dataclasses `parts`, and their section."""

    field: Field[Any]
    own: tuple[Quantity, ...]
    parts: tuple[type, ...]
    section: Section
    may_be_none: bool


def own_quantities(owner: type) -> tuple[Quantity, ...]:
    """Quantities that a dataclass declares for its own fields, without those of nested dataclasses, in their order."""
    return tuple(quantity for slot in _slots_of(owner) for quantity in slot.own)


def quantities(owner: type) -> tuple[Quantity, ...]:
    """The quantities of a dataclass and of its nested dataclasses, by section in the order of first occurrence."""
    listed: list[Quantity] = []
    for slot in _slots_of(owner):
        listed += slot.own
        for quantity in (quantity for part in slot.parts for quantity in quantities(part)):
            name = _full_key(slot.section.name, quantity.name)
            needed = quantity.needed and not slot.section.otherwise
            listed.append(replace(quantity, name=name, needed=needed))
    by_section: dict[str, list[Quantity]] = {}
    for quantity in listed:
        by_section.setdefault(quantity.name.rpartition(".")[0], []).append(quantity)
    return tuple(quantity for section in by_section.values() for quantity in section)


def require_declared(thing: Any) -> None:
    """Raise an error for values that a file could not contain; ``__post_init__`` of a dataclass calls it."""
    for slot in _slots_of(type(thing)):
        value = getattr(thing, slot.field.name)
        if value is not None or not slot.may_be_none:
            for quantity in slot.own:
                if not isinstance(quantity, Word):
                    quantity.require(value if quantity.index is None else value[quantity.index])
    require_effect(thing)


def require_effect(thing: Any) -> None:
    """Reject values other than the default that have no effect because of another value of the same dataclass."""
    owner: Any = type(thing)
    conditional = _conditional_quantities(owner)
    values = values_of(thing) if conditional else {}
    for quantity in conditional:
        condition, value = quantity.condition, values.get(quantity.name)
        if condition is None or condition.key not in values or value in (None, quantity.default):
            continue
        if not condition.holds(values[condition.key]):
            raise ParameterError("{name} is {value}; it goes with {condition}. Change one of them").tag(
                "contradiction", name=quantity.name, value=_short_text(value), condition=condition.in_words
            )


@cache
def _conditional_quantities(owner: type) -> tuple[Quantity, ...]:
    """Quantities of a class, and of its nested ones, that have a condition."""
    return tuple(quantity for quantity in quantities(owner) if quantity.condition is not None)


def build_declared(owner: type[T], values: Mapping[str, Any], *, section: str = "", **parts: Any) -> T:
    """Build a dataclass and its nested dataclasses from values by name, in the units of the names.

    values: values that are within their ranges; a missing one or None gives the default.
    section: section that is put before names without one.
    parts: values of fields in SI, which override `values`.
    """
    several: dict[str, list[tuple[int, Any]]] = {}
    for quantity in own_quantities(owner):
        value = values.get(_full_key(section, quantity.name))
        if isinstance(quantity, Word):
            continue
        if quantity.index is not None:
            several.setdefault(quantity.field, []).append(
                (quantity.index, quantity.in_si(quantity.default if value is None else value))
            )
        elif value is not None:
            parts.setdefault(quantity.field, quantity.in_si(value))
    for slot in _slots_of(owner):
        if len(slot.parts) == 1 and slot.field.name not in parts:
            parts[slot.field.name] = build_declared(slot.parts[0], values, section=slot.section.name)
    for name, entries in several.items():
        parts.setdefault(name, tuple(value for _, value in sorted(entries)))
    return owner(**parts)


def replace_declared(thing: T, values: Mapping[str, Any], *, section: str = "") -> T:
    """Copy of a dataclass with other values by name, in the units of the names; also in nested dataclasses.

    >>> @dataclass(frozen=True)
    ... class Step:
    ...     length: Annotated[float, Quantity("solver.step_ms", "time step")]
    >>> replace_declared(Step(0.5e-3), {"solver.step_ms": 2.0})
    Step(length=0.002)
    """
    parts: dict[str, Any] = {}
    for slot in _slots_of(type(thing)):
        current = getattr(thing, slot.field.name)
        for quantity in slot.own:
            name = _full_key(section, quantity.name)
            if isinstance(quantity, Word) or name not in values:
                condition = quantity.condition
                if condition is not None and condition.key in values and not condition.holds(values[condition.key]):
                    parts[slot.field.name] = slot.field.default  # any other value would have no effect
                continue
            value = quantity.in_si(quantity.in_range(values[name]))
            if quantity.index is None:
                parts[slot.field.name] = value
            else:
                several = list(parts.get(slot.field.name, current))
                several[quantity.index] = value
                parts[slot.field.name] = tuple(several)
        if slot.parts and current is not None:
            inside = replace_declared(current, values, section=slot.section.name)
            if inside is not current:
                parts[slot.field.name] = inside
    return replace(thing, **parts) if parts else thing  # type: ignore[type-var]


def values_of(thing: Any, *, section: str = "") -> dict[str, Any]:
    """Values of all quantities of a dataclass and of nested ones, by name, in the units of the names."""
    values: dict[str, Any] = {}
    for slot in _slots_of(type(thing)):
        value = getattr(thing, slot.field.name)
        for quantity in slot.own:
            single = value if quantity.index is None else value[quantity.index]
            values[_full_key(section, quantity.name)] = (
                quantity.word_of(value) if isinstance(quantity, Word) else quantity.in_unit(single)
            )
        if slot.parts and value is not None:
            values |= values_of(value, section=slot.section.name)
    return values


_WIDEST: Final = 160
"""Characters of a line of a text of `Declared`."""


class Declared:
    """Base class of dataclasses with declared quantities: the constructor checks them, the repr lists them with units.

    >>> @dataclass(frozen=True, repr=False)
    ... class Step(Declared):
    ...     length: Annotated[float, Quantity("solver.step_ms", "time step")] = 0.5e-3
    >>> Step()
    <Step: step_ms = 0.5>
    """

    __slots__ = ()

    def __post_init__(self) -> None:
        require_declared(self)

    def __repr__(self) -> str:
        pairs = ((name.rpartition(".")[2], value) for name, value in values_of(self).items() if value is not None)
        glue = "\xa0"  # a name stays beside its value
        values = ", ".join(f"{name} = {_short_text(value)}".replace(" ", glue) for name, value in pairs)
        lines = textwrap.wrap(f"<{type(self).__name__}: {values}>", _WIDEST, subsequent_indent="    ")
        return "\n".join(lines).replace(glue, " ")


def _short_text(value: Any) -> str:
    """Text of a value with 6 digits for floats, also in lists."""
    if isinstance(value, list):
        return f"[{', '.join(map(_short_text, value))}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _full_key(section: str, name: str) -> str:
    """Name with its section; unchanged if there is no section or it already has one."""
    return f"{section}.{name}" if section and "." not in name else name


_SLOTS: dict[type, tuple[_Slot, ...]] = {}


def _slots_of(owner: type) -> tuple[_Slot, ...]:
    """Fields of a dataclass with their declared quantities, computed once per class."""
    if owner not in _SLOTS:
        _SLOTS[owner] = tuple(_make_slot(owner, field) for field in fields(owner) if field.init)
    return _SLOTS[owner]


def _make_slot(owner: type, field: Field[Any]) -> _Slot:
    """A dataclass field with its quantities, nested classes, section, and whether None is allowed."""
    hint = field.type
    if isinstance(hint, str):  # postponed; `get_type_hints` needs all names, also those imported for type checking only
        hint = eval(hint, dict(vars(sys.modules[owner.__module__])))
    marks = hint.__metadata__ if get_origin(hint) is Annotated else ()
    plain = get_args(hint)[0] if marks else hint
    members = get_args(plain) if get_origin(plain) in (Union, UnionType) else (plain,)
    section = next((mark for mark in marks if isinstance(mark, Section)), Section(""))
    declared = [mark for mark in marks if isinstance(mark, Quantity)]
    otherwise = any(isinstance(declaration, Word) for declaration in declared)
    needed = not otherwise and field.default is MISSING and field.default_factory is MISSING and NoneType not in members
    inside = () if APART in marks else members
    parts = tuple(
        declaration
        for declaration in inside
        if isinstance(declaration, type) and is_dataclass(declaration) and quantities(declaration)
    )
    own = tuple(
        mark if isinstance(mark, Word) else _completed_quantity(mark, marks, field, members, needed)
        for mark in declared
    )
    section = section._replace(otherwise=section.otherwise or otherwise)
    return _Slot(field, own, parts, section, NoneType in members)


_KINDS: Final[dict[Any, Kind]] = {
    float: "number",
    int: "whole number",
    str: "text",
    bool: "switch",
    tuple[float, ...]: "numbers",
    tuple[float, float, float]: "three numbers",
}


def _completed_quantity(
    quantity: Quantity, marks: tuple[Any, ...], field: Field[Any], members: tuple[Any, ...], needed: bool
) -> Quantity:
    """Copy of a quantity, completed with range, label and more of its annotation, and kind and default of its field."""
    (type_,) = (member for member in members if member is not NoneType)
    choices = get_args(type_) if get_origin(type_) is Literal else ()
    kind = "text" if choices else "number" if quantity.index is not None else _KINDS[type_]
    default = quantity.default
    details: dict[str, Any] = {}
    for mark in marks:
        if isinstance(mark, Label | Allowed):
            details |= mark._asdict()
        elif isinstance(mark, Condition | Search):
            details[type(mark).__name__.lower()] = mark
    resolved = replace(
        quantity,
        kind=kind,
        choices=choices,
        field=field.name,
        needed=quantity.needed and needed and default is None,
        **details,
    )
    if default is None and field.default is not MISSING:
        return replace(resolved, default=resolved.in_unit(field.default))
    return resolved


def checked_table(
    owner: type, table: Mapping[str, Any], place: str, *, further: Collection[str] = ()
) -> dict[str, Any]:
    """Checked values of a table of a file by key, without its `further` keys; an error for unknown or missing keys.

    owner: dataclass that declares the keys; `build_declared` makes one from the result.
    place: place of the table, for messages.
    further: other allowed keys, which the caller reads.
    """
    keys = {quantity.name: quantity for quantity in own_quantities(owner)}
    for name in table:
        if name not in keys and name not in further:
            raise ParameterError("{place}: unknown name {name!r}. {allowed}").tag(
                "unknown_name", place=place, name=name, allowed=suggest_and_list(name, (*keys, *further))
            )
    for name, key in keys.items():
        if key.needed and name not in table:
            raise ParameterError("{place}: {name} is missing: {meaning}").tag(
                "missing", place=place, name=name, meaning=key.meaning
            )
    try:
        return {name: keys[name].in_range(value) for name, value in table.items() if name in keys}
    except ParameterError as error:
        raise error.at(place) from error
