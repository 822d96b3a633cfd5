"""skisnow turns what was measured on a slope into what a ski does on it.

The public names, loaded when first used. Verbs act, nouns are what comes out of them or goes into them:

``read_campaign``, ``check_campaign``, ``Campaign``
    A folder of field measurements to a checked `Campaign`, or to the list of its problems.
``analyse``, ``Analysis``, ``results_dict``, ``write_report``
    A campaign to snow hardness, failure shear stress, the choice of the model and the regressions; the snow of a site
    out of them (`Analysis.snow`); results.json; a self-contained report with figures and tables.
``Store``
    The embedded store that keeps campaigns byte for byte.
``write_reference``
    A synthetic campaign with the design of Mössner and others (2013).
``SnowProperties``, ``snow_from_results``, ``published_snow``, ``published_names``
    Snow as the force laws need it: from numbers, from results.json, by the name of a publication.
``Ski``, ``read_ski``, ``ski_names``
    A ski from its file or from the catalogue.
``carve``, ``rest``, ``Equilibrium``
    A ski in snow under a load, carving steadily or at rest.
``load_scenario``, ``scenario_names``, ``Scenario``
    What a run is: a built-in scenario by its name or any other from its file; `Scenario.with_` makes another of it.
``Plane``, ``Profile``, ``Terrain``, ``Contact``, ``SnowMap``, ``Air``, ``RigidSledge``, ``Start``, ``Stop``, ``Solver``
    The parts of a scenario: slope, how snow and skis meet, snow over the place, drag, sledge, where it begins and ends,
    how it is computed.
``Boots``, ``BootPose``, ``BootMoment``
    Boots that move: a table over time or distance; what a function that moves them knows, and gives.
``read_course``, ``course_names``, ``Course``, ``Gate``, ``time_gates``, ``CourseResult``
    Gates from a file, and who passed them when: a run or a measured track.
``simulate``, ``Run``, ``verify``, ``Refinement``
    A sledge on two flexible skis: the run that comes out of a scenario, and how exact it is.
``turn``, ``TurnChain``
    From a campaign to a turn in one call, with a band over what is not known of it.
``read_track``, ``Track``, ``GeodeticPoint``, ``in_slope_frame``, ``track_summary``, ``TrackSummary``
    Where something was on a slope, and when: from the files of receivers and watches, into the slope's frame; what a
    track says: distance, speed, runs and lifts, turns with their radii.
``compare_tracks``, ``Comparison``
    A simulated track compared with a measured one.
``identify``, ``Identification``
    Friction, drag and snow from tracks, photo-cell times or tracks left in the snow.
``study``, ``read_study``, ``Study``, ``StudyTable``, ``run_batch``
    One question over a grid or a sample of its inputs; one function over many points, on all cores.
``quickest_line``, ``QuickestLine``
    The quickest line through a course.
``SnowField``, ``SnowContact``, ``Runner``, ``ContactForces``
    History-dependent snow, and any body of one's own in it.
``regress``
    Linear regression with the arguments and results of MATLAB's and Octave's ``regress``.
``SkisnowError``, ``ParameterError``, ``FieldDataError``, ``FitError``, ``SolverError``, ``StoreError``, ``OutputError``
    What can go wrong; all derive from `SkisnowError`, each has a `code`.
``RangeWarning``, ``FitWarning``, ``ModelLimitWarning``
    A relation outside its range, a fit with few certain digits, an input for which the model is known to be wrong.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._support.errors import (
        FieldDataError,
        FitError,
        FitWarning,
        ModelLimitWarning,
        OutputError,
        ParameterError,
        RangeWarning,
        SkisnowError,
        SolverError,
        StoreError,
    )
    from ._support.processes.batch import run_batch
    from .campaign import Campaign, check_campaign, read_campaign, write_reference
    from .campaign.store import Store
    from .carving import Equilibrium, rest
    from .carving.equilibrium import carve
    from .comparison import Comparison, compare_tracks
    from .contact import ContactForces, Runner, SnowContact, SnowField
    from .dynamics import BootPose
    from .estimation import Analysis, analyse, results_dict
    from .identification import Identification
    from .identification.fitting import identify
    from .pipeline.turn import turn
    from .racing import QuickestLine, quickest_line
    from .report import TurnChain, write_report
    from .scenario import (
        Air,
        Boots,
        Contact,
        Plane,
        Profile,
        RigidSledge,
        Scenario,
        SnowMap,
        Solver,
        Start,
        Stop,
        Terrain,
        load_scenario,
        scenario_names,
    )
    from .simulation import Run
    from .simulation.moving_boots import BootMoment
    from .simulation.run_gates import time_gates
    from .simulation.simulated_run import simulate
    from .simulation.verification import Refinement, verify
    from .ski import Ski, read_ski, ski_names
    from .snow import SnowProperties, published_names, published_snow, snow_from_results
    from .statistics import regress
    from .studies import Study, StudyTable, read_study
    from .studies import run_study as study
    from .track.course import Course, CourseResult, Gate, course_names, read_course
    from .track.projection import GeodeticPoint
    from .track.read import read_track
    from .track.slope_frame import in_slope_frame
    from .track.summary import TrackSummary, track_summary
    from .track.track import Track

__all__ = [
    "Air",
    "Analysis",
    "BootMoment",
    "BootPose",
    "Boots",
    "Campaign",
    "Comparison",
    "Contact",
    "ContactForces",
    "Course",
    "CourseResult",
    "Equilibrium",
    "FieldDataError",
    "FitError",
    "FitWarning",
    "Gate",
    "GeodeticPoint",
    "Identification",
    "ModelLimitWarning",
    "OutputError",
    "ParameterError",
    "Plane",
    "Profile",
    "QuickestLine",
    "RangeWarning",
    "Refinement",
    "RigidSledge",
    "Run",
    "Runner",
    "Scenario",
    "Ski",
    "SkisnowError",
    "SnowContact",
    "SnowField",
    "SnowMap",
    "SnowProperties",
    "Solver",
    "SolverError",
    "Start",
    "Stop",
    "Store",
    "StoreError",
    "Study",
    "StudyTable",
    "Terrain",
    "Track",
    "TrackSummary",
    "TurnChain",
    "analyse",
    "carve",
    "check_campaign",
    "compare_tracks",
    "course_names",
    "identify",
    "in_slope_frame",
    "load_scenario",
    "published_names",
    "published_snow",
    "quickest_line",
    "read_campaign",
    "read_course",
    "read_ski",
    "read_study",
    "read_track",
    "regress",
    "rest",
    "results_dict",
    "run_batch",
    "scenario_names",
    "simulate",
    "ski_names",
    "snow_from_results",
    "study",
    "time_gates",
    "track_summary",
    "turn",
    "verify",
    "write_reference",
    "write_report",
]

_PACKAGES = {
    "_support.errors": (
        "FieldDataError",
        "FitError",
        "FitWarning",
        "ModelLimitWarning",
        "OutputError",
        "ParameterError",
        "RangeWarning",
        "SkisnowError",
        "SolverError",
        "StoreError",
    ),
    "_support.processes.batch": ("run_batch",),
    "campaign": ("Campaign", "check_campaign", "read_campaign", "write_reference"),
    "campaign.store": ("Store",),
    "carving": ("Equilibrium", "rest"),
    "carving.equilibrium": ("carve",),
    "contact": ("ContactForces", "Runner", "SnowContact", "SnowField"),
    "dynamics": ("BootPose",),
    "estimation": ("Analysis", "analyse", "results_dict"),
    "identification": ("Identification", "identify"),
    "pipeline.turn": ("turn",),
    "racing": ("QuickestLine", "quickest_line"),
    "report": ("TurnChain", "write_report"),
    "scenario": (
        "Air",
        "Boots",
        "Contact",
        "Plane",
        "Profile",
        "RigidSledge",
        "Scenario",
        "SnowMap",
        "Solver",
        "Start",
        "Stop",
        "Terrain",
        "load_scenario",
        "scenario_names",
    ),
    "simulation": ("Run",),
    "simulation.moving_boots": ("BootMoment",),
    "simulation.run_gates": ("time_gates",),
    "simulation.simulated_run": ("simulate",),
    "simulation.verification": ("Refinement", "verify"),
    "ski": ("Ski", "read_ski", "ski_names"),
    "snow": ("SnowProperties", "published_names", "published_snow", "snow_from_results"),
    "statistics": ("regress",),
    "studies": ("Study", "StudyTable", "read_study", "run_study"),
    "comparison": ("Comparison", "compare_tracks"),
    "track.course": ("Course", "CourseResult", "Gate", "course_names", "read_course"),
    "track.projection": ("GeodeticPoint",),
    "track.read": ("read_track",),
    "track.slope_frame": ("in_slope_frame",),
    "track.summary": ("TrackSummary", "track_summary"),
    "track.track": ("Track",),
}
_PLACES = {name: (package, name) for package, names in _PACKAGES.items() for name in names}
_PLACES["study"] = _PLACES.pop("run_study")


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("importlib.metadata").version(__name__)
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    package, own_name = _PLACES[name]
    return getattr(import_module(f".{package}", __name__), own_name)


def __dir__() -> list[str]:
    return sorted(__all__)
