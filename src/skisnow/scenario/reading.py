"""Scenarios from files and by name."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from ..errors import ParameterError, RangeWarning
from ..shown import ShownFields
from ..sources import Sources
from .building import built, outdone
from .changed import changed_scenario
from .given import GivenScenario, given_scenario
from .plausibility import implausible_values
from .scenario import Scenario
from .values import scenario_values

_NOTHING: Final[Mapping[str, object]] = MappingProxyType({})


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ScenarioFile(ShownFields):
    """A scenario with the words that it was given in.

    Attributes
    ----------
    title
        The built-in name, or the file's path.
    values
        Every key of `SCENARIO_KEYS` with the value in force, in the unit that the key names; None where there is none.
        H_V and S_f stand there also where a name gave them.
    scenario
        In SI.
    files
        What was read: the scenario's file, profile, results, ski.
    warnings
        In words.
    """

    title: str
    values: Mapping[str, Any]
    scenario: Scenario
    files: tuple[Path, ...]
    warnings: tuple[str, ...]


def read_scenario(name_or_path: str | Path, *, changes: Mapping[str, object] = _NOTHING) -> Scenario:
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
        There is no such scenario; a key is unknown (the nearest is named), missing, said twice or outside its range; a
        file that it names cannot be read; or its parts do not go together.

    Warns
    -----
    RangeWarning
        A value of a ski file is beyond what skis usually have.

    See Also
    --------
    skisnow.scenario_names : the built-in ones.
    skisnow.simulate : the run that comes out.

    References
    ----------
    The page docs/files/scenario.md.

    Examples
    --------
    >>> scenario = read_scenario("carved-46m", changes={"sledge.mass_kg": 90})
    >>> scenario.sledge.mass, scenario.contact.snow.snow_hardness
    (90.0, 200000000.0)
    """
    scenario, warned = _built(given_scenario(name_or_path).changed(changes), Sources())
    for text in warned:
        warnings.warn(text, RangeWarning, stacklevel=2)
    return scenario


def scenario_file(name_or_path: str | Path, *, changes: Mapping[str, object] = _NOTHING) -> ScenarioFile:
    """Read a scenario together with the words that it was given in, and all warnings.

    Parameters, errors: as `read_scenario`.
    """
    return resolved(given_scenario(name_or_path).changed(changes))


def resolved(given: GivenScenario, *, sources: Sources | None = None) -> ScenarioFile:
    """The scenario that values as given describe.

    Parameters
    ----------
    given
        Values as given.
    sources
        Keeps what was read, for many scenarios.

    Raises
    ------
    ParameterError
        As `read_scenario`.
    """
    scenario, warned = _built(given, sources or Sources())
    own = _own_implausible_values(given.title) if given.file is None and given.base is None else ()
    found = (*warned, *(each for each in implausible_values(scenario) if each not in own))
    return ScenarioFile(given.title, _in_force(given, scenario), scenario, files_of(given), found)


@cache
def _own_implausible_values(name: str) -> tuple[str, ...]:
    """What a built-in scenario itself would be suspected of; its file says so, and why."""
    return implausible_values(_built(given_scenario(name), Sources())[0])


def _built(given: GivenScenario, sources: Sources) -> tuple[Scenario, tuple[str, ...]]:
    if given.base is not None:
        return changed_scenario(given.base, given.values), ()
    try:
        return built(given, sources)
    except ParameterError as error:
        raise ParameterError(f"{given.title}: {error}") from error


def _in_force(given: GivenScenario, scenario: Scenario) -> dict[str, Any]:
    """As given where it was: there and back over the unit could change a last digit."""
    gone = outdone(given, scenario.contact.snow, scenario.contact.snow_map)
    left = {name: value for name, value in given.values.items() if name not in gone}
    words = {name: list(value) if isinstance(value, tuple) else value for name, value in left.items()}
    if given.base is not None:
        return {**scenario_values(scenario), **words}
    of_ski = {"ski.name": words.get("ski.name"), "ski.file": words.get("ski.file")}
    return {**scenario_values(scenario), **words, **of_ski}


def files_of(given: GivenScenario) -> tuple[Path, ...]:
    """Files that a scenario is read from."""
    named = (given.path(name) for name in given.folders if name in given.values)
    return (*((given.file,) if given.file is not None else ()), *named)
