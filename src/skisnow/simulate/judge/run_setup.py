"""A scenario made ready for the compiled loops: numbers of the solver chosen, sledge set down, snow laid out."""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ...ski.beam.clamped import clamped
from ..compilation import require_compiled
from ..motion.advance import Memory, new_memory, observe
from ..motion.along import shares
from ..motion.archive import Archive, grown, new_archive
from ..motion.lines import CELL, CELLS, KEPT, SLOPE, TOUCHED, WINDOW, Lines, cells_of, new_lines
from ..motion.model import Model, Snow, World, sledge_model
from ..motion.outputs import is_roomy
from ..motion.path import AHEAD, follow
from ..motion.settle import settle
from ..scenario import Plane, Scenario

FloatArray: TypeAlias = npt.NDArray[np.float64]

HOLDING: Final = 0.5e-3
"""Displacement across (m) at which an edge's grip is used up (Choice: well below the depth of an edge that carves)."""
FRICTION_SPEED: Final = 0.01
"""Speed (m/s) below which glide friction fades to zero (Choice)."""
ONE_SIDED: Final = math.sin(math.radians(2.0))
"""Sine of the edge angle above which the shear acts at the edge alone; below, it moves to the ski's middle (Choice)."""
ELEMENTS: Final = 40
"""Finite elements over a ski at least: 4.5 cm each (Choice, see the convergence of the docs)."""
LINE_SPACING: Final = 0.02
"""Largest spacing (m) of the snow's lines (Choice)."""
CELLS_ACROSS: Final = 8
"""Cells over the width of the contact (Choice)."""
SMALLEST_CELL, LARGEST_CELL = 10e-6, 8e-3
"""Sizes (m) of cells."""
FLOATING_DEPTH: Final = 0.1
"""Depth (m) by which a flat base must carry the sledge, or it has sunk from the start (Choice)."""
SOFT_START: Final = 0.2e9
"""Hardness (N/m³) above which the start is found on softer snow first, which then hardens: Newton's method does not
always reach that of hard snow from afar."""
MOST_STAGES: Final = 40
"""Tries on the way from softer to hard snow: one is the rule."""
AT_REST: Final = 1e-6
"""Last step (m) of Newton's method that counts as equilibrium."""
PROFILE_STEP: Final = 0.02
"""Spacing (m) of a profile's table."""


@dataclass(slots=True)
class Setup:
    """A run under way."""

    scenario: Scenario
    model: Model
    snow: Snow
    world: World
    lines: Lines
    archive: Archive
    memory: Memory
    numbers: dict[str, float]
    unrest: float
    end: float
    shares: FloatArray

    @property
    def time(self) -> float:
        """Simulated so far (s)."""
        return float(self.memory.clock.time[0])

    @property
    def speed(self) -> float:
        """Of the boots' middle (m/s)."""
        return float(np.linalg.norm(self.memory.state.velocity[:3]))

    @property
    def touches(self) -> bool:
        """Whether any ski is in contact with the snow."""
        return bool(self.lines.flag[:, TOUCHED].any())

    @property
    def leaning(self) -> float:
        """Angle between the sledge's axis upwards and the snow's normal (rad)."""
        return math.acos(min(1.0, max(-1.0, float(self.memory.state.turn[:, 2] @ self._slope_at_boots()[1]))))

    @property
    def height(self) -> float:
        """Of the boots' middle above the slope (m)."""
        return float(self.memory.state.place[2] - self._slope_at_boots()[0])

    @property
    def sinks(self) -> bool:
        """Whether the snow does not even bear the sledge with its bases flat and ten centimetres deep."""
        ski = self.scenario.ski
        length = float(ski.station[0] - ski.station[-1])
        area = length * float(np.mean(ski.at(np.linspace(float(ski.station[-1]), float(ski.station[0]), 101)).width))
        return self.numbers["load_N"] > self.snow.hardness * area * FLOATING_DEPTH

    @property
    def past_end(self) -> bool:
        """Whether a tip is past the end of the slope."""
        state = self.memory.state
        return bool(state.place[0] + max(0.0, state.turn[0, 0]) * self.model.tip > self.end)

    def slope_normal(self, x: float) -> FloatArray:
        """Unit normal (3,) of the slope at x."""
        return _normal(self.scenario, x)

    def surface_height(self, x: float) -> float:
        """Height of the slope at x (m)."""
        slope = self.scenario.slope
        return 0.0 if isinstance(slope, Plane) else float(slope.heights(x))

    def _slope_at_boots(self) -> tuple[float, FloatArray]:
        x = float(self.memory.state.place[0])
        return self.surface_height(x), self.slope_normal(x)

    def keep_room(self) -> None:
        """Let the archive grow before it is full."""
        rows = len(self.lines.cells)
        if not is_roomy(self.archive, rows):
            pieces, places = len(self.archive.cell), len(self.archive.pool)
            self.archive = grown(self.archive, 2 * pieces + 4 * rows, 2 * places + 2 * rows * CELLS)

    def left_behind(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Pieces of lines with a groove: frames (k, 12), middle across, width and greatest depth (m)."""
        pieces = [*_archived(self.archive), *_under_skis(self.lines)]
        if not pieces:
            return np.zeros((0, 12)), np.zeros(0), np.zeros(0), np.zeros(0)
        frame = np.array([piece[0] for piece in pieces])
        low, high, depth = (np.array([piece[i] for piece in pieces]) for i in (1, 2, 3))
        return frame, 0.5 * (low + high), high - low, depth


_Piece: TypeAlias = tuple[FloatArray, float, float, float]


def _archived(archive: Archive) -> list[_Piece]:
    pieces, places = (int(n) for n in archive.used[:2])
    if not pieces:
        return []
    first, count, place = archive.start[:pieces].T
    cell, slope = np.repeat(archive.cell[:pieces], count), np.repeat(np.abs(archive.slope[:pieces]), count)
    pool = archive.pool[:places].astype(np.float64)
    middle = (np.repeat(first - place, count) + np.arange(places) + 0.5) * cell
    low = np.minimum.reduceat(middle + pool[:, 1], place)
    high = np.maximum.reduceat(middle + pool[:, 2], place)
    depth = np.maximum.reduceat(pool[:, 0] + slope * np.maximum(-pool[:, 1], pool[:, 2]), place)
    ends = zip(low.tolist(), high.tolist(), depth.tolist(), strict=True)
    return [(archive.frame[m], *each) for m, each in enumerate(ends)]


def _under_skis(lines: Lines) -> list[_Piece]:
    found = []
    ring = len(lines.cells) // 2
    for k in range(2):
        for c in range(int(lines.count[k])):
            row = k * ring + (int(lines.first[k]) + c) % ring
            deepest, covered_from, covered_to, _ = cells_of(lines, row)
            covered = covered_to > covered_from
            if lines.flag[row, KEPT] == 0 or not covered.any():
                continue
            number = lines.flag[row, WINDOW] + np.arange(CELLS)
            middle = (number[covered] + 0.5) * lines.value[row, CELL]
            reach = np.maximum(covered_to[covered] - middle, middle - covered_from[covered])
            depth = deepest[covered] + abs(lines.value[row, SLOPE]) * reach
            found.append((lines.frame[row], covered_from[covered].min(), covered_to[covered].max(), float(depth.max())))
    return found


def set_up(scenario: Scenario) -> Setup:
    """Choose the solver's numbers, lay the snow out and set the sledge down on it."""
    require_compiled(scenario)
    setup = laid_out(scenario)
    model, snow, world, memory = setup.model, setup.snow, setup.world, setup.memory
    follow(model, snow, world, setup.lines, setup.archive, memory.state)
    setup.unrest = _settled(model, snow, world, setup.lines, memory)
    memory.state.velocity[0] = scenario.start.speed
    observe(model, snow, world, setup.lines, setup.archive, memory, True)
    memory.clock.work[:] = 0.0
    return setup


def laid_out(scenario: Scenario) -> Setup:
    """The sledge above the snow, before anything moves or is compiled."""
    load, depth, wavelength = _contact(scenario)
    solver = scenario.solver
    length = float(scenario.ski.station[0] - scenario.ski.station[-1])
    elements = solver.elements or max(ELEMENTS, math.ceil(5.0 * length / wavelength))
    spacing = solver.line_spacing or min(LINE_SPACING, wavelength / 10.0)  # two to an element
    tangent = math.tan(max(abs(scenario.sledge.edge_angle), 1e-3))
    across = min(depth / tangent, float(scenario.ski.width.max()))
    cell = solver.cell or min(max(across / CELLS_ACROSS, SMALLEST_CELL), LARGEST_CELL)
    ski = clamped(scenario.ski, scenario.clamp_length, elements)
    model = sledge_model(scenario.sledge, ski, damping_ratio=scenario.damping_ratio)
    ring = math.ceil((model.tip - model.tail + 2.0 * AHEAD) / spacing) + 12
    lines = new_lines(ring, spacing=spacing, cell=cell)
    memory = new_memory(ski.size, ring)
    memory.clock.time[1] = solver.step
    archive = new_archive(8 * ring, 4 * ring * CELLS)
    snow, world = _snow(scenario), _world(scenario)
    _place(scenario, memory, depth)
    numbers = {"elements": float(elements), "line_spacing_m": spacing, "cell_mm": cell * 1e3, "load_N": load}
    slope = scenario.slope
    end = math.inf if isinstance(slope, Plane) else slope.ends[1]
    return Setup(scenario, model, snow, world, lines, archive, memory, numbers, math.inf, end, shares(model.node))


def _settled(model: Model, snow: Snow, world: World, lines: Lines, memory: Memory) -> float:
    """Set the sledge down, on hard snow by way of softer ones, and return Newton's last step (m) or inf."""
    state, softening = memory.state, max(1.0, snow.hardness / SOFT_START)

    def last_step(hardened: float) -> float:
        factor = softening ** (hardened - 1.0)
        softer = snow._replace(hardness=factor * snow.hardness, excess=factor * snow.excess)
        return float(settle(model, softer, world, lines, state, memory.start, memory.system, memory.room, memory.next))

    reached = 1.0 if softening == 1.0 else 0.0
    unrest, stride = last_step(reached), 1.0
    if not unrest <= AT_REST:
        return math.inf
    for _ in range(MOST_STAGES):
        if reached == 1.0:
            return unrest
        kept, target = copy.deepcopy(state), min(reached + stride, 1.0)
        unrest = last_step(target)
        if unrest <= AT_REST:
            reached, stride = target, 2.0 * stride
        else:
            stride /= 3.0
            for mine, before in zip(state, kept, strict=True):
                mine[:] = before
    return math.inf


def _contact(scenario: Scenario) -> tuple[float, float, float]:
    """Load on a ski along the snow normal (N), depth of its edge (m) as if rigid, and 1/λ of its contact (m)."""
    ski, sledge = scenario.ski, scenario.sledge
    station = np.asarray(ski.station)
    at = ski.at(np.linspace(float(station[-1]), float(station[0]), 101))
    length = float(station[0] - station[-1])
    mass = sledge.mass / 2.0 + float(np.mean(at.mass_per_length)) * length
    load = mass * scenario.gravity * abs(_normal(scenario, scenario.start.x)[2])
    hardness = scenario.contact.snow.snow_hardness
    tangent = math.tan(abs(sledge.edge_angle))
    width = float(np.mean(at.width))
    flat = load / (hardness * 0.8 * length * width)
    depth = max(flat, math.sqrt(2.0 * load * tangent / (hardness * 0.8 * length)))
    stiffness = hardness * min(depth / max(tangent, 1e-9), width)
    wavelength = (4.0 * float(np.mean(at.bending_stiffness)) / stiffness) ** 0.25
    return load, depth, wavelength


def _snow(scenario: Scenario) -> Snow:
    contact = scenario.contact
    hardness, stress = contact.snow.snow_hardness, contact.snow.failure_shear_stress
    return Snow(
        hardness=hardness,
        excess=hardness * (contact.unloading_ratio - 1.0),
        shear_stress=stress or 0.0,
        holding=HOLDING,
        compaction=float(contact.compaction_resistance),
        friction=contact.friction,
        friction_by_speed=contact.friction_by_speed,
        friction_speed=FRICTION_SPEED,
        one_sided=ONE_SIDED,
    )


def _world(scenario: Scenario) -> World:
    slope, g = scenario.slope, scenario.gravity
    air = scenario.air
    drag = 0.5 * air.density * air.drag_area
    if isinstance(slope, Plane):
        gravity = np.array([g * math.sin(slope.angle), 0.0, -g * math.cos(slope.angle)])
        return World(gravity, drag, air.centre_of_pressure_height, 0.0, 1.0, np.zeros((1, 2)))
    start, end = slope.ends
    x = np.linspace(start, end, math.ceil((end - start) / PROFILE_STEP) + 1)
    heights = np.column_stack([slope.heights(x), slope.gradients(x)])
    return World(np.array([0.0, 0.0, -g]), drag, air.centre_of_pressure_height, start, float(x[1] - x[0]), heights)


def _normal(scenario: Scenario, x: float) -> FloatArray:
    if isinstance(scenario.slope, Plane):
        return np.array([0.0, 0.0, 1.0])
    gradient = float(scenario.slope.gradients(x))
    return np.array([-gradient, 0.0, 1.0]) / math.hypot(1.0, gradient)


def _place(scenario: Scenario, memory: Memory, depth: float) -> None:
    """Put the sledge on the slope at its start, as deep as rigid skis would be."""
    start, state = scenario.start, memory.state
    normal = _normal(scenario, start.x)
    down = np.array([normal[2], 0.0, -normal[0]])
    ahead = math.cos(start.heading) * down + math.sin(start.heading) * np.array([0.0, 1.0, 0.0])
    state.turn[:] = np.column_stack([ahead, np.cross(normal, ahead), normal])
    height = 0.0 if isinstance(scenario.slope, Plane) else float(scenario.slope.heights(start.x))
    half = float(scenario.ski.at(0.0).width) / 2.0
    above = half * math.sin(abs(scenario.sledge.edge_angle)) - depth
    state.place[:] = np.array([start.x, start.y, height]) + above * normal
