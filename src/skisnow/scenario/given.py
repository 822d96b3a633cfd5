"""What a user gives of a scenario: a file or built-in scenario, and changes to it, under the full names of keys."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

from ..errors import ParameterError
from ..given import MOST_TOML_BYTES, GivenError, is_file, plain_text, toml_values
from ..inputs import InputValue, Word, meant, nearest
from ..shown import ShownFields
from ..spreadsheet_text import is_number
from .built_in import scenario_names, scenario_text
from .identify_section import require_known
from .keys import SCENARIO_KEYS, SECTIONS
from .replaced import replaced
from .scenario import Scenario
from .solver import present_method

PATH_KEYS: Final = tuple(name for name, key in SCENARIO_KEYS.items() if isinstance(key, Word) and key.names_file)
"""Keys that name a file."""

MEASURED_TOO: Final = ("snow.unloading_ratio", "snow.shear_displacement_mm")
"""Keys that a campaign may have measured beside H_V and S_f: then snow.results gives them."""

MAPPED_TOO: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")
"""Keys that a snow map may give over the place."""

IDENTIFY: Final = "identify"
"""The section that says what is looked for."""

_BARE: Final = {name.split(".")[1]: name for name in SCENARIO_KEYS}


@dataclass(frozen=True, slots=True, repr=False)
class GivenScenario(ShownFields):
    """Values as given, in the units that the keys name.

    Attributes
    ----------
    title
        The built-in name, or the file's path.
    file
        The file; None where it is built in.
    values
        By full names, each in its range.
    folders
        Where relative paths start, for each key that names a file.
    identify
        The section ``[identify]`` as it stands in the file: what may be looked for, which a run does not heed.
    base
        A scenario that was given as an object; `values` are then the changes to it. None: `values` are all.
    before_results
        Those of `MEASURED_TOO` that stood there before a change gave snow.results: what the campaign measured of them
        comes before them.
    before_map
        Those of `MAPPED_TOO` that stood there before a change gave snow.map_file, which comes before them.
    """

    title: str
    file: Path | None
    values: Mapping[str, InputValue]
    folders: Mapping[str, Path]
    identify: Mapping[str, Any] = field(default_factory=dict)
    base: Scenario | None = None
    before_results: frozenset[str] = frozenset()
    before_map: frozenset[str] = frozenset()

    def path(self, name: str) -> Path:
        """The place of the file that a key names."""
        return self.folders[name] / str(self.values[name])

    def changed(self, changes: Mapping[str, object], *, folder: Path | None = None) -> GivenScenario:
        """Give the scenario with other values.

        Parameters
        ----------
        changes
            By full names, or by names without their section. What the scenario says in another way gives room: a
            named snow replaces H_V and S_f, a ski's file its name, elastic snow the unloading ratio, and results of a
            campaign the unloading ratio and the shear displacement as far as it measured them.
        folder
            Where relative paths among the changes start; None: the current folder.

        Raises
        ------
        ParameterError
            A name is unknown (the nearest is named), or a value is of the wrong kind or outside its range.
        """
        new = in_ranges({full_name(name): value for name, value in changes.items()})
        gone = {each for name, value in new.items() for each in replaced(name, value)} - set(new)
        values = {name: value for name, value in self.values.items() if name not in gone} | new
        folders = dict(self.folders)
        folders.update((name, folder or Path()) for name in PATH_KEYS if name in new)
        before = MEASURED_TOO if "snow.results" in new else self.before_results
        kept = frozenset(name for name in before if name in values and name not in new)
        before = MAPPED_TOO if "snow.map_file" in new else self.before_map
        mapped = frozenset(name for name in before if name in values and name not in new)
        return replace(self, values=values, folders=folders, before_results=kept, before_map=mapped)


def given_scenario(name_or_path: str | Path | Scenario) -> GivenScenario:
    """Read a scenario as given: a built-in one by its name, any other from its TOML file, or take the object itself.

    Raises
    ------
    ParameterError
        There is no such name or file, it is no TOML, a section or key is unknown (the nearest is named), or a value is
        of the wrong kind or outside its range.
    """
    if isinstance(name_or_path, Scenario):
        return GivenScenario("scenario given in Python", None, {}, {}, base=name_or_path)
    word = str(name_or_path)
    if word in scenario_names():
        return _given(word, None, scenario_text(word))
    path = Path(name_or_path)
    if not (isinstance(name_or_path, Path) or path.suffix.lower() == ".toml" or path.name != word or is_file(path)):
        raise ParameterError(
            f"there is no scenario named {word!r}. {nearest(word, scenario_names())}. Any other scenario is read from "
            "a file ending in .toml"
        )
    return _given(str(path), path, plain_text(path, most_bytes=MOST_TOML_BYTES))


def _given(title: str, file: Path | None, text: str) -> GivenScenario:
    parsed = toml_values(text, title=title)
    identify = parsed.pop(IDENTIFY, {})
    if not isinstance(identify, dict):
        raise ParameterError(f"{title}: {IDENTIFY} is {identify!r}; it must be a table, begun by the line [{IDENTIFY}]")
    try:
        require_known(identify)
        values = in_ranges(flat(parsed))
    except ParameterError as error:
        raise ParameterError(f"{title}: {error}") from error
    folder = file.parent if file is not None else Path()
    return GivenScenario(title, file, values, dict.fromkeys(PATH_KEYS, folder), identify)


def flat(sections: Mapping[str, Any]) -> dict[str, object]:
    """The values of a file's sections under full names; unknown ones are refused."""
    values: dict[str, object] = {}
    for section, table in sections.items():
        if section not in SECTIONS:
            raise ParameterError(
                f"there is no section [{section}]. {meant(section, SECTIONS)}There are {', '.join(SECTIONS)}"
            )
        if not isinstance(table, dict):
            raise ParameterError(f"{section} is {table!r}; it must be a table, begun by the line [{section}]")
        for key, value in table.items():
            values[full_name(f"{section}.{key}")] = value
    return values


def full_name(name: str) -> str:
    """The full name of a key that is given with its section or without.

    Raises
    ------
    ParameterError
        There is no such key; the nearest is named.

    Examples
    --------
    >>> full_name("mass_kg")
    'sledge.mass_kg'
    """
    if name in SCENARIO_KEYS:
        return name
    section, _, key = name.rpartition(".")
    if not section and key in _BARE:
        return _BARE[key]
    if key in _BARE:
        raise ParameterError(f"{name} is no key of a scenario. Is {_BARE[key]} meant?")
    known = [each for each in SCENARIO_KEYS if each.startswith(f"{section}.")] if section in SECTIONS else []
    raise ParameterError(f"{name} is no key of a scenario. {_meant(name, key, known)}".strip())


def _meant(name: str, key: str, known: Iterable[str]) -> str:
    there = list(known)
    question = meant(name, there or SCENARIO_KEYS) or meant(key, _BARE)
    return f"{question}There are {', '.join(there)}" if there else question


def in_ranges(values: Mapping[str, object]) -> dict[str, InputValue]:
    """Check each value by its key."""
    words = {name: present_method(value) if name == "solver.method" else value for name, value in values.items()}
    return {name: SCENARIO_KEYS[name].in_range(value) for name, value in words.items()}


def change_of(word: str) -> tuple[str, object]:
    """The full name and the value of ``section.key=value``.

    The value is written as in a TOML file; a text needs no quotes.

    Raises
    ------
    ParameterError
        There is no equals sign, or no such key.

    Examples
    --------
    >>> change_of("snow.published=race-piste"), change_of("inertia_kg_m2=[6, 8, 10]")
    (('snow.published', 'race-piste'), ('sledge.inertia_kg_m2', [6, 8, 10]))
    """
    name, equals, text = (part.strip() for part in word.partition("="))
    if not equals:
        raise ParameterError(f"{word!r} changes nothing; write section.key=value, such as sledge.edge_angle_deg=35")
    name = full_name(name)
    try:
        values = toml_values(f"value = {text}")
    except GivenError:
        _refuse_comma(word, name, text)
        return name, text
    value = values["value"] if values.keys() == {"value"} else text  # a second line would say more than one value
    is_text = SCENARIO_KEYS[name].kind == "text"
    return name, text if is_text and not isinstance(value, str) else value


def _refuse_comma(word: str, name: str, text: str) -> None:
    """Say how to write a number that has a decimal comma."""
    if SCENARIO_KEYS[name].kind != "text" and "," in text and is_number(text, ","):
        written = word.replace(text, text.replace(",", "."))
        raise ParameterError(f"{word!r}: numbers are written with a decimal point here. Write {written}")
