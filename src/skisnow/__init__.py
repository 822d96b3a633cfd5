"""skisnow turns what was measured on a slope into what a ski does on it.

The public names, loaded when first used:

``read_campaign``, ``check_campaign``
    A folder of field measurements to a checked `Campaign`, or to the list of its problems.
``analyse``, ``results_dict``
    A campaign to snow hardness, failure shear stress, the choice of the model and the regressions.
``write_report``
    Results to a self-contained report with figures and tables.
``Store``
    The embedded store that keeps campaigns byte for byte.
``write_reference``
    A synthetic campaign with the design of Mössner and others (2013).
``SnowProperties``, ``snow_from_results``, ``published_snow``, ``published_names``
    Snow as the force laws need it: from numbers, from an analysed campaign, by the name of a publication.
``Ski``, ``read_ski``, ``ski_names``
    A ski from its file or from the catalogue.
``carve``, ``rest``, ``Equilibrium``
    A ski in snow under a load, carving steadily or at rest.
``read_scenario``, ``scenario_names``, ``Scenario``, ``simulated_run``, ``Run``
    A sledge on two flexible skis: a scenario from its file or a built-in one, and the run that comes out of it.
``read_track``, ``Track``, ``GeodeticPoint``, ``in_slope_frame``
    Where something was on a slope, and when: from the files of receivers and watches, into the slope's frame.
``track_summary``, ``TrackSummary``
    What a track says: distance, speed, runs and lifts, turns with their radii.
``regress``
    Linear regression with the arguments and results of MATLAB's and Octave's ``regress``.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .estimate import Analysis, analyse, results_dict
    from .field import Campaign, check_campaign, read_campaign, write_reference
    from .field.store import Store
    from .report import write_report
    from .simulate import Equilibrium, Run, Scenario, carve, read_scenario, rest, scenario_names
    from .simulate.simulated_run import simulated_run
    from .ski import Ski, read_ski, ski_names
    from .snow import SnowProperties, published_names, published_snow, snow_from_results
    from .statistics import regress
    from .track.projection import GeodeticPoint
    from .track.read import read_track
    from .track.slope_frame import in_slope_frame
    from .track.summary import TrackSummary, track_summary
    from .track.track import Track

__all__ = [
    "Analysis",
    "Campaign",
    "Equilibrium",
    "GeodeticPoint",
    "Run",
    "Scenario",
    "Ski",
    "SnowProperties",
    "Store",
    "Track",
    "TrackSummary",
    "analyse",
    "carve",
    "check_campaign",
    "in_slope_frame",
    "published_names",
    "published_snow",
    "read_campaign",
    "read_scenario",
    "read_ski",
    "read_track",
    "regress",
    "rest",
    "results_dict",
    "scenario_names",
    "simulated_run",
    "ski_names",
    "snow_from_results",
    "track_summary",
    "write_reference",
    "write_report",
]

_ROOMS = {
    "estimate": ("Analysis", "analyse", "results_dict"),
    "field": ("Campaign", "check_campaign", "read_campaign", "write_reference"),
    "field.store": ("Store",),
    "report": ("write_report",),
    "simulate": ("Equilibrium", "Run", "Scenario", "carve", "read_scenario", "rest", "scenario_names"),
    "simulate.simulated_run": ("simulated_run",),
    "ski": ("Ski", "read_ski", "ski_names"),
    "snow": ("SnowProperties", "published_names", "published_snow", "snow_from_results"),
    "statistics": ("regress",),
    "track.projection": ("GeodeticPoint",),
    "track.read": ("read_track",),
    "track.slope_frame": ("in_slope_frame",),
    "track.summary": ("TrackSummary", "track_summary"),
    "track.track": ("Track",),
}
_ROOM_OF = {name: room for room, names in _ROOMS.items() for name in names}


def __getattr__(name: str) -> Any:
    if name not in _ROOM_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_ROOM_OF[name]}", __name__), name)


def __dir__() -> list[str]:
    return sorted(__all__)
