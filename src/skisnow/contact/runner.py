"""The shape of a base that slides on snow."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import MM, Facts, Shown, amount, ends
from ..compiled import core

if TYPE_CHECKING:
    from ..ski import Ski


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Runner(Shown):
    """Shape of a base with two edges: width and height along its length. Its mass belongs to the body that carries it.

    Attributes
    ----------
    position
        Along the runner from its boot, positive ahead (m), falling from tip to tail, as a ski's stations. (n,), n ≥ 2.
    half_width
        From the middle to each edge (m), > 0. (n,).
    base_height
        Height of the unloaded base off the snow, 0 at the boot (m): camber, shovel. (n,).
    nodes
        Positions (m) of the nodes of a beam, falling, the first at the tip, the last at the tail; ``None``: rigid.
    edge_shape
        How its edges are ground, as `Ski.edge_shape`; default: flat and sharp.

    Raises
    ------
    ParameterError
        Positions do not fall, a number is not finite, a width is not above 0, or nodes do not span the runner.

    See Also
    --------
    skisnow.SnowContact
    """

    position: FloatArray
    half_width: FloatArray
    base_height: FloatArray
    nodes: FloatArray | None = None
    edge_shape: tuple[float, float, float, float] = (0.0, 0.0, math.pi / 2.0, 0.0)

    def _repr_facts(self) -> Facts:
        """Title with the length (m), the range of half widths (mm) and the number of nodes."""
        length = amount(float(self.position[0] - self.position[-1]), "m")
        nodes = "rigid" if self.nodes is None else f"{len(self.nodes)} nodes"
        return Facts(f"{length} long, half width {ends(self.half_width, 'mm', factor=MM)}, {nodes}")

    def __post_init__(self) -> None:
        for name in ("position", "half_width", "base_height"):
            array = np.array(getattr(self, name), float)
            array.flags.writeable = False
            object.__setattr__(self, name, array)
            if array.ndim != 1 or len(array) < 2 or array.shape != self.position.shape:
                raise ParameterError("Runner: {name} has shape {shape}; it needs one number for each position").tag(
                    "wrong_shape", name=name, shape=str(array.shape)
                )
            if not np.all(np.isfinite(array)):
                raise ParameterError("Runner: {name} contains a number that is not finite").tag(
                    "not_a_number", name=name
                )
        if np.any(np.diff(self.position) >= 0.0):
            raise ParameterError("Runner: positions must fall from tip to tail").tag("not_falling")
        if self.half_width.min() <= 0.0:
            raise ParameterError("Runner: the half width is {half_width:g} m somewhere; it must be above 0").tag(
                "out_of_range", half_width=self.half_width.min()
            )
        if self.nodes is None:
            return
        nodes = np.array(self.nodes, float)
        object.__setattr__(self, "nodes", nodes)
        ends = (self.position[0], self.position[-1])
        if nodes.ndim != 1 or len(nodes) < 2 or np.any(np.diff(nodes) >= 0.0):
            raise ParameterError("Runner: nodes must be two positions or more that fall from tip to tail").tag(
                "not_falling"
            )
        if not np.allclose((nodes[0], nodes[-1]), ends, atol=1e-9):
            raise ParameterError("Runner: nodes must begin at the tip and end at the tail, {tip:g} and {tail:g} m").tag(
                "out_of_range", tip=ends[0], tail=ends[1]
            )

    @classmethod
    def of(cls, ski: Ski, *, nodes: npt.ArrayLike | None = None) -> Runner:
        """The base of a ski: rigid, or bending with these beam nodes as `SnowContact` receives them."""
        beam = None if nodes is None else np.asarray(nodes, float)
        return cls(ski.station, ski.width / 2.0, ski.base_height, beam, ski.edge_shape)

    @property
    def tip(self) -> float:
        """Position of the tip (m)."""
        return float(self.position[0])

    @property
    def tail(self) -> float:
        """Position of the tail (m)."""
        return float(self.position[-1])

    def compiled(self) -> core.Runner:
        """The runner as the core's type."""
        nodes = np.array([self.tip, self.tail]) if self.nodes is None else self.nodes
        position, half_width, base_height, nodes = (
            np.ascontiguousarray(each) for each in (self.position, self.half_width, self.base_height, nodes)
        )
        return core.runner(position, half_width, base_height, nodes, *self.edge_shape)
