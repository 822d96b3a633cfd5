"""A gate: the turning pole, the side on which it is passed, the outer pole where there is one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from ..._support.display import ShownFields
from ..._support.errors import ParameterError
from ..._support.nearest import require_choice

Side: TypeAlias = Literal["left", "right"]
Point: TypeAlias = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Gate(ShownFields):
    """One gate of a course, seen from above.

    Attributes
    ----------
    name
        As the file has it, such as its number.
    turning
        Place x, y (m) of the turning pole: of a panel the pole beside which the racer goes by.
    side
        On which side of the turning pole it is passed, seen down the course.
    outer
        Place (m) of the outer pole; None: there is none, and the gate is as wide as the slope.

    Raises
    ------
    ParameterError
        A place is not finite, both poles stand at one place, or the side is no side.

    See Also
    --------
    skisnow.Course
    skisnow.read_course
    """

    name: str
    turning: Point
    side: Side
    outer: Point | None = None

    def __post_init__(self) -> None:
        require_choice(f"gate {self.name}: side", self.side, get_args(Side))
        for pole, place in (("turning", self.turning), ("outer", self.outer)):
            if place is not None and not all(math.isfinite(each) for each in place):
                raise ParameterError(f"gate {self.name}: the {pole} pole stands at {place}; both must be finite, in m")
        if self.outer is not None and not self.width > 0.0:
            raise ParameterError(
                f"gate {self.name}: both poles stand at {self.turning}; move one, or leave the outer out"
            )

    @property
    def width(self) -> float:
        """Between the poles (m); infinite without an outer pole."""
        return math.inf if self.outer is None else math.dist(self.turning, self.outer)
