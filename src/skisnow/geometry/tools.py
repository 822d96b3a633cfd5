"""Tools pressed into a flat snow surface: projected contact area A and displaced volume V.

Sources: Mössner and others (2013), Eqns 2 and 3, for the edged and the flat ski piece; the continuations are exact
geometry. Side walls count neither in A nor in V. For every tool here A = dV/de, because the area is the one projected
on the snow surface; tests check this for each tool.

All depths are in m, areas in m², volumes in m³, angles in rad. Functions take scalars or arrays and return arrays.
"""

from __future__ import annotations

import abc
from dataclasses import dataclass
from typing import Annotated, Final, Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import require_choice
from ..parameters import Quantity, require_declared

GeometryForm: TypeAlias = Literal["extended", "paper"]

LIKELY_LENGTH_MM: Final = (2.0, 5000.0)
"""Lengths of tools beyond it are hardly in mm."""


def _length_quantity(name: str, meaning: str) -> Quantity:
    """Quantity for a length in mm, above 0 and with the usual range of tools."""
    return Quantity(name, meaning, lowest=0.0, above=True, usual=LIKELY_LENGTH_MM)


_FLAT: Final = 1e-300
"""Edge angles (rad) not above it are 0: lengths over their tangents would overflow."""


def _tangent(angle: FloatArray) -> FloatArray:
    """Value of tan ϑ in the shape of the angles; 1 for a flat tool, which has no wedge."""
    return np.where(angle > _FLAT, np.tan(angle), 1.0)


class Tool(abc.ABC):
    """A rigid body pressed into snow along the snow normal.

    A new shape is a new frozen dataclass below with these five methods, and one entry in the reader of
    campaign files.
    """

    def __post_init__(self) -> None:
        require_declared(self)

    @abc.abstractmethod
    def contact_area(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Contact area A projected on the snow surface (m²) at penetration depth e (m, ≥ 0), edge angle ϑ (rad)."""

    @abc.abstractmethod
    def displaced_volume(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Volume V of snow displaced (m³) at penetration depth e (m, ≥ 0), edge angle ϑ (rad)."""

    @abc.abstractmethod
    def area_growth(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Derivative dA/de (m) of the contact area by the depth, for the propagation of errors."""

    @abc.abstractmethod
    def depth_at_volume(self, displaced_volume: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Penetration depth e (m) at which the volume V (m³, ≥ 0) is displaced: the inverse of `displaced_volume`."""

    @abc.abstractmethod
    def maximum_depth(self, edge_angle: npt.ArrayLike) -> FloatArray:
        """Depth (m) up to which the tool has the shape of its name; deeper readings are flagged."""


@dataclass(frozen=True, slots=True)
class SkiPiece(Tool):
    """A flat piece of ski, length L along its edge and width W, tilted by the edge angle ϑ about that edge.

    With ϑ > 0 it is a wedge while the upper edge of its base is above the snow, e ≤ W sin ϑ:
    A = L e / tan ϑ and V = L e² / (2 tan ϑ) (Eqn 2). Deeper, the whole base is loaded:
    A = L W cos ϑ and V = L W cos ϑ (e - W sin ϑ / 2). Flat, ϑ = 0: A = L W and V = L W e (Eqn 3).

    Notes
    -----
    The paper has only the wedge. It diverges at small ϑ: at 5° a base of 62 mm is a wedge only to 5.4 mm. The
    continuation is exact geometry, joins A and V continuously and contains the flat tool as ϑ → 0. ``PlainWedge`` is
    the paper's form.

    Examples
    --------
    200 mm of ski at 45°, 10 mm deep: A = 200·10 mm², V = 200·100/2 mm³.

    >>> import math
    >>> tool = SkiPiece(length=0.2, width=0.062)
    >>> round(float(tool.contact_area(0.010, math.radians(45))) * 1e6, 6)
    2000.0
    >>> round(float(tool.displaced_volume(0.010, math.radians(45))) * 1e9, 6)
    10000.0
    """

    length: Annotated[float, _length_quantity("length_mm", "length along the edge")]
    width: Annotated[float, _length_quantity("width_mm", "width of the base")]

    def contact_area(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Contact area (m²) at depth e (m), edge angle (rad): L e / tan ϑ for the wedge, then the whole base."""
        e, angle = np.asarray(penetration_depth, float), np.asarray(edge_angle, float)
        wedge = e < self.width * np.sin(angle)
        return self.length * np.where(wedge, e / _tangent(angle), self.width * np.cos(angle))

    def displaced_volume(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Volume displaced (m³) at depth e (m) and edge angle (rad): a wedge, then with the whole base loaded."""
        e, angle = np.asarray(penetration_depth, float), np.asarray(edge_angle, float)
        rim = self.width * np.sin(angle)
        wedge = e < rim
        plain = e**2 / (2.0 * _tangent(angle))
        return self.length * np.where(wedge, plain, self.width * np.cos(angle) * (e - rim / 2.0))

    def area_growth(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Derivative dA/de (m): L / tan ϑ for the wedge, 0 once the whole base is loaded."""
        e, angle = np.asarray(penetration_depth, float), np.asarray(edge_angle, float)
        wedge = e < self.width * np.sin(angle)
        return np.where(wedge, self.length / _tangent(angle), 0.0)

    def depth_at_volume(self, displaced_volume: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Depth (m) at which the volume (m³) is displaced, at an edge angle (rad)."""
        V, angle = np.asarray(displaced_volume, float), np.asarray(edge_angle, float)
        rim = self.width * np.sin(angle)
        base = self.length * self.width * np.cos(angle)
        wedge = base * rim / 2.0 > V
        plain: FloatArray = np.sqrt(2.0 * _tangent(angle) * V / self.length)
        return np.where(wedge, plain, V / base + rim / 2.0)

    def maximum_depth(self, edge_angle: npt.ArrayLike) -> FloatArray:
        """Depth (m) above which readings are flagged: the width, beyond which snow closes over real pieces of ski."""
        return np.full(np.shape(edge_angle), self.width)


@dataclass(frozen=True, slots=True)
class PlainWedge(Tool):
    """The paper's ski piece: Eqn 2 at every depth for ϑ > 0, Eqn 3 for ϑ = 0.

    Notes
    -----
    Kept to reproduce the paper. Beyond e = W sin ϑ it includes snow next to the tool; such readings are marked.
    """

    length: Annotated[float, _length_quantity("length_mm", "length along the edge")]
    width: Annotated[float, _length_quantity("width_mm", "width of the base")]

    def contact_area(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Contact area (m²) at depth e (m) and edge angle (rad): L e / tan ϑ, or L W if flat."""
        e, angle = np.asarray(penetration_depth, float), np.asarray(edge_angle, float)
        return self.length * np.where(angle > _FLAT, e / _tangent(angle), self.width)

    def displaced_volume(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Volume displaced (m³) at depth e (m) and edge angle (rad): L e² / (2 tan ϑ), or L W e if flat."""
        e, angle = np.asarray(penetration_depth, float), np.asarray(edge_angle, float)
        return self.length * np.where(angle > _FLAT, e**2 / (2.0 * _tangent(angle)), self.width * e)

    def area_growth(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Derivative dA/de (m) of the contact area by the depth: L / tan ϑ, or 0 if flat."""
        _, angle = np.broadcast_arrays(np.asarray(penetration_depth, float), np.asarray(edge_angle, float))
        return np.where(angle > _FLAT, self.length / _tangent(angle), 0.0)

    def depth_at_volume(self, displaced_volume: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Depth (m) at which the volume V (m³) is displaced: √(2 V tan ϑ / L), or V / (L W) if flat."""
        V, angle = np.asarray(displaced_volume, float), np.asarray(edge_angle, float)
        plain = np.sqrt(2.0 * _tangent(angle) * V / self.length)
        flat: FloatArray = V / (self.length * self.width)
        return np.where(angle > _FLAT, plain, flat)

    def maximum_depth(self, edge_angle: npt.ArrayLike) -> FloatArray:
        """Depth (m) above which readings are flagged: W sin ϑ edged, where the base goes under; W when flat."""
        angle = np.asarray(edge_angle, float)
        return np.where(angle > _FLAT, self.width * np.sin(angle), self.width)


@dataclass(frozen=True, slots=True)
class Disc(Tool):
    """A flat disc of diameter d: A = π d²/4, V = A e. The edge angle is ignored.

    >>> round(float(Disc(diameter=0.1).displaced_volume(0.02, 0.0)) * 1e6, 3)  # cm³
    157.08
    """

    diameter: Annotated[float, _length_quantity("diameter_mm", "diameter")]

    @property
    def _face_area(self) -> float:
        """Area of the disc (m²)."""
        return float(np.pi * self.diameter**2 / 4.0)

    def contact_area(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:  # noqa: ARG002
        """Contact area (m²): that of the disc, at any depth and edge angle."""
        return np.full(np.shape(penetration_depth), self._face_area)

    def displaced_volume(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:  # noqa: ARG002
        """Volume displaced (m³): area of the disc times the depth (m)."""
        return self._face_area * np.asarray(penetration_depth, float)

    def area_growth(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:  # noqa: ARG002
        """Derivative dA/de (m) of the contact area by the depth: 0."""
        return np.zeros(np.shape(penetration_depth))

    def depth_at_volume(self, displaced_volume: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:  # noqa: ARG002
        """Depth (m) at which the volume (m³) is displaced: volume over area of the disc."""
        return np.asarray(displaced_volume, float) / self._face_area

    def maximum_depth(self, edge_angle: npt.ArrayLike) -> FloatArray:
        """Depth (m) above which readings are flagged: the diameter."""
        return np.full(np.shape(edge_angle), self.diameter)


@dataclass(frozen=True, slots=True)
class LyingCylinder(Tool):
    """A cylinder lying on its side, radius R, length w along its axis (its ``width``).

    A = 2 w √(2 R e - e²), V = w (R² arccos((R - e)/R) - (R - e) √(2 R e - e²)) for e ≤ R.
    Deeper than R the widest section stays loaded: A = 2 w R, V grows with A.

    >>> half = LyingCylinder(radius=0.05, width=0.1).displaced_volume(0.05, 0.0)  # half of π R² w
    >>> round(float(half) * 1e6, 3)
    392.699
    """

    radius: Annotated[float, _length_quantity("radius_mm", "radius")]
    width: Annotated[float, _length_quantity("width_mm", "length along the axis")]

    def _half_chord(self, e: FloatArray) -> FloatArray:
        """Half width (m) of the section at depth e (m): √(e (2 R - e)), at most R."""
        chord = np.sqrt(np.maximum(e * (2.0 * self.radius - e), 0.0))
        half: FloatArray = np.where(e < self.radius, chord, self.radius)
        return half

    def contact_area(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:  # noqa: ARG002
        """Contact area (m²) at depth e (m): 2 w √(e (2 R - e)), at most 2 w R; the edge angle has no effect."""
        return 2.0 * self.width * self._half_chord(np.asarray(penetration_depth, float))

    def displaced_volume(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:  # noqa: ARG002
        """Volume displaced (m³) at depth e (m): width times the circle's segment, straight sides beyond depth R."""
        e = np.asarray(penetration_depth, float)
        R = self.radius
        inside = np.minimum(e, R)
        # 2 arcsin √(e/2R) = arccos((R - e)/R), without its loss of digits at small e
        sector: FloatArray = R**2 * 2.0 * np.arcsin(np.sqrt(inside / (2.0 * R)))
        section = sector - (R - inside) * self._half_chord(inside)
        volume: FloatArray = self.width * (section + 2.0 * R * (e - inside))
        return volume

    def area_growth(self, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:  # noqa: ARG002
        """Derivative dA/de (m) of the contact area by the depth; infinite at e = 0, where the contact is a line."""
        e = np.asarray(penetration_depth, float)
        with np.errstate(divide="ignore", invalid="ignore"):
            growth = 2.0 * self.width * (self.radius - e) / self._half_chord(e)
        return np.where(e < self.radius, growth, 0.0)

    def depth_at_volume(self, displaced_volume: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Depth (m) at which the volume (m³) is displaced, by Newton's method from above, as V is convex."""
        V = np.asarray(displaced_volume, float)
        R = self.radius
        buried = R + (V / self.width - np.pi * R**2 / 2.0) / (2.0 * R)
        # V ≥ w (4/3) √R e^1.5 bounds the depth of a shallow contact from above
        e = np.where(buried >= R, buried, np.minimum((0.75 * V / (self.width * np.sqrt(R))) ** (2.0 / 3.0), R))
        for _ in range(60):
            area = self.contact_area(e, edge_angle)
            excess = self.displaced_volume(e, edge_angle) - V
            step = np.divide(excess, area, out=np.zeros_like(e), where=area > 0)
            e = e - step
            if np.all(np.abs(step) <= 1e-15 * R):
                break
        return e

    def maximum_depth(self, edge_angle: npt.ArrayLike) -> FloatArray:
        """Depth (m) above which readings are flagged: the radius."""
        return np.full(np.shape(edge_angle), self.radius)


def in_form(tool: Tool, form: GeometryForm) -> Tool:
    """Return the tool in the chosen form: a ski piece becomes the paper's plain wedge, any other tool stays itself.

    Raises ParameterError: the form is not a `GeometryForm`.
    """
    require_choice("geometry", form, get_args(GeometryForm))
    if form == "paper" and isinstance(tool, SkiPiece):
        return PlainWedge(length=tool.length, width=tool.width)
    return tool
