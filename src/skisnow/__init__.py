"""skisnow turns measurements of snow on a ski slope into predictions of how a ski behaves on it.

The public names are loaded when first used. Functions are verbs; classes are their inputs and results.

``read_campaign``, ``check_campaign``, ``Campaign``
    Read a folder of field measurements into a `Campaign`, or list its problems.
``analyse``, ``Analysis``, ``results_dict``, ``write_report``
    Hardness, failure shear stress, models and regressions of a campaign; results.json; a report.
``Store``
    Store that keeps campaigns byte for byte.
``write_reference``
    Write a synthetic campaign with the design of Mössner and others (2013).
``SnowProperties``, ``read_snow``, ``load_snow``, ``snow_names``
    Snow for the force laws: from numbers, from results.json, from a publication.
``Ski``, ``read_ski``, ``ski_names``
    A ski from a file or from the catalogue.
``carve``, ``rest``, ``Equilibrium``
    A ski in snow under a load, carving steadily or at rest.
``design_ski``, ``Design``
    The ski that makes a wanted turn.
``load_scenario``, ``scenario_names``, ``Scenario``
    Input of a run: a built-in scenario by name, or one from a file; `Scenario.with_` changes it.
``Profile``, ``Terrain``, ``SnowMap``, ``RigidSledge``, ``Solver``
    Parts of a scenario. Further parts are in `skisnow.scenario`: Plane, Contact, Air, Start, Stop.
``Boots``, ``BootPose``, ``BootMoment``
    Moving boots: a table over time or distance; output and input of a function that moves them.
``read_course``, ``course_names``, ``Course``, ``Gate``, ``time_gates``, ``CourseResult``
    Gates from a file, and the times at which a run or a track passes them.
``simulate``, ``Run``, ``verify``, ``Refinement``
    Simulate a sledge on two flexible skis; estimate the numerical error of its end.
``turn``, ``TurnChain``
    From a campaign to a turn with an uncertainty band in one call.
``read_track``, ``Track``, ``GeodeticPoint``, ``in_slope_frame``, ``track_summary``, ``TrackSummary``
    A measured track: read it, transform it into the slope's frame, compute distance, speed, runs and turns.
``compare``, ``Comparison``
    Compare a simulated track with a measured one.
``identify``, ``Identification``
    Friction, drag and snow from tracks, photo-cell times or grooves.
``study``, ``read_study``, ``Study``, ``StudyTable``, ``run_batch``
    One question over a grid or a sample of its inputs; one function over many points, on all cores.
``race``, ``QuickestLine``
    The fastest line through a course.
``SnowField``, ``SnowContact``, ``Runner``, ``ContactForces``
    History-dependent snow, and contact of user-defined bodies with it.
``SkisnowError``, ``ParameterError``, ``FieldDataError``, ``FitError``, ``SolverError``, ``StoreError``, ``OutputError``
    Errors; all derive from `SkisnowError` and have a `code`.
``RangeWarning``, ``FitWarning``, ``ModelLimitWarning``
    Warnings: a relation outside its range, a fit with few certain digits, an input outside the model's limits.
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
    from .comparison import Comparison
    from .comparison import compare_tracks as compare
    from .contact import ContactForces, Runner, SnowContact, SnowField
    from .design import Design, design_ski
    from .dynamics import BootPose
    from .estimation import Analysis, analyse, results_dict
    from .identification import Identification
    from .identification.fitting import identify
    from .pipeline import turn
    from .racing import QuickestLine
    from .racing import quickest_line as race
    from .report import TurnChain, write_report
    from .scenario import (
        Boots,
        Profile,
        RigidSledge,
        Scenario,
        SnowMap,
        Solver,
        Terrain,
        load_scenario,
        scenario_names,
    )
    from .simulation import Run
    from .simulation.moving_boots import BootMoment
    from .simulation.run_summary import time_gates
    from .simulation.simulated_run import simulate
    from .simulation.verification import Refinement, verify
    from .ski import Ski, read_ski, ski_names
    from .snow import SnowProperties
    from .snow import published_names as snow_names
    from .snow import published_snow as load_snow
    from .snow import snow_from_results as read_snow
    from .studies import Study, StudyTable, read_study
    from .studies import run_study as study
    from .track.course import Course, CourseResult, Gate, course_names, read_course
    from .track.projection import GeodeticPoint
    from .track.read import read_track
    from .track.slope_frame import in_slope_frame
    from .track.summary import TrackSummary, track_summary
    from .track.track import Track

__all__ = [
    "Analysis",
    "BootMoment",
    "BootPose",
    "Boots",
    "Campaign",
    "Comparison",
    "ContactForces",
    "Course",
    "CourseResult",
    "Design",
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
    "compare",
    "course_names",
    "design_ski",
    "identify",
    "in_slope_frame",
    "load_scenario",
    "load_snow",
    "race",
    "read_campaign",
    "read_course",
    "read_ski",
    "read_snow",
    "read_study",
    "read_track",
    "rest",
    "results_dict",
    "run_batch",
    "scenario_names",
    "simulate",
    "ski_names",
    "snow_names",
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
    "design": ("Design", "design_ski"),
    "dynamics": ("BootPose",),
    "estimation": ("Analysis", "analyse", "results_dict"),
    "identification": ("Identification", "identify"),
    "pipeline": ("turn",),
    "racing": ("QuickestLine", "quickest_line"),
    "report": ("TurnChain", "write_report"),
    "scenario": (
        "Boots",
        "Profile",
        "RigidSledge",
        "Scenario",
        "SnowMap",
        "Solver",
        "Terrain",
        "load_scenario",
        "scenario_names",
    ),
    "simulation": ("Run",),
    "simulation.moving_boots": ("BootMoment",),
    "simulation.run_summary": ("time_gates",),
    "simulation.simulated_run": ("simulate",),
    "simulation.verification": ("Refinement", "verify"),
    "ski": ("Ski", "read_ski", "ski_names"),
    "snow": ("SnowProperties", "published_names", "published_snow", "snow_from_results"),
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
_PLACES |= {
    public: _PLACES.pop(name)
    for public, name in (
        ("study", "run_study"),
        ("compare", "compare_tracks"),
        ("race", "quickest_line"),
        ("load_snow", "published_snow"),
        ("snow_names", "published_names"),
        ("read_snow", "snow_from_results"),
    )
}


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("importlib.metadata").version(__name__)
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    package, own_name = _PLACES[name]
    return getattr(import_module(f".{package}", __name__), own_name)


def __dir__() -> list[str]:
    return sorted(__all__)
