"""The built-in scenarios: files of the package, with the defaults that they do not name."""

from __future__ import annotations

import json
import re
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Final

from .._support.errors import ParameterError
from .._support.user_files import toml_values
from ..parameters import nearest
from .keys import SCENARIO_KEYS, SECTIONS
from .resolution import COMPANIONS

_FOLDER: Final = files(__package__) / "catalogue"
_COMMENTS_FROM: Final = 40
_BY_PRESENCE: Final = ("skier",)
"""Sections that a scenario has or has not: their defaults count where it has them."""
_SECTION: Final = re.compile(r"^\[(\w+)\]\n", re.MULTILINE)


def scenario_names() -> tuple[str, ...]:
    """Names of the built-in scenarios.

    Returns
    -------
    tuple of str
        What `skisnow.scenario` takes.

    See Also
    --------
    skisnow.scenario : the scenario of a name.

    References
    ----------
    The page docs/files/scenario.md.

    Examples
    --------
    >>> [name for name in scenario_names() if "deg" not in name]
    ['carved-46m', 'carver-42m', 'giant-slalom-20-gates', 'giant-slalom-67m', 'slalom-20-gates']
    """
    there = (entry.name for entry in _FOLDER.iterdir())
    return tuple(sorted(name.removesuffix(".toml") for name in there if name.endswith(".toml")))


def scenario_place(name: str) -> Path:
    """Where a built-in scenario lies."""
    return Path(str(_FOLDER / f"{name}.toml"))


@cache
def scenario_text(name: str) -> str:
    """The text of a built-in scenario, every key with where its value comes from, defaults behind what the file names.

    Raises
    ------
    ParameterError
        There is no such scenario; the nearest is named.
    """
    if name not in scenario_names():
        raise ParameterError(f"there is no built-in scenario {name!r}. {nearest(name, scenario_names())}")
    text = (_FOLDER / f"{name}.toml").read_text(encoding="utf-8")
    head, *parts = _SECTION.split(text)
    written = dict(zip(parts[::2], parts[1::2], strict=True))
    defaults = _defaults(text)
    there = (each for each in SECTIONS if each in written or (defaults[each] and each not in _BY_PRESENCE))
    sections = (f"[{each}]\n{written.get(each, '').rstrip()}\n{defaults[each]}" for each in there)
    return head + "\n".join(section.replace("]\n\n", "]\n") for section in sections)


def _defaults(text: str) -> dict[str, str]:
    """By section, the lines of the keys that the text does not name and that have a default."""
    given = {f"{section}.{key}": value for section, table in toml_values(text).items() for key, value in table.items()}
    values = {name: key.default for name, key in SCENARIO_KEYS.items()} | given
    unused = {name for name, (main, needed) in COMPANIONS.items() if values[main] != needed}
    lines = dict.fromkeys(SECTIONS, "")
    for name, key in SCENARIO_KEYS.items():
        if key.default is not None and name not in given and name not in unused:
            section, own = name.split(".")
            line = f"{own} = {json.dumps(key.default)}"
            lines[section] += f"{line:<{_COMMENTS_FROM}}# default, {key.origin}\n"
    return lines
