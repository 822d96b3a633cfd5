"""Scenarios from files and by name."""

from __future__ import annotations

import json
import re
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from .._support.errors import ParameterError, RangeWarning
from .._support.messages import Message
from .._support.units import ShownFields
from .._support.user_files.text_files import MOST_TOML_BYTES, is_file, plain_text, toml_values
from ..parameters import suggest_and_list
from ..ski.ski_file import Sources
from .building import build, changed_scenario
from .identify_section import require_known
from .keys import PATH_KEYS, SCENARIO_KEYS, SECTIONS, flatten_sections, scenario_values, validate
from .plausibility import implausible_values
from .resolution import CONDITIONS, ContradictionError, Layer, Resolution, ScenarioInput, resolve
from .scenario import Scenario

IDENTIFY: Final = "identify"
"""Section with the unknowns of an identification, which a run ignores."""

_NOTHING: Final[Mapping[str, object]] = MappingProxyType({})


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ScenarioFile(ShownFields):
    """A scenario together with the keys and values from which it was built.

    title: The built-in name, or the file's path.
    values: Every key of `SCENARIO_KEYS` with the value in force, in the unit that the key names; None if missing. H_V
        and S_f are there also where a name gave them.
    scenario: In SI.
    files: Files that were read: the scenario's file, profile, results, ski.
    warnings: In words.
    """

    title: str
    values: Mapping[str, Any]
    scenario: Scenario
    files: tuple[Path, ...]
    warnings: tuple[str, ...]


def load_scenario(name_or_path: str | Path, *, changes: Mapping[str, object] = _NOTHING) -> Scenario:
    """Read a scenario: a built-in one by its name, any other from its TOML file.

    Parameters
    ----------
    name_or_path
        A name of `scenario_names`, or the path of a file: whatever ends in .toml, has a folder or is a `Path`.
        Relative paths in the file start at its folder.
    changes
        Values by ``section.key``, or by ``key`` alone, in the units that the keys name. Relative paths among them start
        at the current folder.

    Returns
    -------
    Scenario
        Checked; `Scenario.with_` makes another of it.

    Raises
    ------
    ParameterError
        The scenario does not exist; a key is unknown (the message names the nearest), missing, repeated or out of
        range; a file that it names cannot be read; or its parts contradict each other.

    Warns
    -----
    RangeWarning
        A value of a ski file is outside the usual range.

    See Also
    --------
    skisnow.scenario_names : the built-in ones.
    skisnow.simulate : the run that comes out.

    References
    ----------
    The page docs/files/scenario.md.

    Examples
    --------
    >>> scenario = load_scenario("carved-46m", changes={"sledge.mass_kg": 90})
    >>> scenario.sledge.mass, scenario.contact.snow.snow_hardness
    (90.0, 200000000.0)
    """
    scenario, messages, _ = _resolve_and_build(load_input(name_or_path).changed(changes), Sources())
    for text in messages:
        warnings.warn(RangeWarning(text).tag("unusual"), stacklevel=2)
    return scenario


def scenario_file(name_or_path: str | Path, *, changes: Mapping[str, object] = _NOTHING) -> ScenarioFile:
    """Read a scenario together with its keys, values, files and all warnings.

    Parameters, errors: as `load_scenario`.
    """
    return build_input(load_input(name_or_path).changed(changes))


def load_input(name_or_path: str | Path | Scenario) -> ScenarioInput:
    """Load a built-in scenario by name or a TOML file, or wrap a scenario object, without resolving its values."""
    if isinstance(name_or_path, Scenario):
        return ScenarioInput("scenario given in Python", None, (), base=name_or_path)
    word = str(name_or_path)
    if word in scenario_names():
        return _parse_scenario(word, None, scenario_text(word))
    path = Path(name_or_path)
    if not (isinstance(name_or_path, Path) or path.suffix.lower() == ".toml" or path.name != word or is_file(path)):
        raise ParameterError(
            "unknown scenario {word!r}. {allowed} Any other scenario is read from a file ending in .toml"
        ).tag("unknown_name", word=word, allowed=suggest_and_list(word, scenario_names()))
    return _parse_scenario(str(path), path, plain_text(path, most_bytes=MOST_TOML_BYTES))


def _parse_scenario(title: str, file: Path | None, text: str) -> ScenarioInput:
    """Input from the text of a scenario file, checked by key; paths in it start at the file's folder."""
    sections = toml_values(text, title=title)
    identify = sections.pop(IDENTIFY, {})
    if not isinstance(identify, dict):
        raise ParameterError("{title}: {key} is {value!r}; it must be a table, begun by the line [{key}]").tag(
            "wrong_kind", title=title, key=IDENTIFY, value=identify
        )
    try:
        require_known(identify)
        values = validate(flatten_sections(sections))
    except ParameterError as error:
        raise error.at(title) from error
    return ScenarioInput(title, file, (Layer(values, file.parent if file else Path()),), identify)


def build_input(scenario_input: ScenarioInput, *, sources: Sources | None = None) -> ScenarioFile:
    """Resolve and build a scenario.

    sources: cache of skis and snows for many scenarios.
    """
    scenario, messages, resolution = _resolve_and_build(scenario_input, sources or Sources())
    expected = (
        _warnings_of_built_in(scenario_input.title)
        if scenario_input.file is None and scenario_input.base is None
        else ()
    )
    messages = (*messages, *(text for text in implausible_values(scenario) if text not in expected))
    files = (*((scenario_input.file,) if scenario_input.file is not None else ()), *resolution.files.values())
    return ScenarioFile(scenario_input.title, _values(scenario_input, resolution, scenario), scenario, files, messages)


@cache
def _warnings_of_built_in(name: str) -> tuple[str, ...]:
    """Warnings about a built-in scenario itself, which its file explains."""
    return implausible_values(_resolve_and_build(load_input(name), Sources())[0])


def _resolve_and_build(scenario_input: ScenarioInput, sources: Sources) -> tuple[Scenario, tuple[str, ...], Resolution]:
    """Scenario, warnings and resolution of an input; errors begin with the input's title."""
    if scenario_input.base is not None:
        return (
            changed_scenario(scenario_input.base, scenario_input.values),
            (),
            Resolution(scenario_input.values, {}, None, None),
        )
    try:
        resolution = resolve(scenario_input, sources)
        return (*build(resolution, sources), resolution)
    except ContradictionError as error:
        raise ContradictionError(
            error.keys, Message("{place}: {problem}", place=scenario_input.title, problem=error)
        ) from error
    except ParameterError as error:
        raise error.at(scenario_input.title) from error


def _values(scenario_input: ScenarioInput, resolution: Resolution, scenario: Scenario) -> dict[str, Any]:
    """Values of all keys; a value of the file keeps its digits, which a conversion to SI and back could change."""
    values = {name: list(value) if isinstance(value, tuple) else value for name, value in resolution.values.items()}
    if scenario_input.base is not None:
        return {**scenario_values(scenario), **values}
    return {**scenario_values(scenario), "ski.name": None, "ski.file": None, **values}


def input_files(scenario_input: ScenarioInput) -> tuple[Path, ...]:
    """The scenario's file and every file that a layer names."""
    paths = {
        name: layer.folder / str(layer.values[name])
        for layer in scenario_input.layers
        for name in PATH_KEYS
        if name in layer.values
    }
    return (*((scenario_input.file,) if scenario_input.file is not None else ()), *paths.values())


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
        Names that `skisnow.load_scenario` accepts.

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
    """Path of the TOML file of a built-in scenario; it need not exist."""
    return Path(str(_FOLDER / f"{name}.toml"))


@cache
def scenario_text(name: str) -> str:
    """Text of a built-in scenario: every key with the origin of its value; defaults follow the keys of the file.

    Raises ParameterError: the scenario does not exist; the message names the nearest.
    """
    if name not in scenario_names():
        raise ParameterError("unknown built-in scenario {name!r}. {allowed}").tag(
            "unknown_name", name=name, allowed=suggest_and_list(name, scenario_names())
        )
    text = (_FOLDER / f"{name}.toml").read_text(encoding="utf-8")
    head, *parts = _SECTION.split(text)
    written = dict(zip(parts[::2], parts[1::2], strict=True))
    defaults = _defaults(text)
    there = (
        section for section in SECTIONS if section in written or (defaults[section] and section not in _BY_PRESENCE)
    )
    sections = (
        f"[{own_section}]\n{written.get(own_section, '').rstrip()}\n{defaults[own_section]}" for own_section in there
    )
    return head + "\n".join(section.replace("]\n\n", "]\n") for section in sections)


def _defaults(text: str) -> dict[str, str]:
    """By section, the lines of the keys that the text does not name and that have a default."""
    file_values = {
        f"{section}.{key}": value for section, table in toml_values(text).items() for key, value in table.items()
    }
    values = {name: key.default for name, key in SCENARIO_KEYS.items()} | file_values
    unused = {name for name, condition in CONDITIONS.items() if not condition.holds(values[condition.key])}
    lines = dict.fromkeys(SECTIONS, "")
    for name, key in SCENARIO_KEYS.items():
        if key.default is not None and name not in file_values and name not in unused:
            section, own = name.split(".")
            line = f"{own} = {json.dumps(key.default)}"
            lines[section] += f"{line:<{_COMMENTS_FROM}}# default, {key.origin}\n"
    return lines
