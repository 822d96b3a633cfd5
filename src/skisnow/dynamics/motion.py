"""Steps of a body on skis over snow."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray, shaped
from .._support.errors import ParameterError
from ..compiled import core
from ..contact import ContactState, SnowContact
from .body import Body, BootMotion, FlexibleSki

STEPS_AT_ONCE: Final = 1000
"""Steps after which compiled code comes back, so that an interrupt is heard."""
TOLERANCE: Final = 1e-6
"""Error of position (m) that one step may make by its own estimate (modelling assumption; see the docs' frontier)."""
LONGEST_STEP: Final = 6e-3
"""Longest step (s) (modelling assumption)."""
SHORTEST_STEP: Final = 1e-7
"""Step (s) below which a run ends."""
CLOSENESS: Final = 0.2
"""Share of a step's own error to which Newton's method solves it . The last change counts times
its contraction, so a value ten times smaller moves ends by less than their error."""


class Ended(IntEnum):
    """Reason why a call of `Dynamics.advance` ended: time reached, step too small, or numbers not finite."""

    REACHED = 0
    STEP_TOO_SMALL = 1
    NOT_FINITE = 2


_LAST: Final = max(Ended)


@dataclass(frozen=True, slots=True, kw_only=True)
class StepControl:
    """Rule for the length of the time steps.

    Attributes
    ----------
    first
        The first step, ``longest`` at most, or with ``fixed`` every step (s), halved where it is not solved.
    fixed
        True for steps of constant length.
    tolerance
        Error of position of one step (m); one metre from the boots for rotations.
    longest, shortest
        Limits of a step that the error control chooses (s).
    closeness
        Share of a step's own error to which Newton's method solves it.
    """

    first: float = 1e-4
    fixed: bool = False
    tolerance: float = TOLERANCE
    longest: float = LONGEST_STEP
    shortest: float = SHORTEST_STEP
    closeness: float = CLOSENESS

    def __post_init__(self) -> None:
        for name in ("first", "tolerance", "longest", "shortest", "closeness"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise ParameterError("StepControl: {name} is {value!r}; it must be finite and above 0").tag(
                    "not_a_number", name=name, value=getattr(self, name)
                )
        if self.shortest > self.longest:
            raise ParameterError(
                "StepControl: shortest is {shortest!r}, above longest, {longest!r}; it must not be"
            ).tag("out_of_range", shortest=self.shortest, longest=self.longest)

    def compiled(self) -> core.StepRule:
        """The rule as the core's type."""
        rule = core.StepRule()
        rule.first, rule.fixed = self.first if self.fixed else min(self.first, self.longest), self.fixed
        rule.tolerance = self.tolerance
        rule.longest, rule.shortest = self.longest, self.shortest
        rule.closeness = self.closeness
        return rule


@dataclass(frozen=True, slots=True, eq=False)
class DynamicsState:
    """State of body and contact at one time; `Dynamics.state` returns it, `Dynamics.restore` accepts it."""

    motion: core.Dynamics
    contact: ContactState


MOMENT: Final[Mapping[str, slice]] = {
    "position": slice(1, 4),
    "rotation": slice(4, 13),
    "velocity": slice(13, 19),
    "energies": slice(19, 22),
    "snow_energies": slice(22, 26),
    "snow_losses": slice(26, 31),
    "work": slice(31, 37),
    "work_given": slice(37, 39),
}
"""Places in a row of `Dynamics.moment` after the time and before its skis; energies, losses and work in J.

energies: kinetic, potential, elastic in the skis.
snow_energies: recoverable ones of the snow: pressure, shear at edges, sticking friction, delayed penetration.
snow_losses: since `begin`, each never falls: penetration, shear, friction, damping with delayed depth; then the energy
    that the snow gave beyond the energy that it had stored.
work: since `begin`: taken by shear and friction, given by the normal force, taken by air and skis; the part of the
    normal force's work that the snow's dashpot absorbed.
work_given: since `begin`, by the motion of the boots, and by the push.
"""
_OF_SKIS: Final[int] = MOMENT["work_given"].stop


def moment_parts(rows: FloatArray, skis: Sequence[FlexibleSki]) -> dict[str, FloatArray]:
    """Arrays by name from rows (..., width) of `Dynamics.moment`: time (s), those of `MOMENT`, and of each ski these.

    pushes: force along the edge, forward positive; friction across the edge, and off the surface (N), (3,).
    along: depth of the edge (m), force and shear per length (N/m) at the m nodes, (3, m).
    beam_dofs: deflection (m), its slope and twist (rad) at each free node, (n,).
    boots: as `Dynamics.boots`, (6, 3).
    boot_wrench: as `Dynamics.boot_wrench`, (6,).
    """
    shape = rows.shape[:-1]
    parts: dict[str, FloatArray] = {"time": rows[..., 0]} | {name: rows[..., at] for name, at in MOMENT.items()}
    parts["rotation"] = parts["rotation"].reshape(*shape, 3, 3)
    of_skis, begin = rows[..., _OF_SKIS:].reshape(*shape, len(skis), -1), 0
    shapes = {"pushes": (3,), "along": (3, len(skis[0].unknown)), "beam_dofs": (len(skis[0].mass),)}
    for name, of_ski in (shapes | {"boots": (6, 3), "boot_wrench": (6,)}).items():
        end = begin + math.prod(of_ski)
        parts[name] = of_skis[..., begin:end].reshape(*shape, len(skis), *of_ski)
        begin = end
    return parts


class Dynamics:
    """A body on skis in motion, BDF2 with Newton's method at each step's end.

    Parameters
    ----------
    body
        Its masses and skis.
    contact
        Contact of the same number of runners, with the nodes of the skis' beams. The dynamics take it over: others must
        not update it.
    position, rotation
        Position of the body's origin in space (m), (3,), and its axes as columns, (3, 3).
    control
        Rule for the length of the steps.

    Raises
    ------
    ParameterError
        The numbers of runners and skis differ, the nodes of a runner differ from those of its ski, or place and
        rotation are invalid.
    """

    def __init__(
        self, body: Body, contact: SnowContact, position: FloatArray, rotation: FloatArray, control: StepControl
    ) -> None:
        if len(contact.runners) != len(body.skis):
            raise ParameterError("the body has {n_skis} skis, the contact {n_runners} runners").tag(
                "wrong_shape", n_skis=len(body.skis), n_runners=len(contact.runners)
            )
        for k, (ski, runner) in enumerate(zip(body.skis, contact.runners, strict=True)):
            nodes = 0 if runner.nodes is None else len(runner.nodes)
            if nodes != len(ski.unknown):
                raise ParameterError("ski {k} of the body has {n_unknown} nodes, its runner {nodes}").tag(
                    "wrong_shape", k=k, n_unknown=len(ski.unknown), nodes=nodes
                )
        self.body, self.contact = body, contact
        self.compiled = core.Dynamics(body.compiled(), contact.compiled, control.compiled())
        self.compiled.set_pose(shaped("position", position, (3,)), shaped("rotation", rotation, (3, 3)))
        inertia = [ski.inertia for ski in body.skis if ski.inertia is not None]
        self.feels_boots = len(inertia) == len(body.skis)
        if self.feels_boots:
            self.compiled.set_skis(np.ascontiguousarray(inertia, float))

    def move_boots(self, motions: Sequence[BootMotion]) -> None:
        """Move each boot against the body by its motion. Set new motions before these end.

        Before `find_equilibrium` they state the boots' places at rest.

        Raises
        ------
        ParameterError
            Skis and motions differ in number, or a ski has no inertia.
        """
        if not self.feels_boots:
            raise ParameterError("boots can move where each FlexibleSki has its inertia; one lacks it").tag("no_data")
        if len(motions) != len(self.body.skis):
            raise ParameterError("there are {n_motions} motions of boots for {n_skis} skis").tag(
                "wrong_shape", n_motions=len(motions), n_skis=len(self.body.skis)
            )
        self.compiled.move_boots(np.array([each.numbers for each in motions]))

    def hold_body(self) -> None:
        """Hold the body at its place: only boots that move carry the skis."""
        self.compiled.hold_body()

    def push(self, force: npt.ArrayLike, at: npt.ArrayLike) -> None:
        """Apply a force (N, in space) to the body at a place in its own frame (m), until another one is set."""
        self.compiled.set_push(shaped("push", force, (3,)), shaped("place of the push", at, (3,)))

    @property
    def boots(self) -> FloatArray:
        """Motion of each boot against the body, in its frame, (skis, 6, 3).

        Place (m), axes ahead, left and off the base, velocity (m/s), angular velocity (rad/s).
        """
        return self.compiled.boots.reshape(-1, 6, 3)

    @property
    def boot_wrench(self) -> FloatArray:
        """Force (N) and moment (N m) of each ski on its boot at the last time reached, (skis, 6).

        In the ski's axes, about the boot; not a number for a ski without inertia.
        """
        return self.moment[_OF_SKIS:].reshape(len(self.body.skis), -1)[:, -6:]

    def find_equilibrium(self) -> float:
        """Move to static equilibrium in height, roll, pitch and deflection; returns the size of Newton's last step (m).

        Position along the slope and heading stay.
        """
        return float(self.compiled.settle())

    def move_to(self, position: FloatArray, rotation: FloatArray) -> None:
        """Set position (m) and rotation of the body before `begin`; the deflections of its skis stay."""
        self.compiled.set_pose(shaped("position", position, (3,)), shaped("rotation", rotation, (3, 3)))

    def begin(self, velocity: FloatArray) -> None:
        """Start the motion at the present place of the body: velocity and angular velocity in its own axes (6,)."""
        self.compiled.set_velocity(shaped("velocity", velocity, (6,)))
        self.compiled.begin()

    def advance(self, until: float) -> Ended:
        """Take steps until a time (s), at which the last step ends exactly; Ctrl-C is possible between steps.

        Raises
        ------
        ParameterError
            The steps fail because a shear law in Python returns a strength that is not finite.
        """
        while True:
            ended = self.compiled.advance(until, STEPS_AT_ONCE)
            if ended <= _LAST:
                if ended != Ended.REACHED:
                    self.contact.require_finite_laws()
                return Ended(ended)

    def state(self) -> DynamicsState:
        """The motion and the contact's history now, for `restore`."""
        return DynamicsState(self.compiled.copy(), self.contact.state())

    def restore(self, state: DynamicsState) -> None:
        """Go back to a state of these dynamics: the steps that follow have the same bits as they had from there."""
        self.contact.restore(state.contact)
        self.compiled.assign(state.motion)

    @property
    def time(self) -> float:
        """Time since `begin` (s)."""
        return float(self.compiled.time)

    @property
    def position(self) -> FloatArray:
        """Position of the body's origin in space (m), (3,)."""
        return self.compiled.position

    @property
    def rotation(self) -> FloatArray:
        """The body's axes as columns in space, (3, 3)."""
        return self.compiled.rotation

    @property
    def velocity(self) -> FloatArray:
        """Velocity of the origin (m/s) and angular velocity (rad/s) in the body's axes, (6,)."""
        return self.compiled.velocity

    @property
    def moment(self) -> FloatArray:
        """All of the present moment as one row of numbers; `moment_parts` names them."""
        return self.compiled.moment

    def part(self, name: str) -> FloatArray:
        """Part of the present moment, such as "energies" (J), at the last time reached; `moment_parts` lists them."""
        return moment_parts(self.moment, self.body.skis)[name]

    @property
    def touches(self) -> bool:
        """True if a ski was in the snow at the end of the last step."""
        return bool(self.compiled.touches)

    @property
    def counts(self) -> tuple[int, int, int, int, int]:
        """Steps, rejected steps, evaluations of the contact, matrices factored, iterations of Newton's method."""
        return self.compiled.counts
