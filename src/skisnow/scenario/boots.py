"""Boots that move: a table of where each of them is over time, or over the distance run."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt

from .._support.display import Facts, Shown, ends
from .._support.errors import ParameterError
from .._support.nearest import require_choice

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline
    from scipy.spatial.transform import RotationSpline

FloatArray: TypeAlias = npt.NDArray[np.float64]
Frame: TypeAlias = Literal["sledge", "slope"]
Over: TypeAlias = Literal["time", "distance"]

LARGEST: Final = 1e7
"""Largest time (s), distance and coordinate (m) of a pose (modelling assumption: coordinates of a map are below it)."""
SHORTEST_STEP: Final = 1e-6
"""Shortest step from row to row (s, m), so that a spline through the rows is finite (modelling assumption)."""
FURTHEST_TURN: Final = 1e3
"""Largest rotation that the spline between two rows may make (rad): it makes about the half turn that rows can show."""
FEWEST_POSES: Final = 4
"""Rows of a table of boots at least: a cubic goes through them."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Boots(Shown):
    """Poses of both boots over time or distance. The arrays are read-only.

    Attributes
    ----------
    at
        Time (s) or distance run (m), strictly rising, (n,), n ≥ 4. Before the first and after the last the boots rest
        where they are then.
    place
        (n, 2, 3) of the left and the right boot (m).
    axes
        (n, 2, 3, 3) of their skis: ahead, left across the base, off the base, as rows.
    frame
        "sledge": of the sledge, which the snow moves; "slope": of the slope, so that the boots move as they are told
        and nothing else moves them.
    over
        What ``at`` is; "distance" goes with the frame of the sledge.
    source
        Where they come from, in words.

    Raises
    ------
    ParameterError
        Fewer than four rows, shapes that do not fit, a number that is not finite, rows that do not rise, or axes that
        are none.

    See Also
    --------
    skisnow.Scenario

    Notes
    -----
    Places are joined by a cubic spline, axes by a spline of rotations with continuous angular acceleration.
    """

    at: FloatArray
    place: FloatArray
    axes: FloatArray
    frame: Frame = "sledge"
    over: Over = "time"
    source: str = "given as numbers"
    _place: CubicSpline = field(init=False, repr=False)
    _axes: tuple[RotationSpline, ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        from scipy.interpolate import CubicSpline

        for name in ("at", "place", "axes"):
            table = np.array(getattr(self, name), dtype=float)
            table.flags.writeable = False
            object.__setattr__(self, name, table)
        self._require_sound()
        object.__setattr__(self, "_place", CubicSpline(self.at, self.place))
        object.__setattr__(self, "_axes", self._join_axes())

    def _join_axes(self) -> tuple[RotationSpline, ...]:
        """Spline of rotations of each boot; SciPy's iteration diverges where axes turn far within a short step."""
        from scipy.spatial.transform import Rotation, RotationSpline

        turned = np.swapaxes(self.axes, -1, -2)
        powers = np.diff(self.at)[None, :, None] ** np.arange(3, -1, -1)[:, None, None]
        cause: Exception | None = None
        try:
            with np.errstate(over="raise", divide="raise", invalid="raise"):
                rotations = (Rotation.from_matrix(turned[:, ski].copy()) for ski in range(2))
                splines = tuple(RotationSpline(self.at, each) for each in rotations)
                furthest = max(float((np.abs(each.interpolator.c) * powers).sum(axis=0).max()) for each in splines)
        except (ValueError, FloatingPointError, np.linalg.LinAlgError) as error:
            furthest, cause = math.inf, error
        if furthest > FURTHEST_TURN:
            raise ParameterError(
                "boots: no spline joins these axes: they turn too far within too short a step. Correct the rows, or "
                "space them more evenly."
            ) from cause
        return splines

    def _require_sound(self) -> None:
        n = len(self.at) if self.at.ndim == 1 else 0
        if n < FEWEST_POSES or self.place.shape != (n, 2, 3) or self.axes.shape != (n, 2, 3, 3):
            raise ParameterError(
                f"boots need {FEWEST_POSES} rows or more, each with a place (2, 3) and axes (2, 3, 3); there are "
                f"{self.at.shape}, {self.place.shape} and {self.axes.shape}"
            )
        for name in ("at", "place", "axes"):
            if not np.isfinite(getattr(self, name)).all():
                raise ParameterError(f"boots: {name} holds a number that is not finite")
            if np.abs(getattr(self, name)).max() > LARGEST:
                raise ParameterError(f"boots: {name} has a number beyond ±{LARGEST:g}. Correct it.")
        if not (np.diff(self.at) > 0.0).all():
            row = int(np.argmin(np.diff(self.at) > 0.0))
            raise ParameterError(
                f"boots: {self.over} of row {row + 2} is {self.at[row + 1]:g} after {self.at[row]:g}; it must rise"
            )
        if not (np.diff(self.at) >= SHORTEST_STEP).all():
            row = int(np.argmin(np.diff(self.at) >= SHORTEST_STEP))
            raise ParameterError(
                f"boots: {self.over} of row {row + 2} is {self.at[row + 1]:g} after {self.at[row]:g}. Allowed: steps "
                f"of {SHORTEST_STEP:g} or more. Correct the number, or omit one of the rows."
            )
        off = np.abs(self.axes @ np.swapaxes(self.axes, -1, -2) - np.eye(3)).max()
        if off > 1e-9 or np.any(np.linalg.det(self.axes) < 0.0):
            raise ParameterError(f"boots: axes are off by {off:.1e} from right-handed orthonormal ones")
        require_choice("boots: frame", self.frame, get_args(Frame))
        require_choice("boots: over", self.over, get_args(Over))
        if self.frame == "slope" and self.over == "distance":
            raise ParameterError("boots in the slope's frame go over time: the distance run is what they make it")

    def _facts(self) -> Facts:
        unit = "s" if self.over == "time" else "m"
        return Facts(f"{len(self.at)} poses of each, {ends(self.at, unit)}, in the {self.frame}'s frame; {self.source}")

    def poses(self, at: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Places (2, 3), axes (2, 3, 3), velocities and angular velocities (2, 3), in the frame, per unit of ``at``."""
        within = float(np.clip(at, self.at[0], self.at[-1]))
        rest = 0.0 if at != within else 1.0
        axes = np.array([np.swapaxes(each(within).as_matrix(), -1, -2) for each in self._axes])
        turning = np.array([own.T @ each(within, 1) for own, each in zip(axes, self._axes, strict=True)])
        return self._place(within), axes, rest * self._place(within, 1), rest * turning
