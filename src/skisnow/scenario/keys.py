"""Keys of a scenario: names, values in the units of the names, short forms, keys that an identification may vary."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Final

from .._support.errors import ParameterError, most_similar, suggest_and_list
from .._support.messages import Message, joined
from .._support.spreadsheet_text import is_number
from .._support.units import without_unit
from .._support.user_files.text_files import ContentError, toml_values
from ..parameters import InputValue, Word, quantities, values_of
from .scenario import Scenario

SCENARIO_KEYS: Final = {key.name: key for key in quantities(Scenario)}
"""Quantities by full name (section.key), in the order of tables."""

SECTIONS: Final = tuple(dict.fromkeys(name.split(".")[0] for name in SCENARIO_KEYS))

PATH_KEYS: Final = tuple(name for name, key in SCENARIO_KEYS.items() if isinstance(key, Word) and key.names_file)
"""Keys whose value is the path of a file."""

_FULL_NAMES: Final = {name.split(".")[1]: name for name in SCENARIO_KEYS}


def full_name(name: str) -> str:
    """Full name of a scenario key, given with or without its section; ParameterError if it is unknown.

    >>> full_name("mass_kg")
    'sledge.mass_kg'
    """
    if name in SCENARIO_KEYS:
        return name
    section, _, key = name.rpartition(".")
    if not section and key in _FULL_NAMES:
        return _FULL_NAMES[key]
    if key in _FULL_NAMES:
        raise ParameterError("{name} is not a key of a scenario. Did you mean {similar}?").tag(
            "unknown_name", name=name, similar=_FULL_NAMES[key]
        )
    keys = [full for full in SCENARIO_KEYS if full.startswith(f"{section}.")] if section in SECTIONS else []
    short = most_similar(key, _FULL_NAMES)
    similar = most_similar(name, keys) or (_FULL_NAMES[short] if short else most_similar(name, SCENARIO_KEYS))
    sentences = [Message("{name} is not a key of a scenario.", name=name)]
    if similar:
        sentences.append(Message("Did you mean {similar}?", similar=similar))
    if keys:
        sentences.append(Message("Allowed: {allowed}.", allowed=keys))
    raise ParameterError(joined(sentences)).tag("unknown_name")


def flatten_sections(sections: Mapping[str, Any]) -> dict[str, object]:
    """Values of a file by full name; unknown sections and keys are errors."""
    values: dict[str, object] = {}
    for section, table in sections.items():
        if section not in SECTIONS:
            raise ParameterError("unknown section [{section}]. {allowed}").tag(
                "missing", section=section, allowed=suggest_and_list(section, SECTIONS)
            )
        if not isinstance(table, dict):
            raise ParameterError("{section} is {table!r}; it must be a table, begun by the line [{section}]").tag(
                "wrong_kind", section=section, table=table
            )
        values.update({full_name(f"{section}.{key}"): value for key, value in table.items()})
    return values


def validate(values: Mapping[str, object]) -> dict[str, InputValue]:
    """Values by full name, each of the right kind and in its range."""
    named = {full_name(name): value for name, value in values.items()}
    return {name: SCENARIO_KEYS[name].in_range(value) for name, value in named.items()}


def parse_change(text: str) -> tuple[str, object]:
    """Full name and value of ``section.key=value``; the value is TOML, a text needs no quotes.

    >>> parse_change("snow.published=race-piste"), parse_change("inertia_kg_m2=[6, 8, 10]")
    (('snow.published', 'race-piste'), ('sledge.inertia_kg_m2', [6, 8, 10]))
    """
    name, equals, value_text = (part.strip() for part in text.partition("="))
    if not equals or not name:
        raise ParameterError("{text!r} changes nothing; write section.key=value, such as sledge.edge_angle_deg=35").tag(
            "changes_nothing", text=text
        )
    name = full_name(name)
    is_text = SCENARIO_KEYS[name].kind == "text"
    try:
        values = toml_values(f"value = {value_text}")
    except ContentError:
        if not is_text and "," in value_text and is_number(value_text, ","):
            corrected = text.replace(value_text, value_text.replace(",", "."))
            raise ParameterError("{text!r}: numbers are written with a decimal point here. Write {corrected}").tag(
                "not_a_number", text=text, corrected=corrected
            ) from None
        return name, value_text
    value = values["value"] if values.keys() == {"value"} else value_text  # a second line is not part of the value
    return name, value_text if is_text and not isinstance(value, str) else value


def scenario_values(scenario: Scenario) -> dict[str, Any]:
    """Every key of `SCENARIO_KEYS` with the value in force; None where the scenario does not have it.

    Also of a scenario that was built in Python: its snow appears as numbers; a ski that is not in the catalogue and a
    profile appear with their name and source.
    """
    values = values_of(scenario)
    return {name: values.get(name) for name in SCENARIO_KEYS}


def in_sections(values: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Values under full names as sections, like a scenario's file.

    >>> in_sections({"snow.site": "A", "run.duration_s": 5.0})
    {'snow': {'site': 'A'}, 'run': {'duration_s': 5.0}}
    """
    sections: dict[str, dict[str, Any]] = {}
    for name, value in values.items():
        section, key = name.split(".")
        sections.setdefault(section, {})[key] = value
    return sections


_HOW_IT_IS_COMPUTED: Final = ("run.", "solver.", "course.")

EACH: Final = "each"
"""Word behind an ``@``: a separate value for each run."""
FREE_KEYS: Final = tuple(
    name for name, key in SCENARIO_KEYS.items() if key.kind == "number" and not name.startswith(_HOW_IT_IS_COMPUTED)
)
"""Keys that may be looked for: numbers of slope, snow, friction, drag, sledge, ski and start."""


def short_name(key: str) -> str:
    """A key without section and unit; a run that it belongs to stays.

    >>> short_name("snow.S_f_N_per_mm2"), short_name("start.speed_m_per_s@second")
    ('S_f', 'speed@second')
    """
    own, at, run = key.partition("@")
    return without_unit(own.partition(".")[2]) + at + run


_KEYS_BY_WORD: Final[dict[str, list[str]]] = {}
for _key in SCENARIO_KEYS:
    _bare = _key.partition(".")[2]
    for _word in dict.fromkeys((_key, _bare, without_unit(_key), without_unit(_bare))):
        _KEYS_BY_WORD.setdefault(_word, []).append(_key)


def free_key(word: str) -> str:
    """Full key of the scenario that a word means, such as a name without section or unit.

    >>> free_key("S_f"), free_key("drag_area"), free_key("friction.mu_0"), free_key("start.heading_deg")
    ('snow.S_f_N_per_mm2', 'drag.drag_area_m2', 'friction.mu_0', 'start.heading_deg')
    """
    word = word.strip()
    meant = _KEYS_BY_WORD.get(word, ())
    usable = tuple(key for key in meant if key in FREE_KEYS)
    if len(usable) > 1:
        raise ParameterError("{word} may mean one of {keys}. Write one of them in full").tag(
            "ambiguous", word=word, keys=list(usable)
        )
    if usable:
        return usable[0]
    if meant:
        raise ParameterError("{key} cannot be identified: it is not a number of the run. Allowed: {keys}").tag(
            "not_free", key=meant[0], keys=list(FREE_KEYS)
        )
    raise ParameterError("{word!r} is not a key of a scenario. {allowed}").tag(
        "unknown_name", word=word, allowed=suggest_and_list(word, (key.partition(".")[2] for key in FREE_KEYS))
    )


def free_keys(words: str | Iterable[str]) -> tuple[str, ...]:
    """The keys of a list, or of a text with commas; one that is named twice is refused.

    A word may end in ``@RUN`` for one run of several, or ``@each`` for one value of each run.

    >>> free_keys("mu_0, drag_area@each, mu_1@second")
    ('friction.mu_0', 'drag.drag_area_m2@each', 'friction.mu_1_s_per_m@second')
    """
    listed = words.split(",") if isinstance(words, str) else list(words)
    try:
        keys = []
        for word in filter(str.strip, listed):
            own, at, run = (part.strip() for part in word.partition("@"))
            if at and not run:
                raise ParameterError("behind the @ of {word!r} a run is missing. Name one, or write {own}@{each}").tag(
                    "missing", word=word, own=own, each=EACH
                )
            keys.append(free_key(own) + at + run)
    except ParameterError as error:
        raise error.at("--free") from None
    for key in keys:
        if keys.count(key) > 1:
            raise ParameterError("--free: {key} is named twice. Remove one of them").tag("repeated", key=key)
    return tuple(keys)
