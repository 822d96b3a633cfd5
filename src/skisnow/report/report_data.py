"""What tables and figures are drawn from: an analysis as columns."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ..estimate.observations import DENSITY_KEY
from ..field import QUALITY_FLAGS
from ..units import MM, N_PER_MM2, N_PER_MM3

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..estimate import Analysis
    from ..estimate.observations import Observations
    from ..estimate.regressions import Source
    from ..field.records import Campaign
    from ..geometry import GeometryForm

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
TextArray: TypeAlias = npt.NDArray[np.str_]
Json: TypeAlias = dict[str, Any]

_DATE = re.compile(r"\d{4}-\d{2}-\d{2}")


def is_synthetic(name: str) -> bool:
    """Whether a campaign says by its name that its numbers were not measured."""
    return "synthetic" in name.casefold()


def numbers(rows: Sequence[Json], key: str) -> FloatArray:
    """A column of the results; NaN where it is null."""
    return np.array([row[key] for row in rows], dtype=float)


def pairs(rows: Sequence[Json], key: str) -> FloatArray:
    """A column of intervals, (n, 2); NaN where it is null."""
    nothing = (np.nan, np.nan)
    return np.array([row[key] or nothing for row in rows], dtype=float).reshape(-1, 2)


def texts(rows: Sequence[Json], key: str) -> TextArray:
    """A column of names."""
    return np.array([row[key] for row in rows], dtype=object).astype(str)


@dataclass(frozen=True)
class ReportData:
    """An analysis with columns of its *used* experiments in the units that the report prints.

    What is computed with comes from the analysis, in SI; what is printed as it stands comes from its results.
    """

    analysis: Analysis

    @property
    def campaign(self) -> Campaign:
        """What was analysed."""
        return self.analysis.campaign

    @property
    def results(self) -> Json:
        """The contents of results.json."""
        return self.analysis.results

    @property
    def geometry(self) -> GeometryForm:
        """In which form the tools count."""
        return self.analysis.geometry

    @property
    def synthetic(self) -> bool:
        """Whether the word *synthetic* must stand wherever the numbers do."""
        return is_synthetic(self.campaign.name)

    @cached_property
    def names(self) -> frozenset[str]:
        """What the users of the campaign wrote, and codes: no words that another language has others for."""
        campaign = self.campaign
        tests = [each.experiment for each in (campaign.penetration, campaign.shear) if each is not None]
        written = (campaign.name, campaign.place, *campaign.observers, *self.sites, *campaign.tools, *campaign.plates)
        return frozenset((*written, *QUALITY_FLAGS, *(name for each in tests for name in each)))

    @property
    def penetration(self) -> list[Json]:
        """Rows of the penetration experiments, used or not."""
        rows: list[Json] = self.results["penetration"]["experiments"]
        return rows

    @property
    def shear(self) -> list[Json]:
        """Rows of the shear experiments, used or not."""
        rows: list[Json] = self.results["shear"]["experiments"]
        return rows

    @cached_property
    def penetration_used(self) -> BoolArray:
        """Mask over the penetration experiments."""
        found = self.analysis.penetration
        return np.zeros(0, dtype=bool) if found is None else found.screened.used

    @cached_property
    def shear_used(self) -> BoolArray:
        """Mask over the shear experiments."""
        found = self.analysis.shear
        return np.zeros(0, dtype=bool) if found is None else found.screened.used

    @cached_property
    def hardness(self) -> FloatArray:
        """H_V of the used penetration experiments (N/mm³)."""
        found = self.analysis.penetration
        return np.zeros(0) if found is None else found.hardness["H_V"].value[self.penetration_used] / N_PER_MM3

    @cached_property
    def hardness_interval(self) -> FloatArray:
        """(m, 2) N/mm³, NaN where it is not known at both ends."""
        found = self.analysis.penetration
        every = np.zeros((0, 2)) if found is None else found.hardness["H_V"].interval
        return _known(every[self.penetration_used] / N_PER_MM3)

    @cached_property
    def stress(self) -> FloatArray:
        """S_f of the used shear experiments (N/mm²)."""
        found = self.analysis.shear
        return np.zeros(0) if found is None else found.stress.value[self.shear_used] / N_PER_MM2

    @cached_property
    def stress_interval(self) -> FloatArray:
        """(n, 2) N/mm², NaN where it is not known at both ends."""
        found = self.analysis.shear
        every = np.zeros((0, 2)) if found is None else found.stress.interval
        return _known(every[self.shear_used] / N_PER_MM2)

    @cached_property
    def shear_angle(self) -> FloatArray:
        """Edge angle of the used shear experiments (rad)."""
        tests = self.campaign.shear
        return np.zeros(0) if tests is None else tests.edge_angle[self.shear_used]

    @cached_property
    def shear_depth(self) -> FloatArray:
        """Plate depth e of the used shear experiments (mm)."""
        tests = self.campaign.shear
        return np.zeros(0) if tests is None else tests.penetration_depth[self.shear_used] / MM

    @cached_property
    def penetration_site(self) -> TextArray:
        """Site of each used penetration experiment."""
        return texts(self.penetration, "site")[self.penetration_used]

    @cached_property
    def shear_site(self) -> TextArray:
        """Site of each used shear experiment."""
        return texts(self.shear, "site")[self.shear_used]

    @cached_property
    def seating(self) -> list[Json]:
        """Seating of the used penetration experiments that have one, each with its experiment's own row."""
        rows = zip(self.penetration, self.results["penetration"]["seating"], strict=True)
        return [own | found for own, found in rows if own["used"] and found["depth_offset_mm"] is not None]

    @cached_property
    def unloaded(self) -> list[Json]:
        """Rows of the penetration experiments, used or not, that were read while discs were taken off."""
        return [row for row in self.penetration if row["n_unloading"]]

    @property
    def observations(self) -> Mapping[Source, Observations]:
        """Used experiments with the snow they were made on, by penetration, shear and spots."""
        return self.analysis.observations

    @property
    def penetration_density(self) -> FloatArray:
        """Density at each used penetration experiment (kg/m³), NaN where it is not known."""
        return self.observations["penetration"].columns[DENSITY_KEY]

    @property
    def shear_density(self) -> FloatArray:
        """Density at each used shear experiment (kg/m³), NaN where it is not known."""
        return self.observations["shear"].columns[DENSITY_KEY]

    @cached_property
    def sites(self) -> tuple[str, ...]:
        """All sites with an experiment, used or not, in alphabetical order."""
        return tuple(sorted({row["site"] for row in self.penetration} | {row["site"] for row in self.shear}))

    def regression(self, response: str, predictor: str, group: str = "all") -> Json | None:
        """The entry of one regression; None where there is none with data."""
        for row in self.results["regressions"]:
            if row["response"] == response and row["terms"][1] == predictor and row["group"] == group:
                return row if row["b"] is not None else None
        return None

    @cached_property
    def dates(self) -> tuple[str, str] | None:
        """First and last day in the columns ``time``, where they are written year first."""
        found: set[str] = set()
        for table in (self.campaign.penetration, self.campaign.shear, self.campaign.density, self.campaign.drop_cone):
            cells = set(table.further.get("time", ())) if table is not None else set()
            found |= {match[0] for cell in cells if (match := _DATE.match(cell.strip()))}
        return (min(found), max(found)) if found else None


def _known(intervals: FloatArray) -> FloatArray:
    whole = np.isfinite(intervals).all(axis=1, keepdims=True)
    return np.where(whole, intervals, np.nan)
