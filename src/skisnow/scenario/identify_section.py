"""The section ``[identify]`` of a scenario's file: what may be looked for. A run does not heed it, but reads it."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Final

from .._support.errors import ParameterError
from ..parameters import Quantity, checked_table, nearest, quantities
from .keys import free_key


@dataclass(frozen=True, slots=True, kw_only=True)
class Sought:
    """What may stand in ``[identify."KEY"]``, in the unit of that key."""

    start: Annotated[float | None, Quantity("start", "where the search begins; left out: the scenario's value")] = None
    lower: Annotated[float | None, Quantity("lower", "bound")] = None
    upper: Annotated[float | None, Quantity("upper", "bound")] = None
    prior_mean: Annotated[
        float | None, Quantity("prior_mean", "mean of what is known of it, a normal distribution")
    ] = None
    prior_sd: Annotated[float | None, Quantity("prior_sd", "its standard deviation", lowest=0.0, above=True)] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Site:
    """What may stand in ``[identify.site]``, in the units that the names say."""

    fall_line_azimuth_deg: Annotated[
        float, Quantity("fall_line_azimuth_deg", "compass direction in which the slope falls")
    ]
    latitude_deg: Annotated[float | None, Quantity("latitude_deg", "where x = y = 0 is")] = None
    longitude_deg: Annotated[float | None, Quantity("longitude_deg", "where x = y = 0 is")] = None
    height_m: Annotated[float | None, Quantity("height_m", "of that place above the ellipsoid")] = None


GIVEN: Final = tuple(each.name for each in quantities(Sought))
NO_KEYS: Final = ("runs", "site", "clock")
"""Entries of ``[identify]`` that are no parameters."""
SITE: Final = tuple(each.name for each in quantities(Site))
CLOCKS: Final = ("start", "free")


def require_known(section: Mapping[str, Any]) -> None:
    """Refuse what nobody would read: a key that is misspelt, or that belongs into another section.

    Raises
    ------
    ParameterError
        The nearest name, or where the key belongs, is named.
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
        found[key] = checked_table(Sought, table, f'[identify."{key}"]')
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
