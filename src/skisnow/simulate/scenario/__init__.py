"""What a run starts from: slope, snow, sledge, skis, start, and how it is computed."""

from .built_in import scenario_names, scenario_text
from .contact import Contact
from .profile_file import read_profile
from .reading import ScenarioFile, read_scenario, scenario_file
from .scenario import Air, Scenario, Start, Stop
from .slope import Plane, Profile
from .solver import Solver
from .values import scenario_values

__all__ = [
    "Air",
    "Contact",
    "Plane",
    "Profile",
    "Scenario",
    "ScenarioFile",
    "Solver",
    "Start",
    "Stop",
    "read_profile",
    "read_scenario",
    "scenario_file",
    "scenario_names",
    "scenario_text",
    "scenario_values",
]
