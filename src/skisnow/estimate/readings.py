"""The readings of a campaign with the geometry of their tools: what every estimate starts from."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..field.screening import reading_at_largest_load
from ..geometry import in_form
from ..shown import ShownFields

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ..field.records import PenetrationTests
    from ..geometry import GeometryForm, Tool

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]


@dataclass(frozen=True, repr=False)
class Readings(ShownFields):
    """n readings of m series in SI, series after series, each in the order of loading.

    Attributes
    ----------
    load, penetration_depth
        F (N) and e (m), one per reading.
    edge_angle
        ϑ (rad), one per series.
    first
        m + 1 offsets: readings ``first[i]:first[i + 1]`` belong to series i.
    largest
        Index of the reading under the largest load, one per series: the paper's seventh, which defines the hardness.
    tool
        The tool of each series, as an index into ``tools``.
    tools
        The geometries, in the chosen form.
    """

    load: FloatArray
    penetration_depth: FloatArray
    edge_angle: FloatArray
    first: IntArray
    largest: IntArray
    tool: IntArray
    tools: tuple[Tool, ...]

    @property
    def n_series(self) -> int:
        """Number of series m."""
        return len(self.edge_angle)

    @property
    def n(self) -> int:
        """Number of readings n."""
        return len(self.load)

    @cached_property
    def series(self) -> IntArray:
        """Index of the series of each reading."""
        return np.repeat(np.arange(self.n_series, dtype=np.int64), np.diff(self.first))

    @cached_property
    def angle_of_reading(self) -> FloatArray:
        """Edge angle of each reading (rad)."""
        return self.edge_angle[self.series]

    def sums(self, values: FloatArray) -> FloatArray:
        """Sum a quantity of the readings over each series."""
        total: FloatArray = np.bincount(self.series, weights=values, minlength=self.n_series).astype(
            np.float64, copy=False
        )
        return total

    @cached_property
    def contact_area(self) -> FloatArray:
        """Contact area A of each reading (m²)."""
        return self.area_at_depth(self.penetration_depth)

    @cached_property
    def displaced_volume(self) -> FloatArray:
        """Displaced volume V of each reading (m³)."""
        return self._by_tool(
            lambda tool, e, angle: tool.displaced_volume(e, angle), self.penetration_depth, self.series
        )

    @cached_property
    def area_growth(self) -> FloatArray:
        """Growth dA/de of the contact area of each reading (m)."""
        return self._by_tool(lambda tool, e, angle: tool.area_growth(e, angle), self.penetration_depth, self.series)

    def area_at_depth(self, penetration_depth: FloatArray) -> FloatArray:
        """Contact area A (m²) of each reading's tool at another depth (m)."""
        return self._by_tool(lambda tool, e, angle: tool.contact_area(e, angle), penetration_depth, self.series)

    def volume_at_depth(self, penetration_depth: FloatArray) -> FloatArray:
        """Displaced volume V (m³) of each reading's tool at another depth (m)."""
        return self._by_tool(lambda tool, e, angle: tool.displaced_volume(e, angle), penetration_depth, self.series)

    def depth_at_volume(self, displaced_volume: FloatArray) -> FloatArray:
        """Depth (m) at which each reading's tool displaces the given volume (m³)."""
        return self._by_tool(lambda tool, V, angle: tool.depth_at_volume(V, angle), displaced_volume, self.series)

    def volume_of_series(self, penetration_depth: FloatArray) -> FloatArray:
        """Displaced volume V (m³) of each series' tool at one depth (m) per series."""
        every = np.arange(self.n_series, dtype=np.int64)
        return self._by_tool(lambda tool, e, angle: tool.displaced_volume(e, angle), penetration_depth, every)

    def _by_tool(
        self, form: Callable[[Tool, FloatArray, FloatArray], FloatArray], values: FloatArray, series: IntArray
    ) -> FloatArray:
        result = np.empty(len(values))
        tool, angle = self.tool[series], self.edge_angle[series]
        for index, shape in enumerate(self.tools):
            mine = tool == index
            result[mine] = form(shape, values[mine], angle[mine])
        return result

    def less_offset(self, offset: FloatArray) -> Readings:
        """The same readings with an offset of the depth zero (m, one per series) taken off; depths stay ≥ 0."""
        return replace(self, penetration_depth=np.maximum(self.penetration_depth - offset[self.series], 0.0))

    def of(self, chosen: BoolArray) -> Readings:
        """Keep the chosen series (mask over the m series)."""
        if chosen.all():
            return self
        included = chosen[self.series]
        first = np.concatenate(([0], np.cumsum(np.diff(self.first)[chosen])))
        moved = np.cumsum(included) - 1
        return Readings(
            load=self.load[included],
            penetration_depth=self.penetration_depth[included],
            edge_angle=self.edge_angle[chosen],
            first=first.astype(np.int64),
            largest=moved[self.largest[chosen]].astype(np.int64),
            tool=self.tool[chosen],
            tools=self.tools,
        )


def readings_of(tests: PenetrationTests, tools: Mapping[str, Tool], *, geometry: GeometryForm) -> Readings:
    """The readings of all tests, each series with its own tool in the chosen form."""
    names = sorted(set(tests.tool))
    number = {name: index for index, name in enumerate(names)}
    return Readings(
        load=tests.load,
        penetration_depth=tests.penetration_depth,
        edge_angle=tests.edge_angle,
        first=tests.first,
        largest=reading_at_largest_load(tests),
        tool=np.array([number[name] for name in tests.tool], dtype=np.int64),
        tools=tuple(in_form(tools[name], geometry) for name in names),
    )
