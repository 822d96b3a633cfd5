"""The section ``[identify]`` of a scenario's file: what may be looked for. A run does not heed it, but reads it."""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping
from typing import Any, Final

from ...errors import ParameterError
from ..input_keys import nearest
from .free_keys import free_key

GIVEN: Final = ("start", "lower", "upper", "prior_mean", "prior_sd")
"""What may stand in ``[identify."KEY"]``."""
NO_KEYS: Final = ("runs", "site", "clock")
"""Entries of ``[identify]`` that are no parameters."""
SITE: Final = ("fall_line_azimuth_deg", "latitude_deg", "longitude_deg", "height_m")
"""What may stand in ``[identify.site]``."""
CLOCKS: Final = ("start", "free")


def require_known(section: Mapping[str, Any]) -> None:
    """Refuse what nobody would read: a key that is misspelt, or that belongs into another section.

    Raises
    ------
    ParameterError
        The nearest name, or where the key belongs, is told.
    """
    given_parameters(section)
    clock = section.get("clock", "start")
    if clock not in CLOCKS:
        raise ParameterError(f'[identify] clock is {clock!r}; it must be "start" or "free"')
    for name in _table(section, "site"):
        if name not in SITE:
            raise ParameterError(f"[identify.site]: there is no {name!r}. {nearest(name, SITE)}")
    for run, entries in _table(section, "runs").items():
        if not isinstance(entries, dict):
            raise ParameterError(f'identify.runs."{run}" is {entries!r}; it must be a table of keys')
        for word in entries:
            _key(word, f'[identify.runs."{run}"]')


def given_parameters(section: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """The tables ``[identify."KEY"]`` by full key.

    Raises
    ------
    ParameterError
        A key or a word is unknown (near ones are named), or a value is no finite number.
    """
    found: dict[str, dict[str, float]] = {}
    for word, table in section.items():
        if word in NO_KEYS:
            continue
        own, at, run = word.partition("@")
        key = _key(own, f'[identify."{word}"]', _no_key_meant(word)) + at + run
        if not isinstance(table, dict):
            raise ParameterError(
                f'identify."{word}" is {table!r}; it must be a table with {", ".join(GIVEN)}, begun by the line '
                f'[identify."{key}"]. A value of the scenario stands in its own section, [{key.partition(".")[0]}]'
            )
        found[key] = {name: _number(key, name, value) for name, value in table.items()}
    return found


def _key(word: str, place: str, meant: str = "") -> str:
    try:
        return free_key(word)
    except ParameterError as error:
        raise ParameterError(f"{place}: {str(error).removeprefix('--free: ')}{meant}") from None


def _no_key_meant(word: str) -> str:
    near = difflib.get_close_matches(word.lower(), NO_KEYS, n=1, cutoff=0.6)
    return f". Or is {near[0]} meant?" if near else ""


def _table(section: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    table = section.get(name, {})
    if not isinstance(table, dict):
        what = f"[identify.{name}]" if name == "site" else f'[identify.{name}."NAME"]'
        raise ParameterError(f"identify.{name} is {table!r}; it must be a table, begun by the line {what}")
    return table


def _number(key: str, name: str, value: object) -> float:
    if name not in GIVEN:
        raise ParameterError(f'[identify."{key}"]: there is no {name!r}. {nearest(name, GIVEN)}')
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ParameterError(f'[identify."{key}"]: {name} is {value!r}; it must be a finite number')
    return float(value)
