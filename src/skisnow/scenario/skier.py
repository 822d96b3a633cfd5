"""The skier of a run: what it does, and the numbers of its control."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal, TypeAlias

from .._support.units import DEGREE
from ..parameters import Condition, Quantity, declared_text, require_declared

Steers: TypeAlias = Literal["turns", "gates"]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Skier:
    """Steering, body and control of a balanced skier, SI and rad.

    Attributes
    ----------
    steers
        By a plan of turns over time, or through the gates of the scenario's course.
    first_turn, turn_time, turns, first_to_left
        The plan: when the first half turn begins (s), how long a whole turn takes (s), how many there are, the first
        one counted as a half, and to which side it goes.
    pole_clearance, sight, line_rate
        Through gates: how far beside the turning poles the boots' middle is to pass (m), the time ahead (s) at which
        the line is looked at, and the rate (1/s) at which the skier goes back to it.
    longest_leg
        Greatest distance from the middle of the feet to the centre of mass (m).
    greatest_edge
        Greatest edge angle (rad).
    greatest_lean
        That it plans (rad).
    leg_gain, leg_yielding, carving_share, edge_beyond_lean, blunt_edge, edge_gain, edge_change, edge_filter,
    share_filter, load_filter, lean_more, reach, lag, correction, trusted_edge, touch, lifted_share, bearing_share,
    foresight, foresight_step, slowest, greatest_pressed, control_period
        Parameters of the control, explained in docs/methods/skier.md.

    See Also
    --------
    skisnow.Scenario

    References
    ----------
    The page docs/methods/skier.md.
    """

    steers: Annotated[
        Steers,
        Quantity(
            "skier.steers",
            "basis of the steering: turns planned over time, or the gates of the course",
            label="steers by",
            origin="choice: needs no course",
        ),
    ] = "turns"
    first_turn: Annotated[
        float,
        Quantity(
            "skier.first_turn_s",
            "when the first half turn begins",
            label="first turn",
            lowest=0.0,
            origin="choice: time to begin to lean",
            condition=Condition("skier.steers", "turns"),
        ),
    ] = 0.8
    turn_time: Annotated[
        float,
        Quantity(
            "skier.turn_time_s",
            "from edge change to edge change",
            label="time of a turn",
            lowest=0.0,
            highest=1e6,
            above=True,
            origin="choice: an easy rhythm",
            condition=Condition("skier.steers", "turns"),
        ),
    ] = 2.0
    turns: Annotated[
        float,
        Quantity(
            "skier.turns",
            "how many turns, the first one a half; then straight on",
            label="turns",
            lowest=0.0,
            highest=1e6,
            above=True,
            origin="choice: as in the published simulation of consecutive turns",
            condition=Condition("skier.steers", "turns"),
        ),
    ] = 4.5
    first_to_left: Annotated[
        bool,
        Quantity(
            "skier.first_to_left",
            "whether the first turn goes to the left",
            label="first turn to the left",
            condition=Condition("skier.steers", "turns"),
        ),
    ] = True
    pole_clearance: Annotated[
        float,
        Quantity(
            "skier.pole_clearance_m",
            "how far beside a turning pole the middle of the boots is to pass",
            label="clearance from the pole",
            lowest=0.0,
            highest=10.0,
            origin="choice: half the stance, and what the line is missed by",
            condition=Condition("skier.steers", "gates"),
        ),
    ] = 0.8
    sight: Annotated[
        float,
        Quantity(
            "skier.sight_s",
            "through gates: time ahead at which the line is looked at and steered to",
            label="time ahead",
            lowest=0.05,
            highest=5.0,
            origin="found by trial",
            condition=Condition("skier.steers", "gates"),
        ),
    ] = 0.3
    line_rate: Annotated[
        float,
        Quantity(
            "skier.line_rate_per_s",
            "through gates: rate at which it goes back to the line",
            label="rate back to the line",
            lowest=0.0,
            highest=100.0,
            origin="found by trial",
            condition=Condition("skier.steers", "gates"),
        ),
    ] = 2.0
    longest_leg: Annotated[
        float,
        Quantity(
            "skier.longest_leg_m",
            "greatest distance from the middle of the feet to the centre of mass",
            label="longest leg",
            lowest=0.1,
            highest=2.0,
            origin="centre of mass of a man of 1.76 m who stands, and 7 cm of sole, binding and ski",
        ),
    ] = 1.05
    greatest_edge: Annotated[
        float,
        Quantity(
            "skier.greatest_edge_deg",
            "greatest edge angle that it sets",
            label="greatest edge angle",
            lowest=1.0,
            highest=80.0,
            origin="measured of slalom racers at gates 10 m apart, 65.7 ± 1.7° (Reid 2020)",
        ),
    ] = 66.0 * DEGREE
    greatest_lean: Annotated[
        float,
        Quantity(
            "skier.greatest_lean_deg",
            "greatest lean of balance that it plans, from the snow's normal",
            label="greatest planned lean",
            lowest=1.0,
            highest=80.0,
            origin="found by trial: little below the leg's reach, arccos(0.6/1.05) = 55°",
        ),
    ] = 48.0 * DEGREE
    leg_gain: Annotated[
        float,
        Quantity(
            "skier.leg_gain",
            "gain of the legs on the error of the capture point",
            label="gain of the legs",
            lowest=0.0,
            highest=100.0,
            origin="found by trial",
        ),
    ] = 0.7
    leg_yielding: Annotated[
        float,
        Quantity(
            "skier.leg_yielding_per_s",
            "speed aside at which legs give way, over how far the centre of pressure is from the requested place",
            label="yielding of the legs",
            lowest=0.0,
            highest=100.0,
            origin="found by trial: below 0.6 the loads swing at 5 to 8 Hz, above 2 by the steps of the control",
        ),
    ] = 1.0
    carving_share: Annotated[
        float,
        Quantity(
            "skier.carving_share",
            "share of the straightest carve's acceleration at which edges change from a skid to a carve",
            label="carving from",
            lowest=0.0,
            highest=1.0,
            below=True,
            origin="found by trial: at 0 lines through gates are cut, at 0.6 loads swing more",
        ),
    ] = 0.3
    edge_beyond_lean: Annotated[
        float,
        Quantity(
            "skier.edge_beyond_lean_deg",
            "edge angle beyond the lean of balance in a carve",
            label="edge beyond the lean",
            lowest=0.0,
            highest=45.0,
            origin="choice: so that the ski holds, with the lean not known better",
        ),
    ] = 3.0 * DEGREE
    blunt_edge: Annotated[
        float,
        Quantity(
            "skier.blunt_edge_deg",
            "edge angle over which the lift of the boot by the edge is rounded where it goes through flat",
            label="rounding of the edge change",
            lowest=0.1,
            highest=30.0,
            origin="choice: an edge change of no jump in the speed of the legs",
        ),
    ] = 3.0 * DEGREE
    edge_gain: Annotated[
        float,
        Quantity(
            "skier.edge_gain",
            "gain of the turn, by the edges, on the same error",
            label="gain of the edges",
            lowest=0.0,
            highest=100.0,
            origin="found by trial",
        ),
    ] = 2.0
    edge_change: Annotated[
        float,
        Quantity(
            "skier.edge_change_per_s",
            "2π times the corner frequency with which the planned turn goes from side to side",
            label="speed of the edge change",
            lowest=0.1,
            highest=1000.0,
            origin="found by trial: 1.6 Hz",
        ),
    ] = 10.0
    edge_filter: Annotated[
        float,
        Quantity(
            "skier.edge_filter_per_s",
            "2π times the corner frequency of the edge angle",
            label="speed of the edge angle",
            lowest=0.1,
            highest=1000.0,
            origin="found by trial: 3 Hz",
        ),
    ] = 19.0
    share_filter: Annotated[
        float,
        Quantity(
            "skier.share_filter_per_s",
            "the same of what balance asks of the edges",
            label="speed of the balance by edges",
            lowest=0.1,
            highest=1000.0,
            origin="found by trial: 3 Hz",
        ),
    ] = 19.0
    load_filter: Annotated[
        float,
        Quantity(
            "skier.load_filter_per_s",
            "the same of the estimates from the loads",
            label="speed of what the loads teach",
            lowest=0.1,
            highest=1000.0,
            origin="found by trial: 4 Hz",
        ),
    ] = 25.0
    lean_more: Annotated[
        float,
        Quantity(
            "skier.lean_more",
            "capture point wanted, over that of balance",
            label="lean beyond balance",
            lowest=0.0,
            highest=3.0,
            origin="found by trial",
        ),
    ] = 1.1
    reach: Annotated[
        float,
        Quantity(
            "skier.reach",
            "share of half the stance within which the centre of pressure is requested",
            label="reach",
            lowest=0.0,
            highest=1.0,
            origin="found by trial",
        ),
    ] = 0.8
    lag: Annotated[
        float,
        Quantity(
            "skier.lag_m",
            "way after which the path has the edge's curvature",
            label="lag",
            lowest=0.0,
            highest=10.0,
            origin="found by trial",
        ),
    ] = 0.6
    correction: Annotated[
        float,
        Quantity(
            "skier.correction_m",
            "by how much the loads may correct the planned place of the centre of mass, aside",
            label="correction by loads",
            lowest=0.0,
            highest=1.0,
            origin="found by trial",
        ),
    ] = 0.12
    trusted_edge: Annotated[
        float,
        Quantity(
            "skier.trusted_edge_deg",
            "edge angle above which loads count fully, with its square below: flatter skis follow the feet",
            label="edge of trusted loads",
            lowest=0.1,
            highest=80.0,
            origin="choice: twice what holds the weight aside on the race piste of the catalogue",
        ),
    ] = 10.0 * DEGREE
    touch: Annotated[
        float,
        Quantity(
            "skier.touch_per_s",
            "how fast a lifted ski is put down",
            label="touch",
            lowest=0.0,
            highest=1000.0,
            origin="found by trial",
        ),
    ] = 20.0

    lifted_share: Annotated[
        float,
        Quantity(
            "skier.lifted_share",
            "share of the load below which a ski counts as lifted",
            label="a ski is lifted below",
            lowest=0.0,
            highest=0.5,
            origin="choice: well below what a ski in the air weighs, 3 % of the skier",
        ),
    ] = 0.02
    bearing_share: Annotated[
        float,
        Quantity(
            "skier.bearing_share",
            "share of the weight below which the load of both skis tells nothing",
            label="skis bear from",
            lowest=0.0,
            highest=1.0,
            origin="choice: a fifth, where a leap has all but begun",
        ),
    ] = 0.2
    foresight: Annotated[
        float,
        Quantity(
            "skier.foresight_s",
            "time ahead over which it thinks its plan through",
            label="foresight",
            lowest=0.1,
            highest=10.0,
            origin="derived: what is later than 5.5 times the pendulum's time of 0.28 s weighs less than 0.4 %",
        ),
    ] = 1.6
    foresight_step: Annotated[
        float,
        Quantity(
            "skier.foresight_step_s",
            "time between the moments of its plan that it looks at",
            label="step of the foresight",
            lowest=0.001,
            highest=0.1,
            origin="choice: two steps of the control",
        ),
    ] = 0.02
    slowest: Annotated[
        float,
        Quantity(
            "skier.slowest_m_per_s",
            "speed with which lag and turns are computed at least",
            label="slowest speed in the control",
            lowest=0.1,
            highest=20.0,
            origin="choice: below the start speeds of the catalogue",
        ),
    ] = 2.0
    greatest_pressed: Annotated[
        float,
        Quantity(
            "skier.greatest_pressed_m_per_s2",
            "greatest acceleration by the slope's own bend that it counts with",
            label="pressing by the slope",
            lowest=0.0,
            highest=9.0,
            origin="choice: a fifth of gravity; planes have none",
        ),
    ] = 2.0
    control_period: Annotated[
        float,
        Quantity(
            "skier.control_period_ms",
            "time between two decisions of the control, independent of run.output_ms",
            label="period of the control",
            lowest=1.0,
            highest=50.0,
            origin="choice: 1/30 of an edge change",
        ),
    ] = 0.01

    __repr__ = declared_text

    def __post_init__(self) -> None:
        require_declared(self)
