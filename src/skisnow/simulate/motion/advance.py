"""From one moment of output to the next: fixed steps, or steps whose error is held by halving them."""

from __future__ import annotations

from typing import Final, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .archive import Archive, set_course
from .compiled import PLAIN
from .equations import channel_rows, copy_state, drag_power
from .fast import REACH, Past, fast_step, new_past
from .forces import FRICTION, NORMAL, RELEASED, SHEAR, SIDEWAYS, Forces, feel, new_forces
from .lines import Lines
from .model import PADDING, Model, Snow, State, World, new_state
from .path import follow, lay_anew, press
from .ros2 import GAMMA, Room, new_room, ros2_step
from .system import Factored, factor, new_factored, quadratic

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]

# what `advance` ends with; paused: called again it goes on, with the same bits as if it had not stopped
GOES_ON, STEP_TOO_SMALL, NOT_FINITE, PAUSED = 0, 1, 2, 3
# entries of `work`: energy (J) that shear, friction, drag and damping took, was given sideways, released, done by the
# normal force
OF_SHEAR, OF_FRICTION, OF_SIDEWAYS, OF_RELEASED, OF_NORMAL, OF_DRAG, OF_DAMPING = 0, 1, 2, 3, 4, 5, 6
WORKS: Final = 7

SHORTEST_STEP: Final = 1e-7
"""Step (s) below which a run ends."""
STEPS_PER_TANGENT: Final = 4
"""Fixed steps over which the matrix is kept: both methods are of order 2 whatever the matrix (Choice)."""
EASY: Final = 2.0
"""Stiffness of the contact per length of ski, times the step's square, up to which ROS2 keeps its matrix: about a ski's
mass per length (kg/m). With longer steps on harder snow an old matrix costs centimetres (Choice)."""
STEPS_AT_ONCE: Final = 1000
"""Steps after which it pauses, some tenths of a second: compiled code hears neither Ctrl-C nor a request to end."""
BEARS: Final = 1e-6
"""Force (N) from which on a line counts as bearing: less is rounding."""
STEPS_PER_CHECK: Final = 8
"""Steps after which it is seen whether the lines still lie evenly."""
FARTHEST: Final = 1.0
"""Way (m) and turn (rad) of the sledge in a step, and bend (m, rad) of a ski, beyond which a run has diverged: at
100 m/s the longest step makes half of it. The snow is not asked to remember such a state."""
LONGEST_STEP: Final = 4e-3
"""Step (s) of the error control, which is halved; a ski at 30 m/s moves 12 cm in it."""


class Clock(NamedTuple):
    """What goes on from call to call: time now, next step, last step taken (s); counts."""

    time: FloatArray  # (3,)
    counts: IntArray  # (4,) steps taken, rejected, since the matrix was renewed; 1: the tangent is known
    work: FloatArray  # (WORKS,) energies (J)
    power: FloatArray  # (WORKS,) at the last look (W)


class Memory(NamedTuple):
    """Everything that a run works with."""

    state: State
    next: State
    half: State
    trial: State
    start: Forces
    stage: Forces
    half_start: Forces
    system: Factored
    room: Room
    past: Past
    clock: Clock


def new_memory(size: int, ring: int) -> Memory:
    """Room for skis with that many unknowns and a ring of that many lines."""
    return Memory(
        new_state(size),
        new_state(size),
        new_state(size),
        new_state(size),
        new_forces(size, ring),
        new_forces(size, ring),
        new_forces(size, ring),
        new_factored(size),
        new_room(size),
        new_past(size),
        Clock(np.zeros(3), np.zeros(4, np.int64), np.zeros(WORKS), np.zeros(WORKS)),
    )


@compiled(**PLAIN, fastmath={"contract"})
def observe(
    model: Model, snow: Snow, world: World, lines: Lines, archive: Archive, memory: Memory, tangent: bool
) -> None:
    """Look at the snow at the state reached: forces, powers, and what the snow remembers of it."""
    state, start, clock = memory.state, memory.start, memory.clock
    set_course(archive, state)
    if clock.counts[0] % STEPS_PER_CHECK == 0:
        lay_anew(model, snow, lines, archive, state)
    follow(model, snow, world, lines, archive, state)
    # for a constant in place of a value Numba compiles a function anew, and more slowly
    feel(model, snow, lines, state, tangent, clock.time[0] >= 0.0, start)
    press(snow, lines, archive)
    damping = 0.0
    for k in range(2):
        damping += model.damping * quadratic(model.stiffness, state.bend_rate[k])
    now = (
        -start.power[SHEAR], -start.power[FRICTION], start.power[SIDEWAYS], start.power[RELEASED],
        -start.power[NORMAL], drag_power(world, state.velocity), damping,
    )  # fmt: skip
    clock.counts[3] = 1 if tangent else 0
    half = 0.5 * clock.time[2]
    for a in range(WORKS):
        clock.work[a] += half * (clock.power[a] + now[a])
        clock.power[a] = now[a]


@compiled(**PLAIN)
def _factor(
    model: Model, lines: Lines, memory: Memory, h: float, gamma: float
) -> bool:  # fmt: skip
    rows = memory.system.rows
    channel_rows(model, lines, memory.state, rows)
    gh = gamma * h
    return factor(model, memory.start, rows, gh * (gh + model.damping), gh * gh, memory.system)


@compiled(**PLAIN, inline="always")
def advance_fixed(
    model: Model, snow: Snow, world: World, lines: Lines, archive: Archive, memory: Memory, fast: bool, step: float,
    until: float,
) -> int:  # fmt: skip
    """Take equal steps of about `step` (s) until `until` (s); the forces are known at the start, and at the end."""
    clock, past = memory.clock, memory.past
    left = until - clock.time[0]
    if left <= 0.0:
        return GOES_ON
    steps = max(1, int(np.ceil(left / step - 1e-9)))
    h = left / steps
    steps, whole = min(steps, STEPS_AT_ONCE), steps
    if clock.counts[0] > 0 and abs(h - clock.time[1]) < 1e-9 * h:
        h = clock.time[1]  # but for rounding the same: the matrix may be kept
    else:
        clock.counts[2] = 0
        if clock.counts[3] == 0:
            feel(model, snow, lines, memory.state, h > 0.0, h < 0.0, memory.start)
    clock.time[1] = h
    for i in range(steps):
        first = fast and past.step[0] != h
        if first or clock.counts[2] % STEPS_PER_TANGENT == 0:
            if not _factor(model, lines, memory, h, 1.0 if first else REACH if fast else GAMMA):
                return NOT_FINITE
            # Euler's matrix serves one step alone, and so does one of a step that is long for so hard a contact
            once = first or not (fast or _is_easy(memory.start, lines, h))
            clock.counts[2] = -1 if once else 0
        if fast:
            fast_step(model, world, memory.state, memory.start, memory.system, h, past, memory.next)
        else:
            ros2_step(
                model, snow, world, lines, memory.state, memory.start, memory.stage, memory.system, h, memory.room,
                memory.next,
            )  # fmt: skip
        copy_state(memory.next, memory.state)
        clock.time[0] = until if i == whole - 1 else clock.time[0] + h
        clock.time[2] = h
        clock.counts[0] += 1
        clock.counts[2] += 1
        if not _is_sound(memory.state, h):
            return NOT_FINITE
        observe(model, snow, world, lines, archive, memory, clock.counts[2] % STEPS_PER_TANGENT == 0)
    return GOES_ON if steps == whole else PAUSED


@compiled(**PLAIN)
def _is_easy(start: Forces, lines: Lines, h: float) -> bool:
    """Whether the contact is soft enough for a step h (s) that its matrix may be kept."""
    stiffest = 0.0
    for k in range(2):
        met = 0
        for i in range(start.sections[k]):
            met += 1 if start.section[k, i, 1] > BEARS else 0
        stiffest = max(stiffest, start.corner[k, 0, 0] / (max(met, 1) * lines.spacing[0]))
    return stiffest * h * h <= EASY


@compiled(**PLAIN, inline="always")
def advance_controlled(
    model: Model, snow: Snow, world: World, lines: Lines, archive: Archive, memory: Memory, tolerance: float,
    until: float,
) -> int:  # fmt: skip
    """Take pairs of steps; their error of place, against one step of twice the length, stays below `tolerance` (m)."""
    clock, tries = memory.clock, 0
    while clock.time[0] < until:
        if tries == STEPS_AT_ONCE:
            return PAUSED
        tries += 1
        left = until - clock.time[0]
        h = min(clock.time[1], left)
        if h > 0.5 * left and h < left:
            h = 0.5 * left  # no crumbs at the end
        error = _try_pair(model, snow, world, lines, memory, h)
        larger = 0.8 * (tolerance / max(error, 1e-30)) ** (1.0 / 3.0) if not np.isnan(error) else 0.1
        if not error <= tolerance:
            clock.counts[1] += 1
            clock.time[1] = _on_ladder(h * min(max(larger, 0.1), 0.7))
            if clock.time[1] < SHORTEST_STEP:
                return STEP_TOO_SMALL
            continue
        now, end = clock.time[0], until if h == left else clock.time[0] + h
        if h < left or larger < 1.0:  # a step cut short by the output tells little
            clock.time[1] = _on_ladder(min(h * min(max(larger, 0.3), 1.5), LONGEST_STEP))
        elif clock.time[1] < h * larger:
            clock.time[1] = _on_ladder(min(max(clock.time[1], h * min(larger, 2.0)), LONGEST_STEP))
        # the snow meets both states; for a constant in place of a value Numba would compile a function anew
        copy_state(memory.half, memory.state)
        clock.time[0], clock.time[2] = now + 0.5 * h, 0.5 * h
        observe(model, snow, world, lines, archive, memory, h < 0.0)
        copy_state(memory.next, memory.state)
        clock.time[0] = end
        clock.counts[0] += 2
        observe(model, snow, world, lines, archive, memory, h > 0.0)
    return GOES_ON


@compiled(**PLAIN)
def _on_ladder(h: float) -> float:
    """The longest step of a ladder of steps, four to an octave, that is not above h (s).

    A free choice would carry each rounding of the error estimate into all later steps.
    """
    return LONGEST_STEP * 2.0 ** (0.25 * np.floor(4.0 * np.log2(h / LONGEST_STEP) + 1e-6))


@compiled(**PLAIN, inline="always")
def _try_pair(model: Model, snow: Snow, world: World, lines: Lines, memory: Memory, h: float) -> float:
    """Fill `next` with the state after two steps of h/2, and return how far one step of h is off (m)."""
    if not _factor(model, lines, memory, h, GAMMA):
        return np.nan
    ros2_step(
        model, snow, world, lines, memory.state, memory.start, memory.stage, memory.system, h, memory.room, memory.trial
    )  # fmt: skip
    if not _factor(model, lines, memory, 0.5 * h, GAMMA):
        return np.nan
    ros2_step(
        model, snow, world, lines, memory.state, memory.start, memory.stage, memory.system, 0.5 * h, memory.room,
        memory.half,
    )  # fmt: skip
    if not (_is_sound(memory.half, h) and _is_sound(memory.trial, h)):
        return np.nan
    feel(model, snow, lines, memory.half, h < 0.0, h < 0.0, memory.half_start)
    ros2_step(
        model, snow, world, lines, memory.half, memory.half_start, memory.stage, memory.system, 0.5 * h, memory.room,
        memory.next,
    )  # fmt: skip
    return _difference(memory.trial, memory.next, h) / 3.0


@compiled(**PLAIN)
def _difference(one: State, other: State, h: float) -> float:
    """Largest difference of place (m): of the boots, of ends a metre off that turn with them, of the skis' bend."""
    worst = 0.0
    for a in range(3):
        worst = max(worst, abs(one.place[a] - other.place[a]))
        worst = max(worst, h * abs(one.velocity[a] - other.velocity[a]))
        for b in range(3):
            worst = max(worst, abs(one.turn[a, b] - other.turn[a, b]))
    for k in range(2):
        for i in range(PADDING, one.bend.shape[1] - PADDING, 3):
            worst = max(worst, abs(one.bend[k, i] - other.bend[k, i]))
    if not _is_sound(one, h) or not _is_sound(other, h):
        return np.nan
    return worst


@compiled(**PLAIN)
def _is_sound(state: State, h: float) -> bool:
    """Whether a state after a step h (s) is finite and has not diverged."""
    total, farthest = 0.0, 0.0
    for a in range(6):
        farthest = max(farthest, abs(h * state.velocity[a]))
        total += state.velocity[a]
    for a in range(3):
        total += state.place[a] + state.turn[a, 0] + state.turn[a, 1] + state.turn[a, 2]
    for k in range(2):
        for i in range(state.bend.shape[1]):
            farthest = max(farthest, abs(state.bend[k, i]))
            total += state.bend[k, i]
    return bool(np.isfinite(total) and farthest <= FARTHEST)


@compiled(**PLAIN, fastmath={"contract"})
def mechanical_energy(model: Model, world: World, state: State) -> tuple[float, float, float]:
    """Kinetic, potential and the skis' elastic energy (J)."""
    V = state.velocity
    kinetic, elastic = 0.0, 0.0
    for a in range(6):
        for b in range(6):
            kinetic += 0.5 * V[a] * model.rigid[a, b] * V[b]
    for k in range(2):
        kinetic += 0.5 * quadratic(model.mass, state.bend_rate[k])
        elastic += 0.5 * quadratic(model.stiffness, state.bend[k])
        for i in range(len(model.mass)):
            for a in range(6):
                kinetic += state.bend_rate[k, i + PADDING] * model.coupling[k, i, a] * V[a]
    potential = 0.0
    c = model.first_moment
    for a in range(3):
        centre = state.turn[a, 0] * c[0] + state.turn[a, 1] * c[1] + state.turn[a, 2] * c[2]
        potential -= world.gravity[a] * (model.total_mass * state.place[a] + centre)
        for k in range(2):
            n = state.turn[a, 1] * model.normal[1] + state.turn[a, 2] * model.normal[2]
            for i in range(len(model.mass)):
                # the coupling's place part is the mass that each unknown lifts along the base's normal
                lifted = model.coupling[k, i, 1] * model.normal[1] + model.coupling[k, i, 2] * model.normal[2]
                potential -= world.gravity[a] * n * lifted * state.bend[k, i + PADDING]
    return kinetic, potential, elastic
