"""JSON of users, and the program's own JSON, which may be damaged."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import MISSING, fields
from types import NoneType, UnionType
from typing import TYPE_CHECKING, Any, Final, Literal, TypeVar, get_args, get_origin, get_type_hints

from .text_files import LARGEST_WHOLE, ContentError, plain_text, require_sound, shown, too_deep

if TYPE_CHECKING:
    from pathlib import Path

    from _typeshed import DataclassInstance

MOST_JSON_BYTES: Final = 1 << 26
_MOST_DIGITS: Final = len(str(LARGEST_WHOLE)) + 1


def read_json(path: str | Path, *, most_bytes: int = MOST_JSON_BYTES) -> Any:
    """Read a JSON file in UTF-8."""
    return json_value(plain_text(path, most_bytes=most_bytes), title=str(path))


def json_value(text: str | bytes, *, title: str = "") -> Any:
    """Parse a JSON text of a user within limits.

    Raises ContentError: the text is not JSON (NaN and infinite numbers included), exceeds a limit (nesting, digits of a
        number, length of a text), repeats a key of an object, or contains an invalid character.
    """
    try:
        value = json.loads(text, object_pairs_hook=_checked_dict, parse_int=_integer, parse_constant=_refuse_constant)
        require_sound(value, infinite=False)
    except ContentError as error:
        raise error.of(title) from None
    except RecursionError:
        raise too_deep().of(title) from None
    except ValueError as error:
        raise ContentError("This is not JSON text: {reason}. Correct that place.", title=title).tag(
            "not_json", reason=str(error)
        ) from error
    return value


def own_json(text: str | bytes) -> Any:
    """Parse a JSON text that skisnow wrote: without limits, and numbers may be infinite."""
    return json.loads(text)


def _checked_dict(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Dictionary of an object's pairs; rejects a repeated key."""
    entries = dict(pairs)
    if len(entries) != len(pairs):
        twice = Counter(key for key, _ in pairs).most_common(1)[0][0]
        raise ContentError("the key {key} is twice in one object. Remove one.").tag("repeated_key", key=shown(twice))
    return entries


def _integer(digits: str) -> int:
    """Whole number of a JSON text; rejects too many digits."""
    if len(digits) > _MOST_DIGITS:
        raise ContentError("a whole number has {count} digits; allowed is ±{largest}. Correct it.").tag(
            "number_too_large", count=len(digits), largest=LARGEST_WHOLE
        )
    return int(digits)


def _refuse_constant(word: str) -> None:
    """Reject NaN and infinities, which are not JSON."""
    raise ContentError("{word} is not a number of JSON. Write null or a finite number.").tag("not_json", word=word)


T = TypeVar("T", bound="DataclassInstance")


def read_record(path: str | Path, kind: type[T]) -> T:
    """Read a JSON object into a dataclass of texts, numbers, switches and mappings of those; other keys are ignored."""
    values = read_json(path)
    if not isinstance(values, dict):
        raise ContentError("{path} is damaged: it is not a JSON object. Remove it.").tag("damaged", path=path)
    hints = get_type_hints(kind)
    for entry in fields(kind):
        optional = entry.default is not MISSING or entry.default_factory is not MISSING
        if entry.name not in values and not optional:
            raise ContentError("{path} is damaged: the key {key} is missing. Remove it.").tag(
                "damaged", path=path, key=entry.name
            )
        if entry.name in values and not _matches_hint(values[entry.name], hints[entry.name]):
            raise ContentError("{path} is damaged: {key} is {value!r}, of another type. Remove it.").tag(
                "damaged", path=path, key=entry.name, value=str(values[entry.name])[:60]
            )
    return kind(**{name: value for name, value in values.items() if name in hints})


def _matches_hint(value: object, hint: Any) -> bool:
    """True if a JSON value has the type of a hint: union, literal, mapping or class; an int is also a float."""
    origin = get_origin(hint)
    if origin is UnionType:
        return any(_matches_hint(value, argument) for argument in get_args(hint))
    if origin is Literal:
        return isinstance(value, str) and value in get_args(hint)
    if origin is not None and issubclass(origin, Mapping):
        _, inner = get_args(hint)
        return isinstance(value, dict) and all(_matches_hint(entry, inner) for entry in value.values())
    if hint is float:
        return isinstance(value, int | float) and not isinstance(value, bool)
    if hint is int:
        return isinstance(value, int) and not isinstance(value, bool)
    return value is None if hint is NoneType else isinstance(value, hint)


def json_number(value: float | None) -> float | None:
    """Number as float for JSON; None for None, NaN and infinity.

    >>> json_number(2), json_number(math.inf), json_number(math.nan), json_number(None)
    (2.0, None, None, None)
    """
    return None if value is None or not math.isfinite(value) else float(value)
