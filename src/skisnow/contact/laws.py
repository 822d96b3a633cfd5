"""Laws of the snow that take the place of those of a scenario, and the form in which the compiled core calls them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import Facts, Shown, name_with_values

if TYPE_CHECKING:
    from ..forces.friction import FrictionLaw
    from ..forces.penetration import PointLaw
    from ..forces.shear import ShearLaw


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Laws(Shown):
    """Laws that replace those of a scenario; ``None`` keeps the scenario's. User-defined classes are allowed.

    Attributes
    ----------
    friction
        μ over the sliding speed.
    shear
        Strength of the edge over its depth and edge angle, with the thrust that comes with it; replaces S_f.
    penetration
        Stress at a place over its depth and its maximum depth so far; replaces H_V and k_u. A law that acts along the
        base's normal also carries the side force, and S_f is then 0.
    """

    friction: FrictionLaw | None = None
    shear: ShearLaw | None = None
    penetration: PointLaw | None = None

    @property
    def described(self) -> dict[str, str | None]:
        """Class and numbers of each law in words; ``None`` for a law of the scenario."""
        laws = {name: getattr(self, name) for name in ("friction", "shear", "penetration")}
        return {name: None if law is None else name_with_values(law) for name, law in laws.items()}

    def _repr_facts(self) -> Facts:
        """Title with the laws that are given."""
        return Facts(", ".join(f"{name} {law}" for name, law in self.described.items() if law) or "none")


class FrictionCallback:
    """Function for the compiled core: coefficient μ of a friction law at arrays of speeds (m/s)."""

    def __init__(self, law: FrictionLaw) -> None:
        self.law = law

    def __call__(self, speed: FloatArray, /) -> FloatArray:
        """The coefficients."""
        return np.ascontiguousarray(np.broadcast_to(self.law.coefficient(speed), speed.shape), float)


class StrengthCallback:
    """Function for the core: strength and thrust (N/m²), (2, n), at depths (m) and edge angles (rad); 0 above the snow.

    Values that are not finite are recorded in ``refused``: a trial step may reach a pose that no ski reaches.
    """

    def __init__(self, law: ShearLaw) -> None:
        self.law = law
        self.refused: Message | None = None

    def __call__(self, depth: FloatArray, edge_angle: FloatArray, /) -> FloatArray:
        """Strength and thrust, shape (2, n); ``refused`` becomes a message if any is not finite, otherwise None."""
        meets = depth > 0.0
        found = np.zeros((2, len(depth)))
        found[:, meets] = self.law.stress_and_thrust(depth[meets], edge_angle[meets])
        bad = ~np.isfinite(found).all(axis=0)
        self.refused = None
        if bad.any():
            worst = float(np.degrees(edge_angle[bad][0]))
            self.refused = Message(
                "{law!r} returns no finite strength at an edge angle of {edge_angle:.3g} degrees",
                law=self.law,
                edge_angle=worst,
            )
        return found


class PressureCallback:
    """Functions of a penetration law, called by the compiled core with arrays over places; values must be finite."""

    def __init__(self, law: PointLaw) -> None:
        self.law = law

    def residual(self, deepest: FloatArray, /) -> FloatArray:
        """Depth (m) that remains after unloading at places with these maximum depths (m)."""
        return self._require_finite(self.law.residual_depth(deepest), deepest.shape, deepest)

    def bear(self, depth: FloatArray, deepest: FloatArray, edge_angle: FloatArray, /) -> FloatArray:
        """Stress (N/m²) and energy (J/m²), (2, n), at depths (m), maximum depths so far and edge angles (rad)."""
        return self._require_finite(self.law.stress_and_energy(depth, deepest, edge_angle), (2, len(depth)), depth)

    def lost(self, deepest: FloatArray, /) -> FloatArray:
        """Energy (J/m²) lost in the snow at places with these maximum depths (m)."""
        return self._require_finite(self.law.lost_energy(deepest), deepest.shape, deepest)

    def refuse(self, reason: Message) -> None:
        """Raise a ParameterError with the reason; called if the law returns a number that is not finite."""
        raise ParameterError(reason).tag("invalid_law")

    def _require_finite(self, found: FloatArray, shape: tuple[int, ...], depth: FloatArray) -> FloatArray:
        """The law's values in this shape; `refuse` is called if one is not finite."""
        found = np.ascontiguousarray(np.broadcast_to(found, shape), float)
        if not np.isfinite(found).all():
            bad = ~np.isfinite(found).reshape(-1, len(depth)).all(axis=0)
            self.refuse(
                Message(
                    "{law!r} returns no finite value at a depth of {depth:.4g} mm",
                    law=self.law,
                    depth=1e3 * depth[bad][0],
                )
            )
        return found
