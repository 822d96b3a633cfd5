"""Input of a run: slope, snow, sledge, skis, start, and how it is computed."""

from __future__ import annotations

from .boots import Boots
from .contact import Contact
from .keys import scenario_values
from .reading import ScenarioFile, load_scenario, scenario_file, scenario_names, scenario_text
from .run_settings import Solver, Start, Stop
from .scenario import Scenario
from .skier import Skier
from .sledge import Air, RigidSledge
from .slope import Plane, Profile, read_profile
from .snow_map import SnowMap, read_snow_map
from .terrain import Slope, Terrain, read_terrain

__all__ = [
    "Air", "Boots", "Contact", "Plane", "Profile", "RigidSledge", "Scenario", "ScenarioFile", "Skier", "Slope",
    "SnowMap", "Solver", "Start", "Stop", "Terrain", "load_scenario", "read_profile", "read_snow_map", "read_terrain",
    "scenario_file", "scenario_names", "scenario_text", "scenario_values",
]  # fmt: skip
