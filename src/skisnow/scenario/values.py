"""A scenario as values in the units that its keys name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..parameters import values_of
from .keys import SCENARIO_KEYS
from .scenario import Scenario


def scenario_values(scenario: Scenario) -> dict[str, Any]:
    """Every key of `SCENARIO_KEYS` with the value in force; None where the scenario does not have it.

    Also of a scenario that was built in Python: its snow stands as numbers, a ski that is not in the catalogue and a
    profile under the name and the source they have.
    """
    found = values_of(scenario)
    return {name: found.get(name) for name in SCENARIO_KEYS}


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
