"""What the pairs say: how often tracks part, where, and how likely the published pair of numbers is."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from scipy.stats import binomtest

from skisnow._support.processes.kept_rows import Row
from skisnow._support.units import DEGREE, N_PER_MM2, N_PER_MM3
from skisnow.scenario import Scenario, load_scenario
from skisnow.statistics import VarianceShares, variance_shares
from skisnow.studies import read_table

from .pairs import CONTACTS, PARTED, SCENARIOS, Pairs, varied_ski
from .unknowns import UNKNOWNS

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

LENGTHS: Final = {"carver-42m": 42.0, "giant-slalom-67m": 67.0}
PUBLISHED: Final = {"carver-42m": (0.14, 7.5), "giant-slalom-67m": (0.44, 0.6)}
"""Largest distance (m) of the hypoplastic and of the elastic run from the measured track (Mössner and others 2013)."""


RATIOS: Final = (0.0, 0.5, 2.0, 10.0, np.inf)
"""Limits of classes of the side force that is needed over the one that elastic snow can give."""
HELD: Final = 0.05
"""A ski that side-slips in no larger share of the time keeps its grip, as the report of a turn has it."""
REGIMES: Final = ("nobody", "the hypoplastic run", "the elastic run", "both")


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """Pairs of one ski, of which the hypoplastic run covers the published length.

    Attributes
    ----------
    rows
        Of the table, `n` of them.
    asked
        How many pairs were computed in all.
    apart
        Largest distance (m), (n,); NaN where the elastic run does not cover the length.
    length
        Of the run (m).
    """

    scenario: str
    rows: list[Row]
    asked: int
    apart: FloatArray
    length: float

    @property
    def complete(self) -> BoolArray:
        """Whether the elastic run covers the length, too."""
        return np.isfinite(self.apart)

    @property
    def share(self) -> FloatArray:
        """Distance in parts of the length, of the complete ones."""
        return self.apart[self.complete] / self.length

    def column(self, name: str) -> FloatArray:
        """Of the complete ones."""
        return np.array([row[name] for row, there in zip(self.rows, self.complete, strict=True) if there], dtype=float)

    @property
    def published_range(self) -> tuple[float, float]:
        """Between which distances (m) the two runs were, if both distances from the measured track are at one place."""
        plastic, elastic = PUBLISHED[self.scenario]
        return abs(elastic - plastic), elastic + plastic

    def shares(self) -> VarianceShares:
        """Of log₁₀ of the distance, by the unknowns."""
        inputs = np.column_stack([
            np.log(self.column(each.name)) if each.log else self.column(each.name) for each in UNKNOWNS
        ])  # fmt: skip
        return variance_shares(np.log10(np.maximum(self.apart[self.complete], 1e-3)), inputs)


def found(rows: Sequence[Row]) -> dict[str, Found]:
    """By scenario."""
    result = {}
    for name in SCENARIOS:
        own = [row for row in rows if row["scenario"] == name]
        held = [row for row in own if row["apart_m"] is not None]
        apart = np.array([row["apart_m"] if row["outcome"] == "complete" else np.nan for row in held], dtype=float)
        result[name] = Found(name, held, len(own), apart, LENGTHS[name])
    return result


def read_rows(folder: Path) -> list[Row]:
    """Of all parts that are complete."""
    keys = Pairs().keys
    return [row for path in sorted(folder.glob("*.csv")) for row in read_table(path, keys).rows]


@functools.cache
def _scenario(name: str) -> Scenario:
    return load_scenario(name)


def demand_and_strength(row: Row) -> tuple[float, float]:
    """Side force (N) that the turn needs, and the largest that its two skis draw on elastic snow.

    Needed: m (v²/R + g sin α) at the start's speed, R = R_sc cos ϑ; drawn: 2 S_f² L/H_V for each ski, a rigid edge in
    balance, twice that on snow that keeps its groove (the page docs/methods/carved-turn.md).
    """
    base = _scenario(row["scenario"])
    ski = varied_ski(base.ski, stiffness=row["stiffness_factor"], sidecut=row["sidecut_factor"])
    mass = row["sledge.mass_kg"] + 2.0 * ski.mass
    radius = ski.sidecut_radius_of_edge_line * np.cos(row["sledge.edge_angle_deg"] * DEGREE)
    slope = base.gravity * np.sin(row["slope.angle_deg"] * DEGREE)
    needed = mass * (row["start.speed_m_per_s"] ** 2 / radius + slope)
    stress, hardness = row["snow.S_f_N_per_mm2"] * N_PER_MM2, row["snow.H_V_N_per_mm3"] * N_PER_MM3
    return float(needed), float(4.0 * stress**2 * ski.running_length / hardness)


def regime(row: Row) -> str:
    """Who side-slips for more than 5 % of the time."""
    elastic, plastic = (float(row[f"{contact}_slips"] or 0.0) > HELD for contact in CONTACTS)
    return REGIMES[2 * elastic + plastic]


def likelihood(count: int, of: int) -> str:
    """A count with Clopper and Pearson's 95 % interval, in words."""
    if not of:
        return "0 of 0"
    ends = binomtest(count, of).proportion_ci(0.95, method="exact")
    return f"{count} of {of}, {100 * count / of:.1f} % ({100 * ends.low:.1f} to {100 * ends.high:.1f} %)"


def both_published(pairs: dict[str, Found]) -> tuple[int, int]:
    """Of points with both pairs complete: at how many the carver's parts by the published distance or more, the giant
    slalom's by no more than its own."""
    common = _common(pairs)
    least, most = (each.published_range[place] for place, each in enumerate(pairs.values()))
    return sum(carver >= least and giant <= most for carver, giant in common), len(common)


def _common(pairs: dict[str, Found]) -> list[tuple[float, float]]:
    """Distances (m) of both pairs at the points at which both are complete."""
    carver, giant = (
        {point(row): far for row, far in zip(each.rows, each.apart, strict=True) if np.isfinite(far)}
        for each in pairs.values()
    )
    return [(carver[key], giant[key]) for key in carver.keys() & giant.keys()]


def point(row: Row) -> tuple[Any, ...]:
    """The unknowns of a row."""
    return tuple(row[each.name] for each in UNKNOWNS)


def numbers(pairs: dict[str, Found]) -> dict[str, str]:
    """For the sentences of docs/validation/measured.md."""
    count, of = both_published(pairs)
    told = {
        "pairs": str(sum(each.asked for each in pairs.values())),
        "both published": likelihood(count, of),
        "giant less": likelihood(sum(giant < carver for carver, giant in _common(pairs)), of),
    }
    for name, each in pairs.items():
        ski, far = name.partition("-")[0], each.apart[each.complete]
        parted = each.share > PARTED
        outside = each.column("outside_m")[parted] > 0.0
        low, high = each.published_range
        told |= {
            f"{ski} asked": str(each.asked),
            f"{ski} parted": likelihood(int(parted.sum()), len(parted)),
            f"{ski} inside": likelihood(int((~outside).sum()), len(outside)),
            f"{ski} failed": likelihood(int((~each.complete).sum()), len(each.rows)),
            f"{ski} largest": f"{far.max():.1f}",
            f"{ski} largest percent": f"{100 * each.share.max():.0f}",
            f"{ski} beyond": likelihood(int((far >= low).sum()), len(far)),
            f"{ski} below": likelihood(int((far <= high).sum()), len(far)),
        }
    return told


def tables(pairs: dict[str, Found]) -> dict[str, str]:
    """Tables of docs/validation/measured.md."""
    return {
        "unknowns": _unknowns_table(),
        "outcomes": _outcomes_table(pairs),
        "ratios": _ratios_table(pairs),
        "regimes": _regimes_table(pairs),
        "shares": _shares_table(pairs),
    }


def _unknowns_table() -> str:
    rows = [
        (f"`{each.name}`" if "." in each.name else each.name.replace("_", " "), f"{each.low:g} to {each.high:g}",
         "logarithm" if each.log else "value", each.origin)
        for each in UNKNOWNS
    ]  # fmt: skip
    return _table(("unknown", "range", "even in its", "origin"), rows, words=4)


def _outcomes_table(pairs: dict[str, Found]) -> str:
    rows = []
    for name, each in pairs.items():
        quantiles = 100.0 * np.quantile(each.share, [0.5, 0.9, 1.0])
        parted = int((each.share > PARTED).sum())
        rows.append((
            f"`{name}`", str(each.asked), str(len(each.rows)), str(int(each.complete.sum())), str(parted),
            str(int((each.share > 0.05).sum())), *(f"{value:.2g}" for value in quantiles),
        ))  # fmt: skip
    head = (
        "scenario", "pairs", "hypoplastic run covers the length", "elastic run, too", "apart by more than 1 %",
        "more than 5 %", "median (%)", "90 % quantile (%)", "largest (%)",
    )  # fmt: skip
    return _table(head, rows, words=1)


def _ratios_table(pairs: dict[str, Found]) -> str:
    rows = []
    for name, each in pairs.items():
        ratio = np.array([needed / drawn for needed, drawn in map(demand_and_strength, each.rows)])
        for low, high in pairwise(RATIOS):
            inside = (low <= ratio) & (ratio < high)
            share = each.share[inside[each.complete]]
            if share.size:
                words = (
                    f"below {high:g}" if low == 0.0 else f"above {low:g}" if np.isinf(high) else f"{low:g} to {high:g}"
                )
                rows.append((
                    f"`{name}`", words, str(int(inside.sum())), str(int((inside & ~each.complete).sum())),
                    str(int((share > PARTED).sum())), f"{100 * np.median(share):.2g}", f"{100 * share.max():.2g}",
                ))  # fmt: skip
    head = (
        "scenario", "needed / elastic strength", "pairs", "elastic run does not cover the length", "parted",
        "apart, median (%)", "largest (%)",
    )  # fmt: skip
    return _table(head, rows, words=2)


def _regimes_table(pairs: dict[str, Found]) -> str:
    rows = []
    for name, each in pairs.items():
        own = [regime(row) for row, there in zip(each.rows, each.complete, strict=True) if there]
        outside = each.column("outside_m") > 0.0
        for word in REGIMES:
            inside = np.array([one == word for one in own], dtype=bool)
            if inside.any():
                parted = inside & (each.share > PARTED)
                rows.append((
                    f"`{name}`", word, str(int(inside.sum())), f"{100 * np.median(each.share[inside]):.2g}",
                    f"{100 * each.share[inside].max():.2g}", f"{int(parted.sum())}", f"{int((parted & outside).sum())}",
                ))  # fmt: skip
    head = ("scenario", "who side-slips", "pairs", "apart, median (%)", "largest (%)", "parted", "elastic run outside")
    return _table(head, rows, words=2)


def _shares_table(pairs: dict[str, Found]) -> str:
    shares = {name: each.shares() for name, each in pairs.items()}
    rows = []
    for place, unknown in enumerate(UNKNOWNS):
        cells = (
            f"{100 * one.share[place]:.0f} ({100 * one.interval[place, 0]:.0f} to {100 * one.interval[place, 1]:.0f})"
            for one in shares.values()
        )
        rows.append((f"`{unknown.name}`" if "." in unknown.name else unknown.name.replace("_", " "), *cells))
    rows.append(("left over", *(f"{100 * one.left:.0f}" for one in shares.values())))
    return _table(("share of the variance of log distance (%)", *shares), rows, words=1)


def _table(head: Sequence[str], rows: Sequence[Sequence[str]], *, words: int) -> str:
    """Markdown; the first `words` columns are words, the others numbers."""
    lines = [f"| {' | '.join(head)} |", f"| {' | '.join(['---'] * words + ['---:'] * (len(head) - words))} |"]
    return "\n".join(lines + [f"| {' | '.join(row)} |" for row in rows])
