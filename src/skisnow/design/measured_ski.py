"""A ski from the measurements of a maker: tables, bend and torsion tests, or only three widths.

Three-point bend tests of a ski whose stiffness varies, with the load F in the middle of the span L at the station s:

    w/F = ∫ m² c dx,    m = (L/2 - |x - s|)/2,    c = 1/EI

and torsion tests over a length l about s: φ/M = ∫ 1/GJ dx. The compliance c is linear between the stations of the tests
and constant beyond them, which makes both linear equations for its values there. Of a ski of one stiffness they give
EI = F L³/(48 w) and GJ = M l/φ.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final, Literal

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import DEGREE, MM
from ..ski.assembling import ArcOutline, assembled_ski, width_of_table
from ..ski.layout import TAIL_OVERHANG, Layout, StationFunction, layout_of_lengths
from ..ski.ski import Ski
from ..ski.ski_file import read_ski
from ..ski.table_file import StationTable
from .ski_tables import BEND_TEST, TORSION_TEST, Mapped, read_ski_table

_POINTS: Final = 801  # of the integral over a span: the error is below 10⁻⁵


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """Known values of a ski, in SI; None: not known.

    name, tables, mapped: name of the ski, its files, and the user's statements about their headings.
    stations_from: where the stations of the tables count from: tip, tail or boot.
    boot: distance of the boot from the tail (m); None: in the middle of the sidecut length (modelling assumption).
    length, running_length, sidecut_length: as in a ski file (m).
    radius: of the sidecut (m), from which the sidecut length follows.
    widths: of tip, waist and tail (m), where no table has widths.
    mass: mass of one ski (kg).
    like: ski from which the rest is taken.
    dial_step, angle_step: step of the gauge of a bend test (m) and of a torsion test (rad): standard uncertainty
        step/√12.
    """

    name: str
    tables: tuple[Path, ...] = ()
    mapped: Mapped = field(default_factory=Mapped)
    stations_from: Literal["tip", "tail", "boot"] | None = None
    boot: float | None = None
    length: float | None = None
    running_length: float | None = None
    sidecut_length: float | None = None
    radius: float | None = None
    widths: tuple[float, float, float] | None = None
    mass: float | None = None
    like: str = "carver"
    dial_step: float = 0.01 * MM
    angle_step: float = 0.1 * DEGREE


@dataclass(frozen=True, slots=True)
class Stiffness:
    """EI or GJ (N m²) at the stations (m from the boot, falling), with standard errors (NaN: not from tests)."""

    station: FloatArray
    value: FloatArray
    error: FloatArray


@dataclass(frozen=True, slots=True)
class MeasuredSki:
    """The ski, its measured stiffnesses, and the assumptions."""

    ski: Ski
    bending: Stiffness | None
    torsion: Stiffness | None
    assumed: tuple[Message, ...]


def measured_ski(measured: Measured) -> MeasuredSki:
    """Make a ski from measurements. Raises ParameterError: a table is unreadable, or a needed value is unknown."""
    return _SkiMaker(measured).made()


class _SkiMaker:
    """Ski from measured tables and tests; what was not measured is taken from a similar ski and noted."""

    def __init__(self, measured: Measured) -> None:
        self._measured = measured
        self._like = read_ski(measured.like)
        self._tables = [read_ski_table(path, measured.mapped) for path in measured.tables]
        self._assumed: list[Message] = []
        self._width = self._column("width_mm")
        length = measured.length
        if length is None and self._width is not None:
            length = float(np.ptp(self._width[0])) * MM
        if length is None:
            raise ParameterError(
                "The length of the ski is not known. Give --length-mm, or a table with widths from tip to tail."
            ).tag("missing")
        self._length = length

    def made(self) -> MeasuredSki:
        """The finished ski, its measured stiffnesses, and the assumptions."""
        layout, width = self._outlined()
        bending = self._stiffness("EI_N_m2", BEND_TEST, layout)
        torsion = self._stiffness("GJ_N_m2", TORSION_TEST, layout)
        like, base = self._like, self._column("base_height_mm")
        if base is None:
            self._assumed.append(Message("camber, shovel and tail of {ski}", ski=like.name))
        ski = assembled_ski(
            layout,
            name=self._measured.name,
            source="",
            width=width,
            base=self._of_like("base_height", layout) if base is None else self._station_table(base, MM, layout).at,
            bending_stiffness=self._stiffness_along_ski(bending, "bending_stiffness", layout),
            torsional_stiffness=self._stiffness_along_ski(torsion, "torsional_stiffness", layout),
            mass=self._measured.mass or 1.0,
        )
        if self._measured.mass is None:
            per_area = like.mass / -np.trapezoid(like.width, like.station)
            mass = float(per_area * -np.trapezoid(ski.width, ski.station))
            ski = replace(ski, mass_per_length=ski.mass_per_length * mass)
            self._assumed.append(Message("mass per area of {ski}", ski=like.name))
        files = ", ".join(path.name for path in self._measured.tables)
        assumed = "; ".join(map(str, self._assumed))
        return MeasuredSki(
            replace(ski, source=f"{files or 'three widths'}; assumed: {assumed or 'nothing'}"),
            bending,
            torsion,
            tuple(self._assumed),
        )

    def _column(self, *names: str) -> tuple[FloatArray, ...] | None:
        """Stations (mm, as in the table) and columns of all tables, without rows that lack a value; None: no rows."""
        rows = [np.stack([t[n] for n in ("station_mm", *names)]) for t in self._tables if all(n in t for n in names)]
        joined = np.concatenate(rows, axis=1) if rows else np.zeros((1 + len(names), 0))
        joined = joined[:, np.isfinite(joined).all(axis=0)]
        return tuple(joined) if joined.size else None

    def _outlined(self) -> tuple[Layout, StationFunction]:
        """Layout of the ski, and its width (m) as a function of station (m)."""
        like, known = self._like, self._measured
        running_share = like.running_length / like.sidecut_length
        if self._width is None:
            if known.widths is None:
                raise ParameterError(
                    "The widths of the ski are not known. Give --widths-mm, or a table with widths."
                ).tag("missing")
            tip, waist, tail = known.widths
            sidecut = known.sidecut_length or self._sidecut_of_radius(tip, waist, tail)
            middle = TAIL_OVERHANG + sidecut / 2.0
            layout = layout_of_lengths(
                length=self._length,
                sidecut_length=sidecut,
                running_length=known.running_length or running_share * sidecut,
                boot_position=0.0 if known.boot is None else known.boot - middle,
            )
            width: StationFunction = ArcOutline(
                layout=layout, tip_width=tip, waist_width=waist, tail_width=tail
            ).width_at
        else:
            layout, width = self._layout_of_widths(running_share)
        if known.boot is None and known.stations_from != "boot":
            self._assumed.append(Message("the boot in the middle of the sidecut length"))
        if known.running_length is None:
            self._assumed.append(Message("running length over sidecut length of {ski}", ski=like.name))
        return layout, width

    def _sidecut_of_radius(self, tip: float, waist: float, tail: float) -> float:
        """Sidecut length (m) for the measured radius and these widths; without a radius scaled from the similar ski."""
        if self._measured.radius is not None:
            return math.sqrt(8.0 * self._measured.radius * ((tip + tail) / 4.0 - waist / 2.0))
        self._assumed.append(Message("sidecut length over length of {ski}", ski=self._like.name))
        return self._length * self._like.sidecut_length / self._like.length

    def _layout_of_widths(self, running_share: float) -> tuple[Layout, StationFunction]:
        """Layout and width function, with the sidecut between the widest measured places."""
        assert self._width is not None
        known = self._measured
        from_tail = self._from_tail(self._width[0])
        order = np.argsort(-from_tail)
        place, width = from_tail[order], self._width[1][order] * MM
        front, rear = place > self._length / 2.0, place < self._length / 2.0
        if not (front.any() and rear.any()):
            raise ParameterError("The table needs widths in front of and behind the middle of the ski. Add rows.").tag(
                "missing"
            )
        ends = float(place[front][np.argmax(width[front])]), float(place[rear][np.argmax(width[rear])])
        middle, sidecut = sum(ends) / 2.0, known.sidecut_length or ends[0] - ends[1]
        boot = known.boot
        if boot is None:
            boot = self._boot_of_tables() if known.stations_from == "boot" else middle
        layout = Layout(
            tip=self._length - boot,
            tail=-boot,
            middle=middle - boot,
            sidecut_length=sidecut,
            running_length=known.running_length or running_share * sidecut,
        )
        return layout, width_of_table(StationTable(place - boot, width), layout)

    def _boot_of_tables(self) -> float:
        """Distance of the boot from the tail (m) where stations count from the boot and widths reach to the tail."""
        if self._width is None:
            raise ParameterError("The place of the boot is not known. Give --boot-mm, its distance from the tail.").tag(
                "missing"
            )
        return -float(self._width[0].min()) * MM

    def _from_tail(self, station_mm: FloatArray) -> FloatArray:
        """Distances from the tail (m)."""
        known = self._measured
        if known.stations_from is None:
            raise ParameterError("The origin of the stations is missing. Add --stations-from tip, tail or boot.").tag(
                "missing"
            )
        station = station_mm * MM
        if known.stations_from == "boot":
            return station + (known.boot if known.boot is not None else self._boot_of_tables())
        return station if known.stations_from == "tail" else self._length - station

    def _station_table(self, column: tuple[FloatArray, ...], unit: float, layout: Layout) -> StationTable:
        """Measured column in SI over the station, from tip to tail."""
        station = self._from_tail(column[0]) + layout.tail
        order = np.argsort(-station)
        return StationTable(station[order], column[1][order] * unit)

    def _stiffness(self, name: str, test: Sequence[str], layout: Layout) -> Stiffness | None:
        """Column of a stiffness from the table or from tests; None without both."""
        column, tests = self._column(name), self._column(*test)
        if column is not None and tests is not None:
            raise ParameterError("{name} is stated together with tests of it. Remove one of them.").tag(
                "contradiction", name=name
            )
        if column is not None:
            table = self._station_table(column, 1.0, layout)
            return Stiffness(table.station, table.value, np.full_like(table.value, np.nan))
        if tests is None:
            return None
        order = np.argsort(-self._from_tail(tests[0]))
        station = self._from_tail(tests[0])[order] + layout.tail
        span, load, reading = (values[order] for values in tests[1:])
        if not all((values > 0).all() for values in (span, load, reading)):
            raise ParameterError("a test of {name} has a length, load or reading of 0 or below. Correct it.").tag(
                "out_of_range", name=name
            )
        if test == BEND_TEST:
            reading, step = reading * MM, self._measured.dial_step
        else:
            reading, step = reading * DEGREE, self._measured.angle_step
        return stiffness_of_tests(
            station, span * MM, reading / load, step / math.sqrt(12.0) / load, bend=test == BEND_TEST
        )

    def _stiffness_along_ski(self, stiffness: Stiffness | None, name: str, layout: Layout) -> StationFunction:
        """Stiffness over the station: measured, or that of the similar ski, which is noted as assumed."""
        if stiffness is not None:
            return StationTable(stiffness.station, stiffness.value).at
        words = {"bending_stiffness": "EI", "torsional_stiffness": "GJ"}
        self._assumed.append(Message("{quantity} of {ski}", quantity=words[name], ski=self._like.name))
        return self._of_like(name, layout)

    def _of_like(self, name: str, layout: Layout) -> StationFunction:
        """Curve of the similar ski, moved with tail, contact points and tip to this layout."""
        like = self._like
        own = [layout.tail, *layout.contact_points[::-1], layout.tip]
        theirs = [like.station[-1], *like.contact_points[::-1], like.station[0]]
        table = getattr(like, name)
        return lambda station: np.interp(np.interp(station, own, theirs), like.station[::-1], table[::-1])


def stiffness_of_tests(
    station: FloatArray, span: FloatArray, compliance: FloatArray, error: FloatArray, *, bend: bool
) -> Stiffness:
    """EI or GJ (N m²) at the stations of bend or torsion tests, from 1/EI or 1/GJ linear between the stations.

    station, span: middle and length of each test (m), stations falling.
    compliance, error: deflection over load (m/N) or twist over moment (rad/(N m)), and its standard error.
    bend: True for three-point bend tests, False for torsion tests.
    Raises ParameterError: two tests have the same station, or the tests contradict each other: a compliance would be
        below 0.

    >>> ends = np.array([0.2, -0.2]), np.array([0.3, 0.3])
    >>> stiffness_of_tests(*ends, np.full(2, 0.3**3 / 48 / 250), np.zeros(2), bend=True).value.round(2)
    array([250., 250.])
    """
    rising = station[::-1]
    if np.any(np.diff(rising) <= 0):
        raise ParameterError("two tests have the same station. Give one of them, or their mean.").tag(
            "repeated", station=station
        )
    matrix = np.empty((len(station), len(station)))
    for row, (place, length) in enumerate(zip(station, span, strict=True)):
        x = np.linspace(place - length / 2.0, place + length / 2.0, _POINTS)
        weight = ((length / 2.0 - abs(x - place)) / 2.0) ** 2 if bend else np.ones_like(x)
        for at, unit in enumerate(np.eye(len(station))):
            matrix[row, at] = np.trapezoid(weight * np.interp(x, rising, unit[::-1]), x)
    inverse = np.linalg.inv(matrix)
    c = inverse @ compliance
    if not (c > 0).all():
        raise ParameterError(
            "the tests contradict each other near {place:.0f} mm from the boot: the stiffness there would be below 0. "
            "Check span, load and reading, or leave one of the neighbouring tests out."
        ).tag("contradiction", place=float(station[np.argmin(c)]) / MM)
    return Stiffness(station, 1.0 / c, np.sqrt((inverse**2) @ error**2) / c**2)
