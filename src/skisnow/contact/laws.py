"""Laws of the snow that take the place of those of a scenario."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..shown import Facts, Shown

if TYPE_CHECKING:
    from ..forces.friction import FrictionLaw
    from ..forces.penetration import PointLaw
    from ..forces.shear import ShearLaw


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Laws(Shown):
    """Laws, each in place of a scenario's; ``None`` leaves the scenario's. Any class of yours may be one.

    Attributes
    ----------
    friction
        μ over the sliding speed.
    shear
        Strength of the edge over its depth and edge angle, with the thrust that comes with it; in place of S_f.
    penetration
        Stress at a place over its depth and its deepest depth; in place of H_V and k_u. One that acts along the base's
        normal holds the ski across by itself, and S_f is 0 with it.
    """

    friction: FrictionLaw | None = None
    shear: ShearLaw | None = None
    penetration: PointLaw | None = None

    def _facts(self) -> Facts:
        given = {name: getattr(self, name) for name in ("friction", "shear", "penetration")}
        return Facts(", ".join(f"{name} {type(law).__name__}" for name, law in given.items() if law) or "none")
