"""Where a run begins, and when it is done."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ..parameters import Quantity, Search, declared_text, require_declared


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Start:
    """Place of the boots' middle (m), speed along the skis (m/s), heading from the fall line, positive left (rad).

    See Also
    --------
    skisnow.Scenario
    skisnow.Stop
    """

    x: Annotated[
        float,
        Quantity(
            "start.x_m",
            "place of the boots' middle down the slope; on a profile its horizontal distance",
            label="start, down the fall line",
            symbol="x",
            origin="choice: where x begins",
            search=Search(1.0, -20.0, 20.0, about=True),
        ),
    ] = 0.0
    y: Annotated[
        float,
        Quantity(
            "start.y_m",
            "place to the left",
            label="start, across it",
            symbol="y",
            origin="choice: where y begins",
            search=Search(1.0, -20.0, 20.0, about=True),
        ),
    ] = 0.0
    speed: Annotated[
        float,
        Quantity(
            "start.speed_m_per_s",
            "speed along the skis",
            label="speed at the start",
            symbol="v",
            lowest=0.0,
            highest=100.0,
            search=Search(10.0, 0.0, 60.0),
        ),
    ]
    heading: Annotated[
        float,
        Quantity(
            "start.heading_deg",
            "heading of the skis from the fall line, positive left",
            label="heading at the start",
            lowest=-180.0,
            highest=180.0,
            origin="choice: down the fall line",
            search=Search(30.0, -45.0, 45.0, about=True),
        ),
    ] = 0.0

    __repr__ = declared_text

    def __post_init__(self) -> None:
        require_declared(self)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Stop:
    """When a run is done: after a time (s) or a run length (m), one of them or both, whichever comes first.

    See Also
    --------
    skisnow.Scenario
    skisnow.Start
    """

    duration: Annotated[
        float | None,
        Quantity(
            "run.duration_s",
            "simulated time; with length_m beside it, whichever comes first",
            label="ends after",
            lowest=0.0,
            highest=3600.0,
            above=True,
        ),
    ] = None
    length: Annotated[
        float | None,
        Quantity(
            "run.length_m",
            "length of the path of the boots' middle after which the run is done",
            label="ends after a way of",
            lowest=0.0,
            highest=100_000.0,
            above=True,
        ),
    ] = None

    __repr__ = declared_text

    def __post_init__(self) -> None:
        require_declared(self)
