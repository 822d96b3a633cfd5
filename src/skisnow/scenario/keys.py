"""The keys of a scenario as users name them, in files, on the command line, in studies and in JSON: one table."""

from __future__ import annotations

from typing import Final

from ..inputs import quantities
from .scenario import Scenario

SCENARIO_KEYS: Final = {key.name: key for key in quantities(Scenario)}
"""By name, section.key, in the order of tables."""

SECTIONS: Final = tuple(dict.fromkeys(name.split(".")[0] for name in SCENARIO_KEYS))
