"""Any number of runners in one snow, each with its own pose; the snow's history is kept as internal variables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray, shaped
from .._support.errors import ParameterError
from .._support.units import Facts, Shown, field_facts
from ..compiled import core
from .contact_state import ContactState
from .laws import FrictionCallback, PressureCallback, StrengthCallback

if TYPE_CHECKING:
    from .runner import Runner
    from .snow_field import SnowField

Beams: TypeAlias = Sequence[npt.ArrayLike] | None

SPACING: Final = 0.02
"""Spacing of the lines of snow along a runner (m) (modelling assumption, as in the simulated turns)."""
ORTHONORMAL: Final = 1e-9
"""By how much a rotation may fail to be one."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ContactForces(Shown):
    """Forces of the snow on k runners.

    Attributes
    ----------
    wrench
        (k, 6): force (N) and moment (N m) about each boot, in the slope's axes.
    beam_loads
        For each runner (nodes, 3): force (N) and moments (N m) on deflection, its slope and twist; empty without beams.

    See Also
    --------
    skisnow.SnowContact
    """

    wrench: FloatArray
    beam_loads: tuple[FloatArray, ...]

    def _repr_facts(self) -> Facts:
        """Title, and a row with force (N) and moment (N m) for each runner."""
        parts = [[", ".join(f"{each:.4g}" for each in part) for part in (row[:3], row[3:])] for row in self.wrench]
        rows = tuple((f"runner {k}", f"force ({F}) N, moment ({M}) N m") for k, (F, M) in enumerate(parts))
        return Facts(f"on {len(self.wrench)} runners", rows)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Sections(Shown):
    """Depths, forces and velocities of a runner on each line of snow, from the tail on; all (n,).

    Attributes
    ----------
    position_along_ski, length
        Position from the boot, and the length of runner of the section (m).
    depth, edge_sine
        Depth of the deeper edge (m, < 0 above the snow), sine of the edge angle.
    left_depth, right_depth, left_place, right_place
        Depth of each edge and its place on the line (m).
    normal_force, shear, left_shear, right_shear, push, push_across, push_off
        Forces of the pressure, across the edges together and each of them, along the ski, and of friction across it in
        the surface and off the surface (N).
    sliding, sliding_aside, mu, rub, rub_aside, friction_load
        Velocity along the edge and aside (m/s), μ, the parts of it in use with the signs of the way, and the load that
        it acts on (N). Aside is across the edge in the surface, or at right angles to it in the base's plane.
    strength, left_used, right_used
        S_f (N/m²), and the share of the displacement to full strength that each edge uses (beyond ±1: slips).
    """

    position_along_ski: FloatArray
    length: FloatArray
    depth: FloatArray
    edge_sine: FloatArray
    left_depth: FloatArray
    right_depth: FloatArray
    left_place: FloatArray
    right_place: FloatArray
    normal_force: FloatArray
    shear: FloatArray
    left_shear: FloatArray
    right_shear: FloatArray
    push: FloatArray
    push_across: FloatArray
    push_off: FloatArray
    sliding: FloatArray
    sliding_aside: FloatArray
    mu: FloatArray
    rub: FloatArray
    rub_aside: FloatArray
    friction_load: FloatArray
    strength: FloatArray
    left_used: FloatArray
    right_used: FloatArray

    def _repr_facts(self) -> Facts:
        lengths = ("position_along_ski", "length", "depth", "left_depth", "right_depth", "left_place", "right_place")
        forces = ("normal_force", "shear", "left_shear", "right_shear", "push", "push_across", "push_off")
        units = dict.fromkeys(lengths, "m") | dict.fromkeys((*forces, "friction_load"), "N")
        units |= {"sliding": "m/s", "sliding_aside": "m/s", "strength": "N/m²"}
        return field_facts(self, units)


class SnowContact(Shown):
    """Runners in history-dependent snow.

    ``force`` evaluates a pose and leaves the snow unchanged; ``update`` accepts a step. Between them the history
    advances along the path from the last accepted pose, so that forces and acceptance of a long step agree.

    Parameters
    ----------
    snow
        The snow; contacts that share it meet each other's tracks once a runner has left them.
    runners
        One or more.
    spacing
        Spacing of the lines on which the contact is integrated (m), > 0.

    See Also
    --------
    skisnow.SnowField
    skisnow.Runner

    Notes
    -----
    Poses: ``position`` (k, 3) of the boots (m) and ``rotation`` (k, 3, 3) whose columns point ahead, left across the
    base and off the base, in the slope's axes. ``velocity`` (k, 6): of the boots (m/s), and angular (rad/s), in those
    axes. ``dt`` (s) is the time since the last accepted pose. Beams: for each runner (nodes, 3), deflection off the
    base (m), its slope towards the tail, twist (rad). Equations: docs/methods/contact.md.
    """

    def __init__(
        self,
        snow: SnowField,
        runners: Sequence[Runner],
        *,
        spacing: float = SPACING,
        instruction_set: str | None = None,
    ) -> None:
        if not runners:
            raise ParameterError("SnowContact: it needs one runner or more").tag("missing")
        if not (np.isfinite(spacing) and spacing > 0.0):
            raise ParameterError("SnowContact: spacing is {spacing!r} m; it must be above 0").tag(
                "out_of_range", spacing=spacing
            )
        if instruction_set is not None and instruction_set not in core.instruction_sets():
            known = ", ".join(core.instruction_sets())
            raise ParameterError("SnowContact: instruction_set is {instruction_set!r}; this machine has {known}").tag(
                "unknown_name", instruction_set=instruction_set, known=known
            )
        self.snow, self.runners = snow, tuple(runners)
        self.compiled = core.Contact(snow.compiled, [each.compiled() for each in runners], spacing, instruction_set)
        friction, shear = snow.friction_in_python, snow.shear_in_python
        self._shear = None if shear is None else StrengthCallback(shear)
        if friction is not None or shear is not None:
            called = None if friction is None else FrictionCallback(friction)
            self.compiled.set_laws(called, self._shear)
        if snow.penetration is not None:
            law = snow.penetration
            self.compiled.set_penetration(PressureCallback(law), np.array(law.bends, float), law.along_base_normal)

    def _repr_facts(self) -> Facts:
        """Title with the number of runners, the instruction set and the snow."""
        return Facts(
            f"of {len(self.runners)} runners, {self.compiled.instruction_set}: {self.snow._repr_facts().title}"
        )

    @property
    def instruction_set(self) -> str:
        """Instruction set of the core's loops on this machine; all give the same bits."""
        return self.compiled.instruction_set

    def force(
        self,
        position: npt.ArrayLike,
        rotation: npt.ArrayLike,
        velocity: npt.ArrayLike,
        dt: float,
        *,
        beam_dofs: Beams = None,
        beam_rates: Beams = None,
    ) -> ContactForces:
        """Forces at a pose that may or may not be accepted later; nothing of it is stored."""
        found, loads = self.compiled.force(
            *self._checked_motion(position, rotation, velocity, dt, beam_dofs, beam_rates)
        )
        self.require_finite_laws()
        return ContactForces(found, tuple(loads))

    def update(self, position: npt.ArrayLike, rotation: npt.ArrayLike, dt: float, *, beam_dofs: Beams = None) -> None:
        """Accept the step to a pose: the snow's history (its internal variables) is updated along the path to it."""
        where, axes, _, step, beams, _ = self._checked_motion(position, rotation, None, dt, beam_dofs, None)
        self.compiled.update(where, axes, step, beams)

    def tangent(
        self,
        position: npt.ArrayLike,
        rotation: npt.ArrayLike,
        velocity: npt.ArrayLike,
        dt: float,
        *,
        beam_dofs: Beams = None,
        beam_rates: Beams = None,
    ) -> tuple[FloatArray, FloatArray]:
        """Stiffness and damping, (k, 6, 6): minus the derivatives of each wrench by its own runner's pose and motion.

        Columns: place (m) and rotation (rad) about the slope's axes at the boot; velocity and angular velocity. Full,
        unsymmetric; by central differences of 10⁻⁷ m and rad and 10⁻⁴ m/s and rad/s. Where a branch of a law changes
        within that, the mean of both sides.
        """
        found = self.compiled.tangent(*self._checked_motion(position, rotation, velocity, dt, beam_dofs, beam_rates))
        self.require_finite_laws()
        return found

    def require_finite_laws(self) -> None:
        """ParameterError if a shear law in Python gave no finite strength at the pose evaluated last."""
        if self._shear is not None and self._shear.refused:
            raise ParameterError(self._shear.refused).tag("invalid_law")

    def sections(self, runner: int = 0) -> Sections:
        """Sections along a runner at the last ``force`` or ``update``."""
        return Sections(**self.compiled.sections(runner))

    def tracks(self) -> FloatArray:
        """The grooves left in the snow, (n, 6): track, line, x, y, z on the surface (m), maximum depth ever (m).

        Rows of a line follow each other across; between them the ground is straight. Those of all contacts in this
        snow, and those under these runners.
        """
        return self.compiled.tracks(self.snow.compiled)

    @property
    def unseen_track_width(self) -> float:
        """Greatest width (m) along a runner of older tracks between two lines of snow, which no line notices."""
        return self.compiled.unseen_track()[0]

    @property
    def groove_energy(self) -> float:
        """Energy (J) lost in all grooves of this snow: ½ H_V ε² (1 - H_V/k_u) over their area."""
        return self.compiled.groove_energy()

    @property
    def elastic_energy(self) -> float:
        """Energy (J) that the snow would give back, at the last pose evaluated."""
        return self.compiled.elastic_energy()

    @property
    def delayed_energy(self) -> float:
        """Energy (J) that the delayed depth of the snow has taken and not returned, lost or stored."""
        return self.compiled.delayed_energy()

    def state(self) -> ContactState:
        """History of this contact for `restore`, which also removes all tracks that others have left since."""
        return ContactState.of(self.compiled)

    def restore(self, state: ContactState) -> None:
        """Return to a state: the following steps have the same bits as after that state.

        A state from bytes brings its tracks with it: all others in the snow are forgotten.

        Raises
        ------
        ParameterError
            Tracks of the state were forgotten when an earlier one was restored; or its bytes are those of other
            runners, another snow or other laws. Nothing has changed then.
        """
        try:
            state.restore_in(self.compiled)
        except ValueError as error:
            raise ParameterError("SnowContact: {error}").tag("invalid", error=error) from error

    def _checked_motion(
        self,
        position: npt.ArrayLike,
        rotation: npt.ArrayLike,
        velocity: npt.ArrayLike | None,
        dt: float,
        beams: Beams,
        rates: Beams,
    ) -> tuple[FloatArray, FloatArray, FloatArray, float, list[FloatArray] | None, list[FloatArray] | None]:
        """Position, rotation, velocity, dt, and unknowns and rates of beams, after checks of shapes and values."""
        k = len(self.runners)
        where, axes = (
            shaped("SnowContact: position", position, (k, 3)),
            shaped("SnowContact: rotation", rotation, (k, 3, 3)),
        )
        off = np.abs(np.swapaxes(axes, 1, 2) @ axes - np.eye(3)).max()
        if off > ORTHONORMAL or np.any(np.linalg.det(axes) < 0.0):
            raise ParameterError(
                "SnowContact: rotation is not a rotation: its columns are off by {off:.1e} from orthonormal"
            ).tag("not_a_rotation", off=off)
        if not (np.isfinite(dt) and dt >= 0.0):
            raise ParameterError("SnowContact: dt is {dt!r} s; it must be 0 or more").tag("out_of_range", dt=dt)
        moves = np.zeros((k, 6)) if velocity is None else shaped("SnowContact: velocity", velocity, (k, 6))
        return where, axes, moves, dt, self._checked_beams("beam_dofs", beams), self._checked_beams("beam_rates", rates)

    def _checked_beams(self, name: str, beams: Beams) -> list[FloatArray] | None:
        """Arrays of the beams' nodes, one for each runner, shape (nodes, 3); None for None."""
        if beams is None:
            return None
        if len(beams) != len(self.runners):
            raise ParameterError("SnowContact: {name} has {n_beams} entries for {n_runners} runners").tag(
                "wrong_shape", name=name, n_beams=len(beams), n_runners=len(self.runners)
            )
        counts = [2 if each.nodes is None else len(each.nodes) for each in self.runners]
        return [shaped(f"SnowContact: {name}", beam, (count, 3)) for beam, count in zip(beams, counts, strict=True)]
