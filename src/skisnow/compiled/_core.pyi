from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
_Beams = Sequence[FloatArray] | None

SOURCE_HASH: str

def instruction_sets() -> list[str]: ...
def grid(x0: float, dx: float, y0: float, dy: float, values: FloatArray, goes_on: bool) -> Grid: ...
def runner(tail: float, tip: float, table: FloatArray, node: FloatArray) -> Runner: ...

class Grid:
    def __init__(self, constant: float) -> None: ...
    def at(self, x: float, y: float) -> tuple[float, float, float]: ...

class Runner: ...
class State: ...

class FrictionLaw:
    constant: float
    linear: float
    square: float
    film: float
    film_speed: float
    fade_speed: float

class Snow:
    surface: Grid
    hardness: Grid
    strength: Grid
    unloading_ratio: float
    shear_displacement: float
    edge_blend_sine: float
    compaction_resistance: bool
    friction: FrictionLaw
    knot_area: float
    look_back: float

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
    def elastic_energy(self) -> float: ...
    def state(self) -> State: ...
    def restore(self, state: State) -> None: ...
    def set_laws(
        self,
        friction: Callable[[FloatArray], FloatArray] | None,
        shear: Callable[[FloatArray, FloatArray], FloatArray] | None,
        fade_speed: float,
    ) -> None: ...
