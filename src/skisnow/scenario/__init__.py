"""What a run starts from: slope, snow, sledge, skis, start, and how it is computed."""

from __future__ import annotations

from .air import Air
from .boots import Boots
from .built_in import scenario_names, scenario_text
from .contact import Contact
from .keys import scenario_values
from .reading import ScenarioFile, load_scenario, scenario_file
from .scenario import Scenario
from .skier import Skier
from .sledge import RigidSledge
from .slope import Plane, Profile, read_profile
from .slope_surface import Slope
from .snow_map import SnowMap, read_snow_map
from .solver import Solver
from .start import Start, Stop
from .terrain import Terrain, read_terrain

__all__ = [
    "Air",
    "Boots",
    "Contact",
    "Plane",
    "Profile",
    "RigidSledge",
    "Scenario",
    "ScenarioFile",
    "Skier",
    "Slope",
    "SnowMap",
    "Solver",
    "Start",
    "Stop",
    "Terrain",
    "load_scenario",
    "read_profile",
    "read_snow_map",
    "read_terrain",
    "scenario_file",
    "scenario_names",
    "scenario_text",
    "scenario_values",
]
