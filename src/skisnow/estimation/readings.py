"""Readings of a campaign with the geometry of their tools: the input of every estimate."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .._support.arrays import BoolArray, FloatArray, IntArray
from .._support.units import ShownFields
from ..campaign.records import PenetrationTests
from ..campaign.screening import reading_at_largest_load
from ..geometry import GeometryForm, Tool, in_form

_FEW_ANGLES = 16
"""Readings at up to so many angles are gone through angle by angle: each has one sine and one tangent."""


@dataclass(frozen=True, slots=True)
class ReadingUncertainty:
    """Standard uncertainties of one reading: depth u_e (m) and load u_F (N); 0 where unknown."""

    depth: float = 0.0
    load: float = 0.0


@dataclass(frozen=True, repr=False)
class Readings(ShownFields):
    """n readings of m series in SI, series after series, each in the order of loading.

    load, penetration_depth: F (N) and e (m), one per reading.
    edge_angle: ϑ (rad), one per series.
    first: m + 1 offsets: readings ``first[i]:first[i + 1]`` belong to series i.
    largest: index of the reading under the largest load, one per series: the paper's seventh, which defines the
        hardness.
    tool: the tool of each series, as an index into ``tools``.
    tools: the geometries, in the chosen form.
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
        return self.volume_at_depth(self.penetration_depth)

    @cached_property
    def area_growth(self) -> FloatArray:
        """Growth dA/de of the contact area of each reading (m)."""
        return self._compute_by_tool(lambda tool, e, angle: tool.area_growth(e, angle), self.penetration_depth)

    def area_at_depth(self, penetration_depth: FloatArray) -> FloatArray:
        """Contact area A (m²) of each reading's tool at another depth (m)."""
        return self._compute_by_tool(lambda tool, e, angle: tool.contact_area(e, angle), penetration_depth)

    def volume_at_depth(self, penetration_depth: FloatArray) -> FloatArray:
        """Displaced volume V (m³) of each reading's tool at another depth (m)."""
        return self._compute_by_tool(lambda tool, e, angle: tool.displaced_volume(e, angle), penetration_depth)

    def depth_at_volume(self, displaced_volume: FloatArray) -> FloatArray:
        """Depth (m) at which each reading's tool displaces the given volume (m³)."""
        return self._compute_by_tool(lambda tool, V, angle: tool.depth_at_volume(V, angle), displaced_volume)

    def volume_of_series(self, penetration_depth: FloatArray) -> FloatArray:
        """Displaced volume V (m³) of each series' tool at one depth (m) per series."""
        result = np.empty(self.n_series)
        for index, tool in enumerate(self.tools):
            mine = self.tool == index
            result[mine] = tool.displaced_volume(penetration_depth[mine], self.edge_angle[mine])
        return result

    @cached_property
    def _tool_groups(self) -> tuple[tuple[Tool, FloatArray, IntArray], ...]:
        """Groups of readings with the same tool and edge angle: tool, angle (rad) and indices of the readings.

        A tool with more than `_FEW_ANGLES` angles is one group, with the angle of each reading.
        """
        groups: list[tuple[Tool, FloatArray, IntArray]] = []
        for index, tool in enumerate(self.tools):
            mine = self.tool == index
            angles = np.unique(self.edge_angle[mine])
            if len(angles) <= _FEW_ANGLES:
                masks = ((angle, mine & (self.edge_angle == angle)) for angle in angles)
                groups += [(tool, angle, np.flatnonzero(series[self.series])) for angle, series in masks]
            else:
                readings = np.flatnonzero(mine[self.series])
                groups.append((tool, self.angle_of_reading[readings], readings))
        return tuple(groups)

    def _compute_by_tool(
        self, function: Callable[[Tool, FloatArray, FloatArray], FloatArray], values: FloatArray
    ) -> FloatArray:
        """Results (n,) of function(tool, values, edge angle), where `values` (n,) has one number for each reading."""
        result = np.empty(self.n)
        for tool, angle, mine in self._tool_groups:
            result[mine] = function(tool, values[mine], angle)
        return result

    def less_offset(self, offset: FloatArray) -> Readings:
        """Readings with an offset (m, one per series) subtracted from depths; negative depths become 0."""
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
