"""TOML of users: a campaign, a scenario, a ski, a study, one value on the command line."""

from __future__ import annotations

import re
import tomllib
from typing import TYPE_CHECKING, Any, Final

from ..messages import Message
from .plain_file import GivenError, plain_text
from .sound_values import DEEPEST, LONGEST_KEY, require_sound, too_deep

if TYPE_CHECKING:
    from pathlib import Path

MOST_TOML_BYTES: Final = 1 << 20
MOST_DOTS: Final = 16

_TOKENS: Final = re.compile(
    r'"""(?s:\\.|[^\\])*?(?:"{3,5}|\Z)'
    r"|'''(?s:.)*?(?:'{3,5}|\Z)"
    r'|"(?:[^"\\\n]|\\.)*+"?'
    r"|'[^'\n]*+'?"
    r"|\#[^\n]*+"
    r"|[\[\]{}=,\n]"
    r"|[\w+.:-]+"
)


def read_toml(path: str | Path) -> dict[str, Any]:
    """Read a TOML file in UTF-8.

    Raises
    ------
    GivenError
        As in `plain_text` and `toml_values`.
    """
    return toml_values(plain_text(path, most_bytes=MOST_TOML_BYTES), title=str(path))


def toml_values(text: str, *, title: str = "") -> dict[str, Any]:
    """The keys and values of a TOML text.

    Parameters
    ----------
    text
        With line feeds at the ends of lines.
    title
        What it is called by in messages.

    Raises
    ------
    GivenError
        It is no TOML, or beyond a limit: size, nesting, dots in a key, digits of a number, length of a text; or a text
        has a character that none can have.
    """
    try:
        if len(text) > MOST_TOML_BYTES:
            raise GivenError(
                Message(
                    "the text has {count} characters; allowed are {longest}.",
                    count=len(text),
                    longest=MOST_TOML_BYTES,
                ),
                code="too_large",
            )
        _require_short(text)
        values = tomllib.loads(text)
        require_sound(values, infinite=True)
    except GivenError as error:
        raise error.of(title) from None
    except RecursionError:
        raise too_deep().of(title) from None
    except ValueError as error:  # TOMLDecodeError, and dates that there are not
        line = re.search(r"at line (\d+)", str(error))
        sentence = (
            Message("{file} is not TOML: {reason}. Correct that place.", file=title, reason=str(error))
            if title
            else Message("This is not TOML: {reason}. Correct that place.", reason=str(error))
        )
        raise GivenError(str(error), code="not_toml", line=int(line[1]) if line else None, sentence=sentence) from error
    return values


def _require_short(text: str) -> None:
    """Look at brackets, words and dots before the parser, whose memory grows with the square of a key's dots."""
    depth = dots = 0
    for token in _TOKENS.finditer(text):
        word = token[0]
        first = word[0]
        if first in "[{":
            depth += 1
            if depth > DEEPEST:
                raise too_deep(_line(text, token))
        elif first in "]}":
            depth -= 1
        if first in "[]{}=,\n":
            dots = 0
        elif first not in "\"'#":
            dots += word.count(".")
            if dots > MOST_DOTS:
                raise GivenError(
                    Message("a key has more than {count} dots. Shorten it.", count=MOST_DOTS),
                    line=_line(text, token),
                    code="key_too_long",
                )
            if len(word) > LONGEST_KEY:
                problem = Message(
                    "A number or key has {count} characters; allowed are {longest}. Shorten it.",
                    count=len(word),
                    longest=LONGEST_KEY,
                )
                raise GivenError(problem, code="key_too_long", line=_line(text, token))


def _line(text: str, token: re.Match[str]) -> int:
    return text.count("\n", 0, token.start()) + 1
