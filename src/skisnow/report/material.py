"""What tables and figures are drawn from: the results with the campaign beside them, as columns."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ..estimate.observations import (
    DENSITY_KEY,
    HARDNESS_KEY,
    STRESS_KEY,
    Observations,
    penetration_observations,
    shear_observations,
    spot_observations,
)
from ..units import MM, N_PER_MM2, N_PER_MM3

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..field.records import Campaign

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
class Material:
    """Results and campaign; columns of the *used* experiments in the units that the report prints."""

    campaign: Campaign
    results: Json

    @property
    def synthetic(self) -> bool:
        """Whether the word *synthetic* must stand wherever the numbers do."""
        return is_synthetic(self.results["campaign"]["name"])

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
        return np.array([row["used"] for row in self.penetration], dtype=bool)

    @cached_property
    def shear_used(self) -> BoolArray:
        """Mask over the shear experiments."""
        return np.array([row["used"] for row in self.shear], dtype=bool)

    @cached_property
    def hardness(self) -> FloatArray:
        """H_V of the used penetration experiments (N/mm³)."""
        return numbers(self.penetration, HARDNESS_KEY)[self.penetration_used]

    @cached_property
    def hardness_interval(self) -> FloatArray:
        """(m, 2) N/mm³."""
        return pairs(self.penetration, "H_V_interval_N_per_mm3")[self.penetration_used]

    @cached_property
    def stress(self) -> FloatArray:
        """S_f of the used shear experiments (N/mm²)."""
        return numbers(self.shear, STRESS_KEY)[self.shear_used]

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
    def observations(self) -> dict[str, Observations]:
        """Used experiments with the snow they were made on, by penetration, shear and spots."""
        every_H = numbers(self.penetration, HARDNESS_KEY) * N_PER_MM3
        every_S = numbers(self.shear, STRESS_KEY) * N_PER_MM2
        first = penetration_observations(self.campaign, every_H, self.penetration_used)
        second = shear_observations(self.campaign, every_S, self.shear_used)
        return {"penetration": first, "shear": second, "spots": spot_observations(first, second)}

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
