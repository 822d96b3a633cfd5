"""JSON of users: results.json, design files of other programs; and the program's own, which may be damaged."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import MISSING, fields
from types import NoneType, UnionType
from typing import TYPE_CHECKING, Any, Final, Literal, TypeVar, get_args, get_origin, get_type_hints

from ..messages import Message
from .text_files import LARGEST_WHOLE, GivenError, plain_text, require_sound, shown, too_deep

if TYPE_CHECKING:
    from pathlib import Path

    from _typeshed import DataclassInstance

MOST_JSON_BYTES: Final = 1 << 26
_MOST_DIGITS: Final = len(str(LARGEST_WHOLE)) + 1


def read_json(path: str | Path, *, most_bytes: int = MOST_JSON_BYTES) -> Any:
    """Read a JSON file in UTF-8."""
    return json_value(plain_text(path, most_bytes=most_bytes), title=str(path))


def json_value(text: str | bytes, *, title: str = "") -> Any:
    """The value of a JSON text.

    Raises GivenError: the text is not JSON (NaN and infinite numbers included), exceeds a limit (nesting, digits of a
        number, length of a text), repeats a key of an object, or contains an invalid character.
    """
    try:
        value = json.loads(text, object_pairs_hook=_object, parse_int=_whole, parse_constant=_refuse_constant)
        require_sound(value, infinite=False)
    except GivenError as error:
        raise error.of(title) from None
    except RecursionError:
        raise too_deep().of(title) from None
    except ValueError as error:
        sentence = (
            Message("{file} is not JSON text: {reason}. Correct that place.", file=title, reason=str(error))
            if title
            else Message("This is not JSON text: {reason}. Correct that place.", reason=str(error))
        )
        raise GivenError(sentence, code="not_json") from error
    return value


def own_json(text: str | bytes) -> Any:
    """Value of a JSON text that skisnow wrote: without limits, and numbers may be infinite."""
    return json.loads(text)


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    entries = dict(pairs)
    if len(entries) != len(pairs):
        twice = Counter(key for key, _ in pairs).most_common(1)[0][0]
        raise GivenError(
            Message("the key {key} is twice in one object. Remove one.", key=shown(twice)),
            code="repeated_key",
        )
    return entries


def _whole(digits: str) -> int:
    if len(digits) > _MOST_DIGITS:
        raise GivenError(
            Message(
                "a whole number has {count} digits; allowed is ±{largest}. Correct it.",
                count=len(digits),
                largest=LARGEST_WHOLE,
            ),
            code="number_too_large",
        )
    return int(digits)


def _refuse_constant(word: str) -> None:
    raise GivenError(
        Message("{word} is not a number of JSON. Write null or a finite number.", word=word), code="not_json"
    )


T = TypeVar("T", bound="DataclassInstance")


def read_record(path: str | Path, kind: type[T], *, only_known: bool = True) -> T:
    """Read a JSON object into a dataclass of texts, numbers, switches and mappings of those.

    only_known: reject keys that are not fields; False: ignore them.
    """
    values = read_json(path)
    if not isinstance(values, dict):
        raise GivenError(Message("{path} is damaged: it is not a JSON object. Remove it.", path=path), code="damaged")
    hints = get_type_hints(kind)
    for name in values if only_known else ():
        if name not in hints:
            raise GivenError(
                Message("{path} is damaged: {key!r} is not one of its keys. Remove it.", path=path, key=name[:60]),
                code="damaged",
            )
    fields_given = {name: value for name, value in values.items() if name in hints}
    for field in fields(kind):
        if field.name not in fields_given and field.default is MISSING and field.default_factory is MISSING:
            raise GivenError(
                Message("{path} is damaged: the key {key} is missing. Remove it.", path=path, key=field.name),
                code="damaged",
            )
    for name, value in fields_given.items():
        if not _fits(value, hints[name]):
            raise GivenError(
                Message(
                    "{path} is damaged: {key} is {value!r}, of another type. Remove it.",
                    path=path,
                    key=name,
                    value=str(value)[:60],
                ),
                code="damaged",
            )
    return kind(**fields_given)


def _fits(value: object, hint: Any) -> bool:
    origin = get_origin(hint)
    if origin is UnionType:
        return any(_fits(value, argument) for argument in get_args(hint))
    if origin is Literal:
        return isinstance(value, str) and value in get_args(hint)
    if origin is not None and issubclass(origin, Mapping):
        _, inner = get_args(hint)
        return isinstance(value, dict) and all(_fits(entry, inner) for entry in value.values())
    if hint is float:
        return isinstance(value, int | float) and not isinstance(value, bool)
    if hint is int:
        return isinstance(value, int) and not isinstance(value, bool)
    return value is None if hint is NoneType else isinstance(value, hint)


def json_number(value: float | None) -> float | None:
    """The number, or None for numbers that JSON cannot represent.

    >>> json_number(2), json_number(math.inf), json_number(math.nan), json_number(None)
    (2.0, None, None, None)
    """
    return None if value is None or not math.isfinite(value) else float(value)
