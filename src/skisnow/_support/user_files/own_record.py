"""JSON files of the program's own, read into dataclasses: a damaged one is an error that names the key."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, fields
from types import NoneType, UnionType
from typing import TYPE_CHECKING, Any, Literal, TypeVar, get_args, get_origin, get_type_hints

from .errors import GivenError
from .json_text import read_json

if TYPE_CHECKING:
    from pathlib import Path

    from _typeshed import DataclassInstance

T = TypeVar("T", bound="DataclassInstance")


def read_record(path: str | Path, kind: type[T], *, only_known: bool = True) -> T:
    """Read a JSON object into a dataclass of texts, numbers, switches and mappings of those.

    Parameters
    ----------
    path
        The file.
    kind
        The dataclass; keys are the names of its fields.
    only_known
        Reject keys that are not fields; False: ignore them.

    Raises
    ------
    GivenError
        The file cannot be read, or a key is missing, unknown or of another type.
    """
    values = read_json(path)
    if not isinstance(values, dict):
        raise GivenError(f"{path} is damaged: it is not a JSON object. Remove it.")
    hints = get_type_hints(kind)
    for name in values if only_known else ():
        if name not in hints:
            raise GivenError(f"{path} is damaged: {name[:60]!r} is not one of its keys. Remove it.")
    known = {name: value for name, value in values.items() if name in hints}
    for field in fields(kind):
        if field.name not in known and field.default is MISSING and field.default_factory is MISSING:
            raise GivenError(f"{path} is damaged: the key {field.name} is missing. Remove it.")
    for name, value in known.items():
        if not _fits(value, hints[name]):
            raise GivenError(f"{path} is damaged: {name} is {str(value)[:60]!r}, of another type. Remove it.")
    return kind(**known)


def _fits(value: object, hint: Any) -> bool:
    origin = get_origin(hint)
    if origin is UnionType:
        return any(_fits(value, each) for each in get_args(hint))
    if origin is Literal:
        return isinstance(value, str) and value in get_args(hint)
    if origin is not None and issubclass(origin, Mapping):
        _, inner = get_args(hint)
        return isinstance(value, dict) and all(_fits(each, inner) for each in value.values())
    if hint is float:
        return isinstance(value, int | float) and not isinstance(value, bool)
    if hint is int:
        return isinstance(value, int) and not isinstance(value, bool)
    return value is None if hint is NoneType else isinstance(value, hint)
