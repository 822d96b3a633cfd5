"""Start and end of a run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal, TypeAlias

from .._support.messages import Message
from ..forces.penetration.law import DELAYED_SPACING
from ..parameters import Allowed, Condition, Declared, Label, Quantity, Search
from ..ski.beam import MOST_ELEMENTS


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Start(Declared):
    """Place of the boots' middle (m), speed along the skis (m/s), heading from the fall line, positive left (rad)."""

    x: Annotated[
        float,
        Quantity(
            "start.x_m",
            "place of the boots' middle down the slope; on a profile its horizontal distance",
            origin="choice: where x begins",
        ),
        Label(Message("start, down the fall line"), symbol="x"),
        Search(1.0, -20.0, 20.0, about=True),
    ] = 0.0
    y: Annotated[
        float,
        Quantity("start.y_m", "place to the left", origin="choice: where y begins"),
        Label(Message("start, across it"), symbol="y"),
        Search(1.0, -20.0, 20.0, about=True),
    ] = 0.0
    speed: Annotated[
        float,
        Quantity("start.speed_m_per_s", "speed along the skis"),
        Label(Message("speed at the start"), symbol="v"),
        Allowed(0.0, 100.0),
        Search(10.0, 0.0, 60.0),
    ]
    heading: Annotated[
        float,
        Quantity("start.heading_deg", "heading of the skis from the fall line, positive left"),
        Label(Message("heading at the start")),
        Allowed(-180.0, 180.0, origin="choice: down the fall line"),
        Search(30.0, -45.0, 45.0, about=True),
    ] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Stop(Declared):
    """End of a run: after a time (s), a run length (m), or the first of both."""

    duration: Annotated[
        float | None,
        Quantity("run.duration_s", "simulated time; the run ends at this or at length_m, whichever comes first"),
        Label(Message("ends after")),
        Allowed(0.0, 3600.0, above=True),
    ] = None
    length: Annotated[
        float | None,
        Quantity("run.length_m", "length of the path of the boots' middle after which the run is done"),
        Label(Message("ends after a way of")),
        Allowed(0.0, 100_000.0, above=True),
    ] = None


Method: TypeAlias = Literal["default", "fast"]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Solver(Declared):
    """Settings of the computation; lengths in m, times in s. None: derived from ski and snow.

    See Also
    --------
    skisnow.Scenario
    skisnow.verify
    """

    method: Annotated[
        Method,
        Quantity(
            "solver.method",
            "accuracy: fast allows ten times the tolerance as error of a step",
            origin="choice: the more exact one",
        ),
        Label(Message("method")),
    ] = "default"
    step: Annotated[
        float,
        Quantity("solver.step_ms", "the first time step; with fixed = true every step"),
        Label(Message("time step")),
        # below, rounding counts; above, a ski's first bending mode is not resolved
        Allowed(0.001, 5.0, origin="choice: near what a start takes"),
    ] = 0.5e-3
    tolerance: Annotated[
        float,
        Quantity(
            "solver.tolerance_mm",
            "largest error of place that one step may make by its own estimate; with method = fast ten times as large",
        ),
        Label(Message("tolerance")),
        Allowed(1e-9, 10.0, origin="choice: see the tests of convergence"),
    ] = 1e-6
    fixed: Annotated[
        bool,
        Quantity(
            "solver.fixed",
            "whether the step stays as it is, without control of the error",
            origin="choice: a step that is too long is wrong without a sign",
        ),
        Label(Message("fixed time step")),
    ] = False
    elements: Annotated[
        int | None,
        Quantity(
            "solver.elements",
            "finite elements over a ski, three for one near the ends of its sidecut; default: from ski and snow",
        ),
        Label(Message("elements of a ski")),
        Allowed(4, MOST_ELEMENTS),
    ] = None
    line_spacing: Annotated[
        float | None,
        Quantity(
            "solver.line_spacing_mm",
            "distance along the path between the lines that keep the snow's groove; default: from ski and snow",
        ),
        Label(Message("distance of the snow lines")),
        Allowed(0.1, 200.0),
    ] = None
    groove_tolerance: Annotated[
        float,
        Quantity(
            "solver.groove_tolerance",
            "share of a contact's depth times width by which the groove on a line may be simplified; with method = "
            "fast three times as large",
        ),
        Label(Message("tolerance of the groove")),
        Allowed(1e-9, 0.1, origin="choice: see the tests of convergence"),
    ] = 1e-4
    delayed_spacing: Annotated[
        float,
        Quantity(
            "solver.delayed_spacing_mm", "distance across a groove between the places that keep their delayed depth"
        ),
        Label(Message("spacing of delayed depths")),
        Allowed(0.01, 20.0, origin="choice: see the page on rate"),
        Condition("snow.delayed_share", 0.0, differs=True),
    ] = DELAYED_SPACING
    output_interval: Annotated[
        float,
        Quantity("run.output_ms", "time between the rows that are kept"),
        Label(Message("time between outputs")),
        Allowed(0.1, 1000.0, origin="choice: a tenth of a metre at 10 m/s"),
    ] = 0.01
