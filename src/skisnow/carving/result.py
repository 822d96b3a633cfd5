"""Result of a steady carve or a ski at rest: numbers of the equilibrium, its outcome, remedies."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Final, Literal, TypeAlias

import numpy as np

from .._support.arrays import BoolArray, FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message, template
from .._support.units import MM, Facts, Shown, amount
from ..ski.beam import ClampedSki
from ..snow.properties import SnowProperties
from .edge_line import EdgeLine
from .outputs import CarveRequest
from .sensitivity import CarveDerivatives, Sensitivity
from .solve import Conditions, Solution

Outcome: TypeAlias = Literal["equilibrium", "slips", "sinks", "bridges", "not_converged"]

SINKING_DEPTH: Final = 0.30
"""Edge depth (m) beyond which a ski counts as swallowed: no balance above it (modelling assumption)."""
NOTHING_TO_SPARE: Final = 1e-7
"""Share of the side force that Newton's method leaves open where pressure along the base's normal just balances it."""
LARGE_SLOPE: Final = 0.35
"""Slope of the bent ski, and twist (rad), beyond which beams of small deflection fail (modelling assumption: 6 % in
the cosine)."""

REMEDIES: Final[dict[Outcome, str]] = {
    "equilibrium": "",
    "slips": Message(
        "the snow cannot hold the side force: reduce edge angle or load, or use stronger snow; the numbers are those "
        "of an edge that is held artificially"
    ),
    "sinks": Message(
        "no balance above {sinking_depth:.0f} cm: the snow is too soft for this load", sinking_depth=SINKING_DEPTH * 1e2
    ),
    "bridges": Message(
        "the ski touches the snow in separate pieces, or not under the boot: softer snow, a softer ski, less camber "
        "or a shorter clamp closes the gap"
    ),
    "not_converged": Message(
        "no equilibrium was found: try a smaller unloading ratio, more elements or a lower edge angle"
    ),
}
"""What to do about an outcome, in words."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Equilibrium(Shown):
    """A ski in equilibrium with the snow. SI, radians; None where a number does not exist.

    Attributes
    ----------
    outcome
        "equilibrium"; "slips": the side force is beyond the shear strength, all numbers are those of the held edge;
        "bridges": the contact is not one piece or misses the boot; "sinks" and "not_converged" have no numbers.
        Where several apply: not_converged, sinks, slips, bridges, equilibrium.
    remedy
        Recommended action.
    side_force, side_force_limit
        Load × tan ϑ, and S_f ∫ e ds over the edge that is below the surface (N). With a shear law S_f is its failure
        stress there; with a penetration law along the base's normal the limit is the pressure's part across,
        ∫ f tan(ϑ + φ) ds.
    holds
        Whether the limit is not exceeded.
    turn_radius_boot
        Radius of the circle through the edge line at the boot and 0.4 m before and behind it (m); None for a ski that
        is flat or at rest.
    other_radius
        Computes `turn_radius_boot_other_spread`, or its value.
    turn_radius_chord
        Radius of the circle through the edge line at the boot and at both ends of the contact (m).
    contact_length
        First and last place at which the edge is below the undisturbed surface (m). Between them it meets snow or its
        groove and can carry side force.
    bearing_length
        Length of the places that carry force (m): without a rebound of the groove, parts of the contact carry none.
    afterbody_depth_ratio
        Mean edge depth of the contact behind the boot over that before it.
    forebody_load, afterbody_load
        Force of the snow before and behind the boot, along its normal (N).
    boot_pitch_moment
        Moment of boot and skier about the ski's cross axis, positive where they press the tip down (N m):
        ∫ s (f cos ϑ + τ e sin ϑ) ds.
    station
        Places along the ski, from the boot, positive forward, tip to tail (m), shape (n,), as all that follow.
    edge_depth
        Depth of the edge below the undisturbed surface (m); negative: above it.
    force_per_length
        Force of the snow, along its normal (N/m).
    bending
        Deflection of the base against the ski held straight at the boot, away from the snow (m).
    twist
        Growth of the edge angle against that at the boot (rad).
    edge_line
        Position of the edge in the snow surface, towards the inside of the turn (m).
    residual_force, residual_moment
        Differences of the snow's force and its moment about the boot from load and moment (N, N m); the moment is the
        balanced one.
    warnings
        Reasons why the answer is outside the range of the model.
    iterations
        Iterations of Newton's method.
    request
        Ski, snow and load of the question, for `sensitivity`; None if the answer has no derivatives.
    median_radius
        Computes `turn_radius_median`.

    See Also
    --------
    skisnow.carve
    skisnow.rest
    """

    outcome: Outcome
    remedy: str
    holds: bool | None
    side_force: float | None
    side_force_limit: float | None
    turn_radius_boot: float | None
    other_radius: Callable[[], float | None] | float | None
    turn_radius_chord: float | None
    contact_length: float | None
    bearing_length: float | None
    afterbody_depth_ratio: float | None
    forebody_load: float | None
    afterbody_load: float | None
    boot_pitch_moment: float | None
    station: FloatArray
    edge_depth: FloatArray | None
    force_per_length: FloatArray | None
    bending: FloatArray | None
    twist: FloatArray | None
    edge_line: FloatArray | None
    residual_force: float | None
    residual_moment: float | None
    warnings: tuple[Message, ...]
    iterations: int
    request: CarveRequest | None = None
    median_radius: Callable[[], float | None] | None = None

    def derivatives(self) -> CarveDerivatives:
        """Exact derivatives of outputs by parameters, at this equilibrium.

        Raises ParameterError: there is no equilibrium; or its groove follows the path, other laws of the snow apply, or
            the footprint is not rigid.
        """
        if self.request is None:
            raise ParameterError(
                "the carve has no derivatives. They exist for an equilibrium with the groove along the edge, the "
                "snow's own H_V and S_f, and a rigid footprint."
            ).tag("no_derivatives")
        return CarveDerivatives(self.request)

    def sensitivity(self, output: str, parameters: Iterable[str]) -> tuple[Sensitivity, ...]:
        """Derivatives of an output by parameters.

        output: A name of `skisnow.carving.outputs.OUTPUTS`, such as ``turn_radius_boot_m``.
        parameters: Such as ``ski.waist_width_mm``, ``ski.EI_N_m2[2]`` (second of the list), ``edit.sidecut_depth``,
            ``snow.H_V_N_per_mm3``, ``load_N``: `derivatives` lists them.
        Returns: In units per unit and in % per %, with the distance to the next kink.
        Raises ParameterError: a name is unknown, or there are no derivatives.

        References
        ----------
        The page docs/methods/carved-turn.md.
        """
        return self.derivatives().sensitivity(output, parameters)

    @property
    def turn_radius_boot_other_spread(self) -> float | None:
        """Turn radius at the boot (m) with the other spread of the side force along the edge, all else alike.

        Shows how much depends on that choice. A second equilibrium, computed on demand; None if it is not found.
        """
        return self.other_radius() if callable(self.other_radius) else self.other_radius

    @property
    def turn_radius_median(self) -> float | None:
        """Median over the contact of the radius of circles through the edge line at a place and 0.1 m on both sides.

        By length, and of the curvature (m). None for a ski that is flat or at rest.
        """
        return None if self.median_radius is None else self.median_radius()

    @property
    def total_force(self) -> float | None:
        """Magnitude of load and side force together (N)."""
        if self.side_force is None or self.forebody_load is None or self.afterbody_load is None:
            return None
        return math.hypot(self.side_force, self.forebody_load + self.afterbody_load)

    @property
    def grip_utilisation(self) -> float | None:
        """Side force over its limit; None without a limit above 0."""
        return (
            self.side_force / self.side_force_limit if self.side_force is not None and self.side_force_limit else None
        )

    def _repr_facts(self) -> Facts:
        """Title with the outcome, and rows with side force, turn radius, contact, depths and warnings."""
        deepest = None if self.edge_depth is None else float(np.max(self.edge_depth)) / MM
        holds = {True: "holds", False: "does not hold", None: "unknown"}[self.holds]
        limit = f"of {amount(self.side_force_limit, 'N')}: {holds}"
        rows = (
            ("side force", f"{amount(self.side_force, 'N')} {limit}"),
            ("turn radius", amount(self.turn_radius_boot, "m")),
            ("side force spread otherwise", amount(self.turn_radius_boot_other_spread, "m")),
            ("contact", amount(self.contact_length, "m")),
            ("edge depth", f"at most {amount(deepest, 'mm')}"),
            ("afterbody", f"{amount(self.afterbody_depth_ratio)} of the forebody's depth"),
            ("warnings", str(len(self.warnings))),
        )
        return Facts(self.outcome.replace("_", " "), rows)


def equilibrium_of(
    model: ClampedSki,
    conditions: Conditions,
    snow: SnowProperties,
    solution: Solution,
    note: tuple[Message, ...] = (),
    *,
    elements: int | None = None,
    other: Callable[[], float | None] | None = None,
) -> Equilibrium:
    """Outcome and numbers of a solution; `note` precedes its own warnings.

    `elements`: those of the request; None where the equilibrium has no derivatives. `other`: radius with the other
    spread of side force, computed at once under laws from outside, which need not be picklable.
    """
    station = model.stations.station
    if solution.converged:
        sinks = float(np.max(solution.edge_depth)) > SINKING_DEPTH
    else:  # too soft to carry the load even with the whole base at the largest depth
        area = float(model.stations.weight @ model.stations.width) * math.cos(conditions.edge_angle)
        sinks = conditions.load > conditions.hardness * SINKING_DEPTH * area
    if not solution.converged or sinks:
        outcome: Outcome = "sinks" if sinks else "not_converged"
        nothing = (None,) * 12
        return Equilibrium(outcome, REMEDIES[outcome], *nothing, station, *(None,) * 7, (), solution.iterations)
    line = EdgeLine(model, conditions.edge_angle, solution)
    weight, depth, force = model.stations.weight, solution.edge_depth, solution.force_per_length
    below = depth > 0.0
    limit = _side_force_limit(conditions, snow, solution, weight, conditions.edge_angle + line.bend[1])
    holds = _edge_holds(conditions, limit)
    outcome = "slips" if not holds else "bridges" if _bridges(station, below) else "equilibrium"
    ends = line.contact_ends(depth)
    of_force = float(weight @ (force * station))
    drawn_from = force if conditions.by_reaction else np.maximum(depth, 0.0)
    of_shear = solution.shear_stress * float(weight @ (drawn_from * station))
    before = float(weight @ (force * np.heaviside(station, 0.5)))
    turns = conditions.side_force > 0.0
    radius = line.radius_at_boot() if turns else None
    if radius is None:
        other = None
    return Equilibrium(
        outcome=outcome,
        remedy=REMEDIES[outcome],
        holds=holds,
        side_force=conditions.side_force,
        side_force_limit=limit,
        turn_radius_boot=radius,
        other_radius=other() if other is not None and conditions.laws is not None else other,
        turn_radius_chord=line.radius_over(*ends) if turns else None,
        contact_length=ends[0] - ends[1],
        bearing_length=float(weight[force > 0.0].sum()),
        afterbody_depth_ratio=_depth_ratio(station, weight, depth),
        forebody_load=before,
        afterbody_load=float(weight @ force) - before,
        boot_pitch_moment=math.cos(conditions.edge_angle) * of_force + math.sin(conditions.edge_angle) * of_shear,
        station=station,
        edge_depth=depth,
        force_per_length=force,
        bending=line.bend[0],
        twist=line.bend[1],
        edge_line=line.position,
        residual_force=float(weight @ force) - conditions.load,
        residual_moment=conditions.pitch_of_force * of_force + conditions.pitch_of_shear * of_shear - conditions.moment,
        warnings=(*note, *_warnings_of_line(line)),
        iterations=solution.iterations,
        request=None
        if elements is None
        else CarveRequest(model, conditions, snow.failure_shear_stress, solution, elements),
        median_radius=partial(line.radius_median, *ends) if turns else None,
    )


def _side_force_limit(
    conditions: Conditions, snow: SnowProperties, solution: Solution, weight: FloatArray, edge_angle: FloatArray
) -> float | None:
    """Largest side force of the edge (N): by the law if given, else S_f ∫ e ds."""
    depth, stress = solution.edge_depth, snow.failure_shear_stress
    if conditions.laws is not None and (conditions.laws.shear is not None or conditions.laws.along_base_normal):
        return conditions.laws.side_force_limit(depth, solution.force_per_length, edge_angle, weight)
    return None if stress is None else stress * float(weight @ np.maximum(depth, 0.0))


def _edge_holds(conditions: Conditions, limit: float | None) -> bool:
    """True if the side force is at most the limit (N), or 0; None as a limit holds no side force."""
    if conditions.side_force == 0.0 or limit is None:
        return conditions.side_force == 0.0
    # a pressure along the base's normal holds a ski that does not twist with nothing to spare
    rounding = NOTHING_TO_SPARE if conditions.laws is not None and conditions.laws.along_base_normal else 0.0
    return conditions.side_force <= limit * (1.0 + rounding)


def radius_at_boot(model: ClampedSki, conditions: Conditions, solution: Solution) -> float | None:
    """Radius (m) of the circle through the edge line at the boot; None without an equilibrium."""
    if not solution.converged or float(np.max(solution.edge_depth)) > SINKING_DEPTH:
        return None
    return EdgeLine(model, conditions.edge_angle, solution).radius_at_boot()


def _bridges(station: FloatArray, below: BoolArray) -> bool:
    """True if the contact has several pieces, or none under the boot."""
    pieces = int(below[0]) + int(np.count_nonzero(np.diff(below.astype(int)) == 1))
    contact = station[below]
    return pieces != 1 or not contact[-1] <= 0.0 <= contact[0]


def _depth_ratio(station: FloatArray, weight: FloatArray, depth: FloatArray) -> float | None:
    """Mean depth of the afterbody over that of the forebody, both in contact; None if either has no contact."""
    before, behind = (depth > 0.0) & (station > 0.0), (depth > 0.0) & (station < 0.0)
    if not (before.any() and behind.any()):
        return None
    mean_before, mean_behind = (float(weight[part] @ depth[part] / weight[part].sum()) for part in (before, behind))
    return mean_behind / mean_before


def _warnings_of_line(line: EdgeLine) -> tuple[Message, ...]:
    """Warnings of a bend or twist too large for the linear beam."""
    warnings = []
    slope, twist = line.greatest_slope(), float(np.max(np.abs(line.bend[1])))
    if slope > LARGE_SLOPE:
        words = template(
            "the ski bends to a slope of {slope:.2f}: beyond {limit} beams of small deflection are inexact"
        )
        warnings.append(Message(words, slope=slope, limit=LARGE_SLOPE))
    if twist > LARGE_SLOPE:
        words = template("the ski twists by {angle:.0f} degrees: more than a linear torsion bar can tell")
        warnings.append(Message(words, angle=math.degrees(twist)))
    return tuple(warnings)
