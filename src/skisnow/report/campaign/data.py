"""Columns of an analysed campaign, for its tables, figures and sentences."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date, datetime
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ..._support.arrays import BoolArray, FloatArray
from ..._support.messages import Message, current_language, translated
from ..._support.units import N_PER_MM2, N_PER_MM3
from ...campaign.reading.columns import iso_moment
from ...campaign.records import Campaign
from ...estimation import Analysis
from ...estimation.hardness import Hardness, ShearStress
from ...estimation.parts import PenetrationAnalysis, ShearAnalysis
from ...estimation.regressions import DENSITY_KEY, Source
from ..formatting import counted, whole

TextArray: TypeAlias = npt.NDArray[np.str_]
Json: TypeAlias = dict[str, Any]


def is_synthetic(name: str) -> bool:
    """True if the name of a campaign marks its numbers as synthetic."""
    return "synthetic" in name.casefold()


def numbers(rows: Sequence[Json], key: str) -> FloatArray:
    """Numbers of one key in all rows, shape (n,); NaN for null."""
    return np.array([row[key] for row in rows], dtype=float)


def pairs(rows: Sequence[Json], key: str) -> FloatArray:
    """Intervals of one key in all rows, shape (n, 2); NaN for null."""
    missing = (np.nan, np.nan)
    return np.array([row[key] or missing for row in rows], dtype=float).reshape(-1, 2)


def texts(rows: Sequence[Json], key: str) -> TextArray:
    """Texts of one key in all rows, shape (n,)."""
    return np.array([row[key] for row in rows], dtype=object).astype(str)


@dataclass(frozen=True, slots=True)
class UsedTests:
    """Values of the n experiments of one kind (penetration or shear) that the estimates use, in units of the report.

    used: mask of them among all experiments of the kind.
    value, interval: H_V or S_f, and its 95 % intervals, shape (n, 2): NaN unless both ends are finite.
    density: snow density at each experiment (kg/m³), NaN if unknown.
    """

    used: BoolArray
    value: FloatArray
    interval: FloatArray
    site: TextArray
    density: FloatArray

    def __len__(self) -> int:
        return len(self.value)


@dataclass(frozen=True)
class ReportData:
    """Data of a campaign's report: an analysis, with values of its *used* experiments in the units of the report.

    Numbers for computations come from the analysis (SI); printed numbers come from its results.
    """

    analysis: Analysis

    @property
    def campaign(self) -> Campaign:
        """The analysed campaign."""
        return self.analysis.campaign

    @property
    def results(self) -> Json:
        """Results of the analysis by key, as in results.json."""
        return self.analysis.results

    @property
    def synthetic(self) -> bool:
        """True if every table and figure must be marked *synthetic*."""
        return is_synthetic(self.campaign.name)

    @property
    def penetration(self) -> list[Json]:
        """Rows of all penetration experiments."""
        rows: list[Json] = self.results["penetration"]["experiments"]
        return rows

    @property
    def shear(self) -> list[Json]:
        """Rows of all shear experiments."""
        rows: list[Json] = self.results["shear"]["experiments"]
        return rows

    @cached_property
    def pressed(self) -> UsedTests:
        """Values of the used penetration experiments; `value` is H_V (N/mm³)."""
        part = self.analysis.penetration
        return self._used_tests("penetration", N_PER_MM3, part, None if part is None else part.hardness["H_V"])

    @cached_property
    def sheared(self) -> UsedTests:
        """Values of the used shear experiments; `value` is S_f (N/mm²)."""
        part = self.analysis.shear
        return self._used_tests("shear", N_PER_MM2, part, None if part is None else part.stress)

    def _used_tests(
        self, kind: Source, unit: float, part: PenetrationAnalysis | ShearAnalysis | None,
        values: Hardness | ShearStress | None,
    ) -> UsedTests:  # fmt: skip
        """Used tests of a kind: values and 95 % intervals in `unit`, sites, densities; empty without an analysis."""
        density = self.analysis.observations[kind].columns[DENSITY_KEY]
        if part is None or values is None:
            return UsedTests(np.zeros(0, dtype=bool), np.zeros(0), np.zeros((0, 2)), np.zeros(0, dtype=str), density)
        used = part.screened.used
        ends = values.interval[used] / unit
        ends[~np.isfinite(ends).all(axis=1)] = np.nan
        site = texts(self.results[kind]["experiments"], "site")[used]
        return UsedTests(used, values.value[used] / unit, ends, site, density)

    @cached_property
    def seating(self) -> list[Json]:
        """Rows of the used penetration experiments with an estimated depth offset."""
        rows = zip(self.penetration, self.results["penetration"]["seating"], strict=True)
        return [test | seating for test, seating in rows if test["used"] and seating["depth_offset_mm"] is not None]

    @cached_property
    def unloaded(self) -> list[Json]:
        """Rows of all penetration experiments with readings during unloading."""
        return [row for row in self.penetration if row["n_unloading"]]

    @cached_property
    def sites(self) -> tuple[str, ...]:
        """Sites of all experiments in alphabetical order."""
        return tuple(sorted({row["site"] for row in self.penetration} | {row["site"] for row in self.shear}))

    @property
    def has_tests(self) -> bool:
        """True if the campaign has penetration or shear tests, not only samples and recordings."""
        return bool(self.penetration or self.shear)

    @property
    def counts(self) -> str:
        """Text, in the current language, with the numbers of experiments, samples, recordings and sites."""
        campaign, pressed, sheared = self.campaign, len(self.penetration), len(self.shear)
        tables = (campaign.density, campaign.drop_cone, campaign.snow_micro_pen)
        samples, cones, recordings = (0 if table is None else len(table.site) for table in tables)
        sites = set(self.sites).union(*(table.site for table in tables if table is not None))
        used_pressed, used_sheared = (
            str(Message(" ({used} used)", used=whole(sum(row["used"] for row in rows))))
            for rows in (self.penetration, self.shear)
        )
        press = counted(pressed, "{count} penetration experiment", "{count} penetration experiments")
        shear = counted(sheared, "{count} shear experiment", "{count} shear experiments")
        counts = (
            (pressed, press + used_pressed),
            (sheared, shear + used_sheared),
            (samples, counted(samples, "{count} density sample", "{count} density samples")),
            (cones, counted(cones, "{count} drop-cone reading", "{count} drop-cone readings")),
            (recordings, counted(recordings, "{count} recording", "{count} recordings")),
            (len(sites), counted(len(sites), "{count} site", "{count} sites")),
        )
        return ", ".join(words for count, words in counts if count)

    def regression(self, response: str, predictor: str) -> Json | None:
        """Result of the regression of `response` on `predictor` over all sites; None if it has no data."""
        names = (response, predictor, "all")
        rows = [row for row in self.results["regressions"] if (row["response"], row["terms"][1], row["group"]) == names]
        return rows[0] if rows and rows[0]["b"] is not None else None

    @property
    def dates(self) -> str | None:
        """The only date in the columns ``time``, or the first and last one, in words; None without one."""
        days: set[date] = set()
        for table in (self.campaign.penetration, self.campaign.shear, self.campaign.density, self.campaign.drop_cone):
            moments = map(iso_moment, set(table.further.get("time", ())) if table is not None else ())
            days |= {datetime.fromisoformat(moment).date() for moment in moments if moment and "-" in moment}
        if len(days) < 2:
            return translated(min(days), current_language()) if days else None
        return Message("{low} to {high}", low=min(days), high=max(days))
