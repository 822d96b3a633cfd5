"""The keys of a scenario: their names in files, on the command line, in studies and in JSON, and values as given."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Final

from .._support.errors import ParameterError
from .._support.spreadsheet_text import is_number
from .._support.user_files import GivenError, toml_values
from ..parameters import InputValue, Word, meant, quantities
from .scenario import Scenario

SCENARIO_KEYS: Final = {key.name: key for key in quantities(Scenario)}
"""Quantities by full name (section.key), in the order of tables."""

SECTIONS: Final = tuple(dict.fromkeys(name.split(".")[0] for name in SCENARIO_KEYS))

PATH_KEYS: Final = tuple(name for name, key in SCENARIO_KEYS.items() if isinstance(key, Word) and key.names_file)
"""Keys whose value is the path of a file."""

_FULL_NAMES: Final = {name.split(".")[1]: name for name in SCENARIO_KEYS}


def full_name(name: str) -> str:
    """Full name of a key with or without its section.

    Raises
    ------
    ParameterError
        Unknown key; the message suggests the nearest one.

    Examples
    --------
    >>> full_name("mass_kg")
    'sledge.mass_kg'
    """
    if name in SCENARIO_KEYS:
        return name
    section, _, key = name.rpartition(".")
    if not section and key in _FULL_NAMES:
        return _FULL_NAMES[key]
    if key in _FULL_NAMES:
        raise ParameterError(f"{name} is no key of a scenario. Is {_FULL_NAMES[key]} meant?")
    keys = [full for full in SCENARIO_KEYS if full.startswith(f"{section}.")] if section in SECTIONS else []
    raise ParameterError(f"{name} is no key of a scenario. {_suggestion(name, key, keys)}".strip())


def _suggestion(name: str, key: str, keys: Iterable[str]) -> str:
    candidates = list(keys)
    question = meant(name, candidates or SCENARIO_KEYS) or meant(key, _FULL_NAMES)
    return f"{question}There are {', '.join(candidates)}" if candidates else question


def flatten_sections(sections: Mapping[str, Any]) -> dict[str, object]:
    """Values of a file by full name; unknown sections and keys are errors."""
    values: dict[str, object] = {}
    for section, table in sections.items():
        if section not in SECTIONS:
            raise ParameterError(
                f"there is no section [{section}]. {meant(section, SECTIONS)}There are {', '.join(SECTIONS)}"
            )
        if not isinstance(table, dict):
            raise ParameterError(f"{section} is {table!r}; it must be a table, begun by the line [{section}]")
        values.update({full_name(f"{section}.{key}"): value for key, value in table.items()})
    return values


def validate(values: Mapping[str, object]) -> dict[str, InputValue]:
    """Values by full name, each of the right kind and in its range.

    Raises
    ------
    ParameterError
        Unknown key, wrong kind, or value outside its range.
    """
    named = {full_name(name): value for name, value in values.items()}
    return {name: SCENARIO_KEYS[name].in_range(value) for name, value in named.items()}


def parse_change(text: str) -> tuple[str, object]:
    """Full name and value of ``section.key=value``; the value is TOML, a text needs no quotes.

    Raises
    ------
    ParameterError
        No equals sign, or unknown key.

    Examples
    --------
    >>> parse_change("snow.published=race-piste"), parse_change("inertia_kg_m2=[6, 8, 10]")
    (('snow.published', 'race-piste'), ('sledge.inertia_kg_m2', [6, 8, 10]))
    """
    name, equals, value_text = (part.strip() for part in text.partition("="))
    if not equals:
        raise ParameterError(f"{text!r} changes nothing; write section.key=value, such as sledge.edge_angle_deg=35")
    name = full_name(name)
    is_text = SCENARIO_KEYS[name].kind == "text"
    try:
        values = toml_values(f"value = {value_text}")
    except GivenError:
        if not is_text and "," in value_text and is_number(value_text, ","):
            corrected = text.replace(value_text, value_text.replace(",", "."))
            raise ParameterError(
                f"{text!r}: numbers are written with a decimal point here. Write {corrected}"
            ) from None
        return name, value_text
    value = values["value"] if values.keys() == {"value"} else value_text  # a second line is not part of the value
    return name, value_text if is_text and not isinstance(value, str) else value
