"""A scenario: everything that a simulated turn follows from, SI, radians."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from ...errors import ParameterError
from ...ski import Ski
from ...snow import SnowProperties
from ..sledge import RigidSledge
from .checks import require_sound
from .slope import Plane, Profile

Penetration: TypeAlias = Literal["hypoplastic", "elastic"]
Method: TypeAlias = Literal["ros2", "fast"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact:
    """How snow and skis meet.

    Attributes
    ----------
    snow
        With H_V and S_f.
    unloading_ratio
        k_u/H_V ≥ 1; 1: elastic.
    compaction_resistance
        Whether the base's slope along the ski counts as resistance.
    friction, friction_by_speed
        μ = μ_0 + μ_1 v: μ_0 ≥ 0, and μ_1 (s/m).
    """

    snow: SnowProperties
    unloading_ratio: float
    compaction_resistance: bool = True
    friction: float
    friction_by_speed: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Air:
    """Air drag: drag area C_dA (m²), density (kg/m³), height of the centre of pressure above the bases (m)."""

    drag_area: float
    density: float
    centre_of_pressure_height: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Start:
    """Place of the boots' middle (m), speed along the skis (m/s), heading from the fall line, positive left (rad)."""

    x: float = 0.0
    y: float = 0.0
    speed: float
    heading: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Stop:
    """When a run is done: after a time (s) or a run length (m), one of them or both, whichever comes first."""

    duration: float | None = None
    length: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Solver:
    """How it is computed.

    Attributes
    ----------
    method
        "ros2" or "fast" (linearly implicit BDF2).
    step
        The first step (s), or with `fixed` every step.
    tolerance
        Largest error of place that a step may make by its own estimate (m).
    fixed
        Whether the step stays.
    elements, line_spacing, cell
        Finite elements over a ski, spacing of the snow's lines along the path (m), cells across (m); None: from ski and
        snow.
    output_interval
        Between what is kept (s).
    """

    method: Method = "ros2"
    step: float = 0.5e-3
    tolerance: float = 3e-7
    fixed: bool = False
    elements: int | None = None
    line_spacing: float | None = None
    cell: float | None = None
    output_interval: float = 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """What a run follows from.

    Attributes
    ----------
    slope
        A plane or a measured profile.
    contact, air
        Snow with friction; drag.
    sledge
        The rigid part with its edge angle, without the skis.
    ski, clamp_length, damping_ratio
        The ski of both sides, the length that its binding keeps straight (m), damping of its first bending mode.
    start, stop, solver
        Where it begins, when it ends, how it is computed.
    gravity
        (m/s²), > 0.
    """

    slope: Plane | Profile
    contact: Contact
    air: Air
    sledge: RigidSledge
    ski: Ski
    clamp_length: float = 0.3
    damping_ratio: float = 0.02
    start: Start
    stop: Stop
    solver: Solver = field(default_factory=Solver)
    gravity: float = 9.81

    def __post_init__(self) -> None:
        if self.contact.snow.failure_shear_stress is None:
            raise ParameterError(
                f"the snow ({self.contact.snow.source}) has no failure shear stress S_f; a turn needs it: give one"
            )
        if self.stop.duration is None and self.stop.length is None:
            raise ParameterError("the run has no end: give a duration or a length")
        require_sound(self)
