"""JSON of users: results.json, design files of other programs; and the program's own, which may be damaged."""

from __future__ import annotations

import json
from collections import Counter
from typing import TYPE_CHECKING, Any, Final

from .errors import GivenError
from .plain_file import plain_text
from .sound_values import LARGEST_WHOLE, require_sound, shown, too_deep

if TYPE_CHECKING:
    from pathlib import Path

MOST_JSON_BYTES: Final = 1 << 26
_MOST_DIGITS: Final = len(str(LARGEST_WHOLE)) + 1


def read_json(path: str | Path, *, most_bytes: int = MOST_JSON_BYTES) -> Any:
    """Read a JSON file in UTF-8.

    Raises
    ------
    GivenError
        As in `plain_text` and `json_value`.
    """
    return json_value(plain_text(path, most_bytes=most_bytes), title=str(path))


def json_value(text: str | bytes, *, title: str = "") -> Any:
    """The value of a JSON text.

    Raises
    ------
    GivenError
        It is no JSON, NaN and infinite numbers included, or beyond a limit: nesting, digits of a number, length of a
        text; or a key stands twice in an object, or a text has a character that none can have.
    """
    try:
        value = json.loads(text, object_pairs_hook=_object, parse_int=_whole, parse_constant=_refuse_constant)
        require_sound(value, infinite=False)
    except GivenError as error:
        raise error.of(title) from None
    except RecursionError:
        raise too_deep().of(title) from None
    except ValueError as error:
        raise GivenError(f"{title or 'this'} is no JSON text: {error}. Correct that place.") from error
    return value


def own_json(text: str | bytes) -> Any:
    """The value of a JSON text that this program wrote: limits are not looked for, and a number may be infinite.

    Raises
    ------
    ValueError
        It is no JSON.
    """
    return json.loads(text)


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        twice = Counter(key for key, _ in pairs).most_common(1)[0][0]
        raise GivenError(f"the key {shown(twice)} stands twice in one object. Remove one.")
    return found


def _whole(digits: str) -> int:
    if len(digits) > _MOST_DIGITS:
        raise GivenError(f"a whole number has {len(digits)} digits; allowed is ±{LARGEST_WHOLE}. Correct it.")
    return int(digits)


def _refuse_constant(word: str) -> None:
    raise GivenError(f"{word} is no number of JSON. Write null or a finite number.")
