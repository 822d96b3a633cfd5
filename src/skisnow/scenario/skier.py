"""The skier of a run: its task, and the numbers of its control."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal, TypeAlias

from .._support.messages import Message
from .._support.units import DEGREE
from ..parameters import Allowed, Condition, Declared, Label, Quantity

Steers: TypeAlias = Literal["turns", "gates", "side-slip", "wedge"]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Skier(Declared):
    """Steering, body and control of a balanced skier, SI and rad.

    steers, stops_after: By a plan of turns over time, through the gates of the scenario's course, or straight: a
        side-slip at `brakes_to` that stops after `stops_after` (s), or a wedge to a stop.
    first_turn, turn_time, turns, turn_angle, first_to_left: The plan: when the first half turn begins (s), how long a
        whole turn takes (s), how many there are, the first one counted as a half, the course at the edge change (rad),
        and to which side the first one goes.
    pole_clearance, line_rate: Through gates: distance at which the boots' middle passes the turning poles (m), and the
        rate (1/s) at which carved turns return to the line.
    brakes_to: Target speed of the braking in skidded turns (m/s); 0: turns are carved as far as the snow holds.
    assumed_hardness, assumed_strength: H_V (N/m³) and S_f (N/m²) that the control assumes; 0: those of the scenario.
    longest_leg, shortest_leg, leg_load, greatest_edge, greatest_hip, hip_torque: Limits of the body: leg (m), load of
        both legs (body weights), edge angle, yaw of the body against the skis (rad), torque of the hips (N m).
    greatest_shift, greatest_shift_speed: Limits of the shift of the centre of mass along the skis (m) and its rate
        (m/s).
    greatest_lean, greatest_slip, least_slip, braking, outer_share, edge_rate, leg_gain, leg_yielding, edge_gain: Of the
        control: lean and slip that it plans (rad), deceleration over the speed that is too much (1/s), share of the
        load on the outer ski, corner frequency of the edge angle (1/s), gain of legs and edges on the error of the
        capture point, and rate at which legs give way (1/s).
    highest_flight: Height of the feet over the snow at which a flight ends the run (m).
    control_period: Time between two decisions (s).

    References
    ----------
    The page docs/methods/skier.md.
    """

    steers: Annotated[
        Steers,
        Quantity(
            "skier.steers",
            "basis of the steering: turns planned over time, the gates of the course, a side-slip or a wedge to a stop",
            origin="choice: needs no course",
        ),
        Label(Message("steers by")),
    ] = "turns"
    first_turn: Annotated[
        float,
        Quantity("skier.first_turn_s", "when the first half turn begins"),
        Label(Message("first turn")),
        Allowed(0.0, origin="choice: time to begin to lean"),
        Condition("skier.steers", "turns"),
    ] = 0.8
    turn_time: Annotated[
        float,
        Quantity("skier.turn_time_s", "from edge change to edge change"),
        Label(Message("time of a turn")),
        Allowed(0.0, 1e6, above=True, origin="choice: an easy rhythm"),
        Condition("skier.steers", "turns"),
    ] = 2.0
    turns: Annotated[
        float,
        Quantity("skier.turns", "how many turns, the first one a half; then straight on"),
        Label(Message("turns")),
        Allowed(0.0, 1e6, above=True, origin="choice: as in the published simulation of consecutive turns"),
        Condition("skier.steers", "turns"),
    ] = 4.5
    turn_angle: Annotated[
        float,
        Quantity("skier.turn_angle_deg", "course at the edge change, from the fall line"),
        Label(Message("course at the edge change")),
        Allowed(1.0, 80.0, origin="choice: that of gates 13 m apart and 3 m across"),
        Condition("skier.steers", "turns"),
    ] = 30.0 * DEGREE
    first_to_left: Annotated[
        bool,
        Quantity("skier.first_to_left", "whether the first turn goes to the left"),
        Label(Message("first turn to the left")),
        Condition("skier.steers", "turns"),
    ] = True
    pole_clearance: Annotated[
        float,
        Quantity("skier.pole_clearance_m", "distance at which the middle of the boots passes a turning pole"),
        Label(Message("clearance from the pole")),
        Allowed(0.0, 10.0, origin="choice: half the stance, and what the line is missed by"),
        Condition("skier.steers", "gates"),
    ] = 0.85
    brakes_to: Annotated[
        float,
        Quantity(
            "skier.brakes_to_m_per_s",
            "speed to which skidded turns brake; 0: turns are carved, as far as the snow holds",
        ),
        Label(Message("brakes to")),
        Allowed(0.0, 40.0, origin="choice: carved turns"),
    ] = 0.0
    carves: Annotated[
        bool,
        Quantity("skier.carves", "whether turns through gates that skid up to the fall line carve behind it"),
        Label(Message("carves behind the fall line")),
        Condition("skier.steers", "gates"),
    ] = False
    stops_after: Annotated[
        float,
        Quantity("skier.stops_after_s", "when a side-slip begins to stop"),
        Label(Message("stops after")),
        Allowed(0.0, 1e6, origin="choice: time to settle"),
        Condition("skier.steers", "side-slip"),
    ] = 3.0
    assumed_hardness: Annotated[
        float,
        Quantity("skier.assumed_H_V_N_per_mm3", "H_V that the control assumes; 0: that of the scenario"),
        Label(Message("assumed H_V")),
        Allowed(0.0, 100.0, origin="choice: the nominal snow"),
    ] = 0.0
    assumed_strength: Annotated[
        float,
        Quantity("skier.assumed_S_f_N_per_mm2", "S_f that the control assumes; 0: that of the scenario"),
        Label(Message("assumed S_f")),
        Allowed(0.0, 100.0, origin="choice: the nominal snow"),
    ] = 0.0
    line_rate: Annotated[
        float,
        Quantity("skier.line_rate_per_s", "rate at which carved turns go back to the line through gates"),
        Label(Message("rate back to the line")),
        Allowed(0.0, 100.0, origin="found by trial"),
        Condition("skier.steers", "gates"),
    ] = 2.0
    longest_leg: Annotated[
        float,
        Quantity("skier.longest_leg_m", "greatest distance from the middle of the feet to the centre of mass"),
        Label(Message("longest leg")),
        Allowed(0.1, 2.0, origin="centre of mass of a man of 1.76 m who stands, and 7 cm of sole, binding and ski"),
    ] = 1.05
    shortest_leg: Annotated[
        float,
        Quantity(
            "skier.shortest_leg_m", "height of the centre of mass over the feet in the deepest crouch of a landing"
        ),
        Label(Message("shortest leg")),
        Allowed(0.05, 1.0, origin="choice: knees drawn up between 0.6 m, the usual height, and the snow"),
    ] = 0.32
    leg_load: Annotated[
        float,
        Quantity("skier.leg_load", "load of both legs, in body weights, that landings aim at at most"),
        Label(Message("greatest load of the legs")),
        Allowed(1.1, 20.0, origin="choice: within the peaks measured in slalom, 2.5 to 4"),
    ] = 3.0
    greatest_edge: Annotated[
        float,
        Quantity("skier.greatest_edge_deg", "greatest edge angle that it sets"),
        Label(Message("greatest edge angle")),
        Allowed(1.0, 80.0, origin="measured of slalom racers at gates 10 m apart, 65.7 ± 1.7° (Reid 2020)"),
    ] = 66.0 * DEGREE

    greatest_hip: Annotated[
        float,
        Quantity("skier.greatest_hip_deg", "greatest yaw of the body against the skis, hips and trunk together"),
        Label(Message("greatest hip angle")),
        Allowed(
            10.0, 90.0, origin="rotation of hips (35 to 45°) and trunk (30 to 40°) of adults together, less a margin"
        ),
    ] = 60.0 * DEGREE
    hip_torque: Annotated[
        float,
        Quantity("skier.hip_torque_Nm", "greatest torque of both legs about the body's long axis"),
        Label(Message("greatest hip torque")),
        Allowed(1.0, 500.0, origin="isometric rotation strength of the hips of men, some 60 to 90 N m a leg"),
    ] = 150.0
    greatest_shift: Annotated[
        float,
        Quantity("skier.shift_m", "greatest shift of the centre of mass along the skis"),
        Label(Message("greatest shift fore and aft")),
        Allowed(0.0, 0.5, origin="half a foot and what boot and ski hold besides"),
    ] = 0.15
    greatest_shift_speed: Annotated[
        float,
        Quantity("skier.shift_speed_m_per_s", "greatest speed of this shift"),
        Label(Message("greatest speed fore and aft")),
        Allowed(0.0, 10.0, origin="found by trial: with 2.5 the loads peak at seven weights"),
    ] = 1.5
    greatest_lean: Annotated[
        float,
        Quantity("skier.greatest_lean_deg", "greatest lean of balance that it plans, from the snow's normal"),
        Label(Message("greatest planned lean")),
        Allowed(1.0, 80.0, origin="found by trial: below the leg's reach, arccos(0.6/1.05) = 55°"),
    ] = 50.0 * DEGREE
    greatest_slip: Annotated[
        float,
        Quantity("skier.greatest_slip_deg", "greatest planned angle between skis and path"),
        Label(Message("greatest planned slip")),
        Allowed(1.0, 60.0, origin="found by trial: on 25° turns settle at 9.7 m/s, asked for 9"),
    ] = 28.0 * DEGREE
    least_slip: Annotated[
        float,
        Quantity("skier.least_slip_deg", "planned angle between skis and path in a turn that need not brake"),
        Label(Message("least planned slip")),
        Allowed(1.0, 60.0, origin="found by trial: skis grip below 3°"),
    ] = 13.0 * DEGREE
    braking: Annotated[
        float,
        Quantity("skier.braking_per_s", "deceleration over the speed that is too much"),
        Label(Message("braking")),
        Allowed(0.0, 10.0, origin="found by trial"),
    ] = 0.8
    outer_share: Annotated[
        float,
        Quantity("skier.outer_share", "share of the load that the outer ski is to bear in a turn"),
        Label(Message("share of the outer ski")),
        Allowed(0.5, 0.9, origin="choice: within 55 to 80 %"),
    ] = 0.65
    edge_rate: Annotated[
        float,
        Quantity("skier.edge_rate_per_s", "corner frequency of the edge angle"),
        Label(Message("speed of the edge angle")),
        Allowed(0.1, 1000.0, origin="found by trial: 5.6 Hz"),
    ] = 35.0
    leg_gain: Annotated[
        float,
        Quantity("skier.leg_gain", "gain of the legs on the error of the capture point"),
        Label(Message("gain of the legs")),
        Allowed(0.0, 100.0, origin="found by trial"),
    ] = 0.7
    leg_yielding: Annotated[
        float,
        Quantity(
            "skier.leg_yielding_per_s",
            "sideways speed at which the legs yield, per distance of the centre of pressure from its target",
        ),
        Label(Message("yielding of the legs")),
        Allowed(
            0.0,
            100.0,
            origin="found by trial: at 5 ms a straight run magnifies the last bits with 1 more than with 0.7",
        ),
    ] = 0.7
    edge_gain: Annotated[
        float,
        Quantity("skier.edge_gain", "gain of the edges on the same error"),
        Label(Message("gain of the edges")),
        Allowed(0.0, 100.0, origin="choice: what balances it"),
    ] = 1.0
    highest_flight: Annotated[
        float,
        Quantity("skier.highest_flight_m", "height of the feet over the snow at which a flight of 0.3 s ends the run"),
        Label(Message("highest flight")),
        Allowed(0.0, 100.0, origin="choice: legs brake a fall of 2 m on half a metre"),
    ] = 2.0
    control_period: Annotated[
        float,
        Quantity("skier.control_period_ms", "time between two decisions of the control, independent of run.output_ms"),
        Label(Message("period of the control")),
        Allowed(1.0, 50.0, origin="choice: with 10 legs that give way make the loads swing"),
    ] = 5e-3
