from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
_Beams = Sequence[FloatArray] | None

SOURCE_HASH: str

def instruction_sets() -> list[str]: ...
def grid(x0: float, dx: float, y0: float, dy: float, values: FloatArray, goes_on: bool) -> Grid: ...
def runner(
    position: FloatArray,
    half_width: FloatArray,
    base_height: FloatArray,
    node: FloatArray,
    base_bevel: float,
    edge_width: float,
    side_edge: float,
    edge_radius: float,
) -> Runner: ...

class Grid:
    def __init__(self, constant: float) -> None: ...
    def at(self, x: float, y: float) -> tuple[float, float, float]: ...

class Runner: ...
class State: ...

def check_bytes(given: bytes) -> None: ...

class FrictionLaw:
    constant: float
    linear: float
    square: float
    film: float
    film_speed: float
    stick: float
    is_vector: bool
    acts_across: bool

class ShearLaw:
    decrease: float
    cuts: bool
    friction_angle: float
    least_plane: float
    residual_ratio: float
    weakening: float
    loaded_only: bool

class RateLaw:
    damping: float
    delayed_share: float
    retardation: float
    spacing: float

class Snow:
    surface: Grid
    hardness: Grid
    strength: Grid
    friction_share: Grid
    strength_share: float
    unloading_ratio: float
    shear_displacement: float
    compaction_resistance: bool
    friction: FrictionLaw
    friction_on_base: bool
    shear: ShearLaw
    rate: RateLaw
    knot_area: float
    part_along: float
    part_across: float

class PenetrationLaw(Protocol):
    def residual(self, deepest: FloatArray, /) -> FloatArray: ...
    def bear(self, depth: FloatArray, deepest: FloatArray, edge_angle: FloatArray, /) -> FloatArray: ...
    def lost(self, deepest: FloatArray, /) -> FloatArray: ...

class Contact:
    instruction_set: str
    def __init__(
        self, snow: Snow, runners: Sequence[Runner], spacing: float, instruction_set: str | None = ...
    ) -> None: ...
    def force(
        self, position: FloatArray, rotation: FloatArray, velocity: FloatArray, dt: float, beams: _Beams, rates: _Beams
    ) -> tuple[FloatArray, list[FloatArray]]: ...
    def update(self, position: FloatArray, rotation: FloatArray, dt: float, beams: _Beams) -> None: ...
    def tangent(
        self, position: FloatArray, rotation: FloatArray, velocity: FloatArray, dt: float, beams: _Beams, rates: _Beams
    ) -> tuple[FloatArray, FloatArray]: ...
    def sections(self, runner: int) -> dict[str, FloatArray]: ...
    def tracks(self, snow: Snow) -> FloatArray: ...
    def groove_energy(self) -> float: ...
    def unseen_track(self) -> tuple[float, float]: ...
    def elastic_energy(self) -> float: ...
    def delayed_energy(self) -> float: ...
    def state(self) -> State: ...
    def restore(self, state: State) -> None: ...
    def bytes_of(self, state: State) -> bytes: ...
    def take_bytes(self, given: bytes) -> None: ...
    def set_laws(
        self,
        friction: Callable[[FloatArray], FloatArray] | None,
        shear: Callable[[FloatArray, FloatArray], FloatArray] | None,
    ) -> None: ...
    def set_penetration(self, law: PenetrationLaw, bends: FloatArray, along_base_normal: bool) -> None: ...

def runner_tangent(
    contact: Contact,
    position: FloatArray,
    rotation: FloatArray,
    velocity: FloatArray,
    dt: float,
    stiffness: float,
    damping: float,
) -> tuple[FloatArray, FloatArray]: ...
def pressed_ground(knots: FloatArray, polyline: FloatArray) -> tuple[FloatArray, bool]: ...

class FlexibleSki: ...
class Body: ...

def flexible_ski(
    boot: FloatArray,
    axes: FloatArray,
    unknown: FloatArray,
    mass: FloatArray,
    stiffness: FloatArray,
    coupling: FloatArray,
    damping: float,
) -> FlexibleSki: ...
def body(
    inertia: FloatArray,
    mass: float,
    first_moment: FloatArray,
    skis: Sequence[FlexibleSki],
    gravity: FloatArray,
    drag: float,
    drag_height: float,
) -> Body: ...

class StepRule:
    first: float
    fixed: bool
    tolerance: float
    shortest: float
    longest: float
    closeness: float

class Dynamics:
    time: float
    position: FloatArray
    rotation: FloatArray
    velocity: FloatArray
    moment: FloatArray
    next_step: float
    touches: bool
    counts: tuple[int, int, int, int, int]
    def __init__(self, body: Body, contact: Contact, rule: StepRule) -> None: ...
    def set_pose(self, position: FloatArray, rotation: FloatArray) -> None: ...
    def set_velocity(self, rate: FloatArray) -> None: ...
    boots: FloatArray
    def set_skis(self, inertia: FloatArray) -> None: ...
    def move_boots(self, motions: FloatArray) -> None: ...
    def hold_body(self) -> None: ...
    def set_push(self, force: FloatArray, at: FloatArray) -> None: ...
    def settle(self) -> float: ...
    def begin(self) -> None: ...
    def advance(self, until: float, most: int) -> int: ...
    def copy(self) -> Dynamics: ...
    def assign(self, other: Dynamics) -> None: ...

class CarvedSki: ...

class CarveConditions:
    def __init__(
        self,
        edge_angle: float,
        hardness: float,
        excess: float,
        load: float,
        moment: float,
        side_force: float,
        side_force_bending: bool,
        twists: bool,
        bevel: float,
        bevel_width: float,
        side: float,
        radius: float,
        pitch_of_force: float,
        pitch_of_shear: float,
        by_reaction: bool,
        /,
    ) -> None: ...

class CarveLaws:
    def __init__(
        self,
        pressure: Callable[[FloatArray, FloatArray, FloatArray], FloatArray] | None,
        residual: Callable[[FloatArray], FloatArray] | None,
        bends: FloatArray,
        strength: Callable[[FloatArray, FloatArray], FloatArray] | None,
    ) -> None: ...

def carved_ski(
    stations: FloatArray,
    front: int,
    stiffness: FloatArray,
    waist: float,
    running_length: float,
    bent_by_width: FloatArray,
    bent_by_height: FloatArray,
    /,
) -> CarvedSki: ...
def carve_solution(
    ski: CarvedSki,
    conditions: CarveConditions,
    places: FloatArray,
    u: FloatArray,
    border: FloatArray,
    right: FloatArray,
    right_border: FloatArray,
) -> tuple[FloatArray, FloatArray]: ...
def find_carve(
    ski: CarvedSki,
    conditions: CarveConditions,
    offset: FloatArray | None,
    near: tuple[FloatArray, FloatArray] | None,
    laws: CarveLaws | None,
) -> tuple[bool, int, FloatArray, tuple[float, float, float], FloatArray, FloatArray]: ...

class CarvePoint:
    def __init__(
        self,
        ski: CarvedSki,
        conditions: CarveConditions,
        u: FloatArray,
        border: FloatArray,
        places: FloatArray | None,
    ) -> None: ...
    def state(self) -> tuple[float, FloatArray, tuple[float, float, float], FloatArray, FloatArray]: ...
    def gradient(
        self, u: FloatArray, depth: FloatArray, force: FloatArray, /
    ) -> tuple[FloatArray, FloatArray, FloatArray]: ...
    def growth(
        self, columns: FloatArray, numbers: FloatArray, bent: FloatArray, /
    ) -> tuple[FloatArray, tuple[float, float, float], FloatArray, FloatArray, float]: ...

def banded_factors(matrix: FloatArray, /) -> FloatArray: ...
def banded_solution(factors: FloatArray, right: FloatArray, from_row: int, /) -> FloatArray: ...
def strip_sums(intervals: FloatArray, /) -> FloatArray: ...
def contact_data(snow: Snow, contact: Contact, start: FloatArray) -> str: ...
def sledge_data(
    snow: Snow,
    contact: Contact,
    dynamics: Dynamics,
    inertia: FloatArray,
    at_rest: float,
    start: FloatArray,
    moving: int,
) -> str: ...
