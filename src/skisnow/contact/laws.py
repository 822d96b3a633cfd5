"""Laws of the snow that take the place of those of a scenario."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from .._support.units import Facts, Shown, name_with_values

if TYPE_CHECKING:
    from ..forces.friction import FrictionLaw
    from ..forces.penetration import PointLaw
    from ..forces.shear import ShearLaw


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Laws(Shown):
    """Laws, each instead of a scenario's; ``None`` leaves the scenario's. Any class of yours may be one.

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
        """Each law by its class and numbers, ``None`` where the scenario's acts."""
        laws = {name: getattr(self, name) for name in ("friction", "shear", "penetration")}
        return {name: None if law is None else name_with_values(law) for name, law in laws.items()}

    def _facts(self) -> Facts:
        return Facts(", ".join(f"{name} {law}" for name, law in self.described.items() if law) or "none")
