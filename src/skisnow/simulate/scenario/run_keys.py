"""Keys of start, end and solver."""

from __future__ import annotations

from typing import Final

from ...units import DEGREE, MM
from ..carve_keys import MOST_ELEMENTS
from ..input_keys import InputKey
from .scenario import Solver

_SOLVER: Final = Solver()
MILLISECOND: Final = 1e-3
"""Seconds in a millisecond."""

START_AND_RUN_KEYS: Final = (
    InputKey(
        name="start.x_m",
        meaning="place of the boots' middle down the slope; on a profile its horizontal distance",
        unit="m",
        default=0.0,
        origin="choice: where x begins",
    ),
    InputKey(name="start.y_m", meaning="place to the left", unit="m", default=0.0, origin="choice: where y begins"),
    InputKey(name="start.speed_m_per_s", meaning="speed along the skis", unit="m/s", lowest=0.0, highest=100.0),
    InputKey(
        name="start.heading_deg",
        meaning="heading of the skis from the fall line, positive left",
        unit="°",
        factor=DEGREE,
        lowest=-180.0,
        highest=180.0,
        default=0.0,
        origin="choice: down the fall line",
    ),
    InputKey(
        name="run.duration_s",
        meaning="simulated time; with length_m beside it, whichever comes first",
        unit="s",
        lowest=0.0,
        highest=3600.0,
        above=True,
    ),
    InputKey(
        name="run.length_m",
        meaning="length of the path of the boots' middle after which the run is done",
        unit="m",
        lowest=0.0,
        highest=100_000.0,
        above=True,
    ),
    InputKey(
        name="run.output_ms",
        meaning="time between the rows that are kept",
        unit="ms",
        factor=MILLISECOND,
        lowest=0.1,
        highest=1000.0,
        default=_SOLVER.output_interval / MILLISECOND,
        origin="choice: a tenth of a metre at 10 m/s",
    ),
)
SOLVER_KEYS: Final = (
    InputKey(
        name="solver.method",
        kind="text",
        choices=("ros2", "fast"),
        meaning="ROS2, or the linearly implicit BDF2 of the fast mode, both of second order",
        default=_SOLVER.method,
        origin="choice: the more exact one",
    ),
    InputKey(
        name="solver.step_ms",
        meaning="the first time step; with fixed = true every step",
        unit="ms",
        factor=MILLISECOND,
        lowest=0.001,
        highest=5.0,
        default=_SOLVER.step / MILLISECOND,
        origin="choice: near what soft snow takes",
    ),
    InputKey(
        name="solver.tolerance_mm",
        meaning="largest error of place that one step may make by its own estimate",
        unit="mm",
        factor=MM,
        lowest=1e-9,
        highest=10.0,
        default=_SOLVER.tolerance / MM,
        origin="choice: see the tests of convergence",
    ),
    InputKey(
        name="solver.fixed",
        kind="switch",
        meaning="whether the step stays as it is, without control of the error; left out with method = fast: true",
        default=_SOLVER.fixed,
        origin="choice: a step that is too long is wrong without a sign",
    ),
    InputKey(
        name="solver.elements",
        kind="whole number",
        meaning="finite elements over a ski; left out: from ski and snow",
        lowest=4,
        highest=MOST_ELEMENTS,
    ),
    InputKey(
        name="solver.line_spacing_mm",
        meaning="distance along the path between the lines that keep the snow's groove; left out: from ski and snow",
        unit="mm",
        factor=MM,
        lowest=0.1,
        highest=200.0,
    ),
    InputKey(
        name="solver.cell_mm",
        meaning="cells of such a line across the path; left out: from ski and snow",
        unit="mm",
        factor=MM,
        lowest=0.01,
        highest=100.0,
    ),
)
