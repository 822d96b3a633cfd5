"""Laws of the snow that replace H_V, k_u and S_f in a steady carve, in the form that the compiled core calls."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from ..compiled import core
from ..contact.laws import PressureCallback, StrengthCallback
from ..forces.penetration import PointLaw
from ..forces.shear import ShearLaw
from ..ski.ski import Ski

STEEPEST_RATIO: Final = 1000.0
"""Unloading ratio of the linear snow from which the search for another law's equilibrium begins, at most."""
_LOADED_SHARE: Final = 0.9  # share of the running length, on a straight edge
_SOME_DEPTH: Final = 1e-3  # m, at which strengths are compared
_DEPTHS: Final = np.geomspace(1e-6, 1.0, 600)  # m, of a straight edge
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)


class PressureLaw(PressureCallback):
    """Stress of a law; values that are not finite are recorded in ``refused``: a trial step may be too deep."""

    def __init__(self, law: PointLaw) -> None:
        super().__init__(law)
        self.refused: Message | None = None

    def stress(self, depth: FloatArray, deepest: FloatArray, edge_angle: FloatArray, /) -> FloatArray:
        """Stress (N/m²) of places at depths, maximum depths so far (m) and edge angles (rad)."""
        return self.bear(depth, deepest, edge_angle)[0]

    def refuse(self, reason: Message) -> None:
        """Store why the law could not be evaluated."""
        self.refused = reason


class StrengthLaw:
    """Shear law relative to its stress at one depth and the boot's edge angle; `refused` as in `PressureLaw`."""

    def __init__(self, law: ShearLaw, edge_angle: float) -> None:
        self._callback = StrengthCallback(law)
        self._unit = float(self._callback(np.array([_SOME_DEPTH]), np.array([edge_angle]))[0, 0])
        self.refused: Message | None = None

    def share(self, depth: FloatArray, edge_angle: FloatArray, /) -> FloatArray:
        """Failure stress over the reference stress at depths (m) and edge angles (rad); 0 for depths of 0 or less."""
        share = self._callback(depth, edge_angle)[0] / self._unit
        self.refused = self.refused or self._callback.refused
        return share


@dataclass(frozen=True, slots=True, eq=False)
class SnowLaws:
    """Laws of a carve in the form that the core calls; None where the snow's numbers apply."""

    shear: ShearLaw | None
    penetration: PointLaw | None
    asked: tuple[PressureLaw | StrengthLaw, ...]
    compiled: core.CarveLaws

    @property
    def along_base_normal(self) -> bool:
        """True if the pressure also carries the side force."""
        return self.penetration is not None and self.penetration.along_base_normal

    def side_force_limit(
        self, depth: FloatArray, force: FloatArray, edge_angle: FloatArray, length: FloatArray
    ) -> float | None:
        """Largest side force (N) by depths (m), snow forces per length (N/m), edge angles and lengths.

        None if S_f of the snow applies, or the strength is not finite.
        """
        if self.along_base_normal:
            return float(length @ (force * np.tan(edge_angle)))
        if self.shear is None:
            return None
        below = depth > 0.0
        limit = float(self.shear.failure_force(depth[below], length[below], edge_angle[below]).sum())
        return limit if math.isfinite(limit) else None

    def require_finite(self) -> None:
        """Raise an error for a law that returned a value that is not finite; called if no equilibrium was found."""
        for law in self.asked:
            if law.refused:
                raise ParameterError("{problem}, and no equilibrium was found").tag(
                    "no_equilibrium", problem=law.refused
                )


def snow_laws(shear: object, penetration: object, edge_angle: float) -> SnowLaws | None:
    """Check laws and make them ready for the core; None where none is given.

    shear, penetration: A `ShearLaw` and a `PointLaw`, or None.
    edge_angle: Edge angle of the base under the boot (rad).
    Raises ParameterError: an object is not such a law, two laws hold the edge, or a shear law has a thrust or no
        strength.
    """
    if shear is None and penetration is None:
        return None
    if penetration is not None and not isinstance(penetration, PointLaw):
        raise ParameterError(
            "penetration is {law!r}; it must be a law of one place on the snow, not of a whole tool, such as "
            "MeanPressurePoint(…) of skisnow.forces.penetration, or one of yours derived from PointLaw"
        ).tag("wrong_kind", law=penetration)
    if shear is not None and not isinstance(shear, ShearLaw):
        raise ParameterError(
            "shear is {shear!r}; it must be a shear law, such as ConstantShear(0.2e6) of skisnow.forces.shear, or "
            "one of yours derived from ShearLaw"
        ).tag("wrong_kind", shear=shear)
    if shear is not None and penetration is not None and penetration.along_base_normal:
        raise ParameterError(
            "{kind} acts along the base's normal and so carries the side force itself; remove the shear law"
        ).tag("contradiction", kind=type(penetration).__name__)
    pressure = None if penetration is None else PressureLaw(penetration)
    strength = None
    if shear is not None and edge_angle > 0.0:
        _require_strength_alone(shear, edge_angle)
        strength = StrengthLaw(shear, edge_angle)
    compiled = core.CarveLaws(
        None if pressure is None else pressure.stress,
        None if pressure is None else pressure.residual,
        np.array(() if penetration is None else penetration.bends, float),
        None if strength is None else strength.share,
    )
    return SnowLaws(shear, penetration, tuple(law for law in (pressure, strength) if law is not None), compiled)


def _require_strength_alone(law: ShearLaw, edge_angle: float) -> None:
    """Reject a shear law with a thrust, or without a finite strength above 0, at an edge angle (rad)."""
    depth = np.array([_SOME_DEPTH, 5.0 * _SOME_DEPTH, 20.0 * _SOME_DEPTH])
    stress, thrust = law.stress_and_thrust(depth, np.full(3, edge_angle))
    degrees = math.degrees(edge_angle)
    if not (np.isfinite(stress).all() and np.all(stress > 0.0)):
        raise ParameterError("shear is {law!r}, which returns no finite strength above 0 at {degrees:.3g} degrees").tag(
            "invalid_law", law=law, degrees=degrees
        )
    share = float(np.max(np.abs(thrust / stress))) * math.tan(edge_angle)
    if share > 0.0:
        raise ParameterError(
            "shear is {law!r}, which has a thrust. At its strength it would bear {share:.3g} of the load in a "
            "balanced turn at {degrees:.3g} degrees (from 1 on none is left for the base), and a steady carve does "
            "not balance a thrust. Use the strength only: ConstantShear({stress:.6g}), or your own law without "
            "thrust_force. A simulated turn accepts this law"
        ).tag("contradiction", law=law, share=share, degrees=degrees, stress=float(stress[0]))


def equivalent_snow(law: PointLaw, ski: Ski, edge_angle: float, load: float) -> tuple[float, float]:
    """H_V (N/m³) and k_u/H_V of linear snow that bears a load with a straight edge as deep as the law does.

    The law's search for an equilibrium begins there; the equilibrium does not depend on it.

    law: Penetration law of a place on the snow.
    ski, edge_angle, load: The ski, ϑ (rad), force along the snow normal (N).
    Raises ParameterError: the law gives no finite pressure above 0, or lets go at once when the depth shrinks.
    """
    reach = float(ski.at(0.0).width) * math.cos(edge_angle)
    place = 0.5 * np.minimum(reach, _DEPTHS / max(math.tan(edge_angle), 1e-12))[:, None] * (1.0 + _NODES)
    step = place[:, -1:] / (1.0 + _NODES[-1])
    depth = np.maximum(_DEPTHS[:, None] - place * math.tan(edge_angle), 0.0)
    flat = depth.ravel()
    pressure = law.stress_and_energy(flat, flat, np.full(len(flat), edge_angle))[0].reshape(depth.shape)
    force, volume = ((values * step) @ _WEIGHTS for values in (pressure, depth))
    bears = np.flatnonzero(force * _LOADED_SHARE * ski.running_length >= load)
    at = int(bears[0]) if len(bears) else len(_DEPTHS) - 1
    hardness, deepest = float(force[at] / volume[at]), np.array([_DEPTHS[at]])
    if not (math.isfinite(hardness) and hardness > 0.0):
        raise ParameterError(
            "penetration is {law!r}, which returns no finite pressure above 0 under this ski and load"
        ).tag("invalid_law", law=law)
    spring = float(deepest[0] - np.asarray(law.residual_depth(deepest), float)[0])
    if not spring > 0.0:
        raise ParameterError(
            "penetration is {law!r}, which lets go at once when the depth shrinks: residual_depth must stay below "
            "the deepest depth, as with a finite unloading_ratio"
        ).tag("out_of_range", law=law)
    stress = float(law.stress_and_energy(deepest, deepest, np.array([edge_angle]))[0, 0])
    ratio = min(max(stress / spring / hardness, 1.0), STEEPEST_RATIO)
    return hardness, ratio if ratio > 1.0 + 1e-9 else 1.0
