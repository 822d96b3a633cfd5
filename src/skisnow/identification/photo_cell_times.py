"""Residuals of photo-cell times: friction and drag together, after Kaps, Nachbauer and Mössner (1996)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import DEGREE
from ..scenario import Plane, ScenarioFile
from .data_tables import PhotoCellRun, PhotoCells
from .glide import Glide, SlopeLine, passage_times, planes, slope_line
from .problem import Fit, Kind, Values, run_values

USED_KEYS: Final = (
    "friction.mu_0", "friction.mu_1_s_per_m", "drag.drag_area_m2", "drag.air_density_kg_per_m3", "start.speed_m_per_s",
    "sledge.mass_kg", "slope.angle_deg", "slope.gravity_m_per_s2",
)  # fmt: skip
"""Keys that the times depend on."""
NOMINAL_SD: Final = 0.01
"""Standard deviation (s) if none is stated; it cancels, because the noise is then estimated from the residuals."""


@dataclass(slots=True)
class PhotoCellTimes:
    """Times of passage down the fall line, from the scenario's start on.

    scenario: the scenario: slope, mass with both skis, and the values of the fixed inputs.
    starts: values of ``start.…`` keys for single runs, by run.
    clock_is_free: True if each run's clock has a separate offset; otherwise it is 0 when the body leaves the start.
    """

    cells: PhotoCells
    scenario: ScenarioFile
    starts: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    clock_is_free: bool = False
    kind: Kind = field(default="photo_cells", init=False)
    used_keys: tuple[str, ...] | None = field(default=USED_KEYS, init=False)
    points: int = field(init=False)
    nuisances: int = field(init=False)
    accuracy_is_stated: bool = field(init=False)
    series: tuple[int, ...] = field(init=False)
    _line: SlopeLine = field(init=False)
    _skis: float = field(init=False)

    def __post_init__(self) -> None:
        scenario = self.scenario.scenario
        scenario.contact.require_linear_friction()
        self._line = slope_line(scenario.slope, scenario.start.x)
        self._skis = 2.0 * scenario.ski.mass
        stated = {run.time_sd is not None for run in self.cells.runs}
        if len(stated) > 1:
            raise ParameterError(
                "{name}: some runs state time_sd_s and some do not; write it for all of them, or for none"
            ).tag("partial_accuracy", name=self.cells.name)
        for run in self.cells.runs:
            last, length = run.station[-1], self._line.length
            if last > length:
                raise ParameterError(
                    "{name}, run {run}: station {station:g} m is beyond the end of the profile, {length:.4g} m from "
                    "the start. Is it the right slope?"
                ).tag("out_of_range", name=self.cells.name, run=run.name, station=last, length=length)
        self.series = tuple(len(self._cells_after_start(run)[0]) for run in self.cells.runs)
        self.points = sum(self.series)
        self.nuisances = len(self.cells.runs) if self.clock_is_free else 0
        self.accuracy_is_stated = self.cells.runs[0].time_sd is not None

    def residuals(self, many: Sequence[Values], *, final: bool = False) -> list[FloatArray | None]:  # noqa: ARG002
        """(Computed - measured)/sd of every passage, run after run, for each set of values; never None."""
        residuals: list[list[FloatArray]] = [[] for _ in many]
        for run in self.cells.runs:
            station, time, sd = self._cells_after_start(run)
            for parts, late in zip(residuals, self._passage_times(run, station, many) - time, strict=True):
                parts.append(self._without_offset(late, sd) / sd)
        return [np.concatenate(parts) for parts in residuals]

    def fits(self, values: Values) -> tuple[Fit, ...]:
        """Measured and computed passage times of each run, over the distance (m)."""
        fits = []
        for run in self.cells.runs:
            station, time, sd = self._cells_after_start(run)
            late = self._passage_times(run, station, [values])[0] - time
            numbers = (time, time + self._without_offset(late, sd), sd)
            columns = dict(zip(("measured", "fitted", "sd"), (column[:, None] for column in numbers), strict=True))
            fits.append(Fit(name=run.name, kind="photo_cells", along=station, labels=("time (s)",), **columns))
        return tuple(fits)

    def warnings(self, values: Values) -> tuple[Message, ...]:  # noqa: ARG002 - the same for all values
        """Warning if the scenario's heading has no effect."""
        if self.scenario.scenario.start.heading == 0.0:
            return ()
        heading = self.scenario.scenario.start.heading / DEGREE
        return (
            Message(
                "the scenario's heading of {heading:g}° plays no part: photo cells stand down the fall line",
                heading=heading,
            ),
        )

    def _cells_after_start(self, run: PhotoCellRun) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Stations (m), times and standard deviations (s); a cell at 0 m only if the clock is free."""
        sd = run.time_sd if run.time_sd is not None else np.full(len(run.time), NOMINAL_SD)
        first = int(not self.clock_is_free and run.station[0] == 0.0)
        return run.station[first:], run.time[first:], sd[first:]

    def _without_offset(self, late: FloatArray, sd: FloatArray) -> FloatArray:
        """Time differences (s) less their weighted mean if the clock is free, otherwise unchanged."""
        if not self.clock_is_free:
            return late
        weight = sd**-2.0
        return np.asarray(late - np.sum(weight * late) / np.sum(weight))

    def _passage_times(self, run: PhotoCellRun, station: FloatArray, many: Sequence[Values]) -> FloatArray:
        """Simulated times (s) at the stations (m), one row for each set of values."""
        fixed = {**self.scenario.values, **self.starts.get(run.name, {})}
        sets = [{**fixed, **run_values(values, run.name)} for values in many]
        duration = float(run.time[-1] - (run.time[0] if self.clock_is_free else 0.0))

        def values_of_key(key: str) -> FloatArray:
            return np.array([float(values[key]) for values in sets])

        is_plane = isinstance(self.scenario.scenario.slope, Plane)
        line = planes(values_of_key("slope.angle_deg") * DEGREE) if is_plane else self._line
        mass = values_of_key("sledge.mass_kg") + self._skis
        glide = Glide(
            friction=values_of_key("friction.mu_0"),
            friction_by_speed=values_of_key("friction.mu_1_s_per_m"),
            drag_per_mass=0.5 * values_of_key("drag.air_density_kg_per_m3") * values_of_key("drag.drag_area_m2") / mass,
            speed=values_of_key("start.speed_m_per_s"),
            gravity=values_of_key("slope.gravity_m_per_s2"),
        )
        return passage_times(line, glide, station, max(duration, 1e-3))
