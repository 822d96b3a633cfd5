"""Records of a field campaign in SI, stored as columns.

Records are columns because a campaign can have a million readings. ``PenetrationTests.series(i)`` is a single
experiment.
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

import numpy as np

from .._support.arrays import BoolArray, FloatArray, IntArray
from .._support.units import DEGREE, MM, Facts, Shown, ShownFields, amount, ends
from .problems import AppliedCorrection, Problem
from .reading.campaign_file import Description
from .smet import CampaignWeather
from .snow_micro_pen import SnowMicroPenRecordings

Key = TypeVar("Key", bound="Hashable")


@dataclass(frozen=True, slots=True, repr=False)
class PenetrationSeries(ShownFields):
    """One penetration experiment: a tool at one edge angle under rising loads.

    experiment, site, tool: names as written in the file.
    edge_angle: ϑ in rad.
    load, penetration_depth: F in N and e in m, one per load step in the order of loading.
    """

    experiment: str
    site: str
    tool: str
    edge_angle: float
    load: FloatArray
    penetration_depth: FloatArray


class _Readings(ShownFields):
    """Base of readings of m experiments in arrays, one experiment after the other, with m + 1 offsets `first`."""

    __slots__ = ()
    first: IntArray

    @property
    def series_of_reading(self) -> IntArray:
        """Index of the experiment that each reading belongs to."""
        return np.repeat(np.arange(len(self.first) - 1, dtype=np.int64), np.diff(self.first))


@dataclass(frozen=True, slots=True, repr=False)
class UnloadingReadings(_Readings):
    """Readings during unloading, series after series, each in the order of reading.

    first: m + 1 offsets: readings ``first[i]:first[i + 1]`` belong to experiment i, which may have none.
    load, penetration_depth: remaining load F (N) and depth e (m), one per reading.
    row: line of the file of each reading.
    """

    first: IntArray
    load: FloatArray
    penetration_depth: FloatArray
    row: IntArray

    @property
    def count(self) -> IntArray:
        """Number of readings of each experiment."""
        return np.diff(self.first)


@dataclass(frozen=True, slots=True, repr=False)
class PenetrationTests(_Readings):
    """All m penetration experiments of a campaign, n readings under rising loads in the order of the file.

    experiment, site, tool, spot: names, one per experiment; an absent spot is ``""``.
    edge_angle: ϑ in rad, one per experiment.
    snow_density, drop_cone_depth: density ρ (kg/m³) and drop-cone depth H_p (m) of the experiment, the mean of its
        rows; NaN if missing.
    cancelled: reason for cancelling the experiment, or ``""``.
    first: m + 1 offsets: readings ``first[i]:first[i + 1]`` belong to experiment i.
    load, penetration_depth: F in N and e in m, one per reading.
    row: line of the file of each reading; the header is line 1.
    further: other columns of the file as text, one cell per reading; they are not interpreted.
    unloading: readings during unloading, which are not used for hardness (optional).
    depth_after: e (m) read again under the same load after waiting, one per reading; NaN if missing (optional).
    """

    experiment: tuple[str, ...]
    site: tuple[str, ...]
    tool: tuple[str, ...]
    spot: tuple[str, ...]
    edge_angle: FloatArray
    snow_density: FloatArray
    drop_cone_depth: FloatArray
    cancelled: tuple[str, ...]
    first: IntArray
    load: FloatArray
    penetration_depth: FloatArray
    row: IntArray
    further: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    unloading: UnloadingReadings | None = None
    depth_after: FloatArray | None = None

    def __len__(self) -> int:
        """Count the experiments."""
        return len(self.experiment)

    def _repr_facts(self) -> Facts:
        """Title with the counts, and rows with sites, tools and ranges, for the representation."""
        rows = (
            ("sites", _name_list(self.site)),
            ("tools", _name_list(self.tool)),
            ("edge angles", ends(self.edge_angle, "°", factor=DEGREE)),
            ("loads", ends(self.load, "N")),
            ("depths", ends(self.penetration_depth, "mm", factor=MM)),
        )
        return Facts(f"of {len(self)} experiments, {len(self.load)} readings", rows)

    def series(self, index: int) -> PenetrationSeries:
        """One experiment by its index."""
        part = slice(int(self.first[index]), int(self.first[index + 1]))
        return PenetrationSeries(
            experiment=self.experiment[index],
            site=self.site[index],
            tool=self.tool[index],
            edge_angle=float(self.edge_angle[index]),
            load=self.load[part],
            penetration_depth=self.penetration_depth[part],
        )


@dataclass(frozen=True, slots=True, repr=False)
class TurningReadings(_Readings):
    """Moments over turning angles of the shear experiments, test after test, each in the order of reading.

    first: m + 1 offsets: readings ``first[i]:first[i + 1]`` belong to experiment i, which may have none.
    turning_angle, moment: φ (rad) from any zero, and M (N m), one per reading.
    """

    first: IntArray
    turning_angle: FloatArray
    moment: FloatArray


@dataclass(frozen=True, slots=True, repr=False)
class ShearTests(Shown):
    """All shear experiments of a campaign; an experiment with several rows has the values of its largest moment.

    experiment, site, plate, spot, cancelled, further: as in `PenetrationTests`.
    edge_angle, penetration_depth, lever_arm, moment: ϑ (rad), e (m), r (m), M (N m).
    snow_density, drop_cone_depth: ρ (kg/m³) and H_p (m) of the experiment; NaN if missing.
    row: line of the file.
    turning: moments over turning angles (optional).
    """

    experiment: tuple[str, ...]
    site: tuple[str, ...]
    plate: tuple[str, ...]
    spot: tuple[str, ...]
    edge_angle: FloatArray
    penetration_depth: FloatArray
    lever_arm: FloatArray
    moment: FloatArray
    snow_density: FloatArray
    drop_cone_depth: FloatArray
    cancelled: tuple[str, ...]
    row: IntArray
    further: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    turning: TurningReadings | None = None

    def __len__(self) -> int:
        """Count the experiments."""
        return len(self.experiment)

    def _repr_facts(self) -> Facts:
        """Title with the count, and rows with sites, plates and ranges, for the representation."""
        rows = (
            ("sites", _name_list(self.site)),
            ("plates", _name_list(self.plate)),
            ("edge angles", ends(self.edge_angle, "°", factor=DEGREE)),
            ("depths", ends(self.penetration_depth, "mm", factor=MM)),
            ("lever arms", ends(self.lever_arm, "mm", factor=MM)),
            ("moments", ends(self.moment, "N m")),
        )
        return Facts(f"of {len(self)} experiments", rows)


@dataclass(frozen=True, slots=True, repr=False)
class DensitySamples(Shown):
    """Samples of a density cutter: ρ (kg/m³), depth of the sample's middle and its thickness (m), or NaN.

    ``further`` as in `PenetrationTests`.
    """

    sample: tuple[str, ...]
    site: tuple[str, ...]
    snow_density: FloatArray
    sample_depth: FloatArray
    sample_thickness: FloatArray
    cancelled: tuple[str, ...]
    row: IntArray
    further: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def _repr_facts(self) -> Facts:
        """Title with the count, the range of densities and the sites, for the representation."""
        return Facts(f"of {len(self.sample)} samples: {ends(self.snow_density, 'kg/m³')}; {_name_list(self.site)}")

    def site_means(self) -> dict[str, float]:
        """Mean density of each site's samples that were not cancelled (kg/m³)."""
        return _means_by_key(self.site, self.snow_density, self.cancelled)

    @property
    def in_profile(self) -> BoolArray:
        """Mask of the samples that have a depth and were not cancelled."""
        return np.isfinite(self.sample_depth) & (np.array(self.cancelled) == "")


@dataclass(frozen=True, slots=True, repr=False)
class DropConeTests(Shown):
    """Repeats of a drop-cone test: depth H_p in m, larger is *softer*. A test is the mean of its repeats."""

    test: tuple[str, ...]
    site: tuple[str, ...]
    repeat: tuple[str, ...]
    drop_cone_depth: FloatArray
    cancelled: tuple[str, ...]
    row: IntArray
    further: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def _repr_facts(self) -> Facts:
        """Title with the count, the range of depths and the sites, for the representation."""
        return Facts(
            f"of {len(self.test)} repeats: {ends(self.drop_cone_depth, 'mm', factor=MM)}; {_name_list(self.site)}"
        )

    def site_means(self) -> dict[str, float]:
        """Mean over each site's tests of the mean over their repeats (m), without cancelled tests."""
        tests = list(zip(self.site, self.test, strict=True))
        gone = {test for test, why in zip(tests, self.cancelled, strict=True) if why}
        cancelled = tuple("cancelled" if test in gone else "" for test in tests)
        means = _means_by_key(tests, self.drop_cone_depth, cancelled)
        return _means_by_key([site for site, _ in means], np.array(list(means.values())), ("",) * len(means))


def _name_list(names: Sequence[str]) -> str:
    """Different names in their order, separated by commas."""
    return ", ".join(dict.fromkeys(names))


def _means_by_key(keys: Sequence[Key], values: FloatArray, cancelled: Sequence[str]) -> dict[Key, float]:
    """Mean of the values with the same key; cancelled ones, which have a reason, are left out."""
    collected: dict[Key, list[float]] = {}
    for key, value, why in zip(keys, values.tolist(), cancelled, strict=True):
        if not why:
            collected.setdefault(key, []).append(value)
    return {key: math.fsum(items) / len(items) for key, items in collected.items()}


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Campaign(Shown, Description):
    """A valid campaign with its corrections applied; fields from campaign.toml as in its base `Description`.

    folder: folder from which it was read.
    penetration, shear, density, drop_cone, snow_micro_pen: the tables; None without such a file.
    problems: warnings from reading the files.
    file_hashes: SHA-256 of each file that was read, by name.
    corrections: applied corrections, in the order of corrections.csv.
    unread_files: names of files in the folder that are not part of a campaign.
    weather: readings of a weather station (optional).
    places: workbook and sheet of tables that are sheets of a workbook, by the name of the file.

    See Also
    --------
    skisnow.read_campaign
    """

    name: str
    folder: Path
    penetration: PenetrationTests | None
    shear: ShearTests | None
    density: DensitySamples | None
    drop_cone: DropConeTests | None
    problems: tuple[Problem, ...]
    file_hashes: Mapping[str, str]
    corrections: tuple[AppliedCorrection, ...] = ()
    unread_files: tuple[str, ...] = ()
    places: Mapping[str, str] = field(default_factory=dict)
    snow_micro_pen: SnowMicroPenRecordings | None = None
    weather: CampaignWeather | None = None

    def _repr_facts(self) -> Facts:
        """Name as title, and rows with place, counts, gauge step and warnings, for the representation."""
        tables = {"penetration": self.penetration, "shear": self.shear, "density": self.density, "cone": self.drop_cone}
        counts = [(name, "none" if table is None else table._repr_facts().title) for name, table in tables.items()]
        gauge = "not stated" if self.gauge_resolution is None else amount(self.gauge_resolution / MM, "mm")
        rows = (
            ("place", self.place or "not stated"),
            *counts,
            ("gauge step", gauge),
            ("warnings", str(len(self.problems))),
        )
        return Facts(f"{self.name!r}", rows)

    @property
    def depth_uncertainty(self) -> float | None:
        """Standard uncertainty of one depth reading from the gauge's step: step/√12 (m)."""
        return None if self.gauge_resolution is None else self.gauge_resolution / 12.0**0.5
