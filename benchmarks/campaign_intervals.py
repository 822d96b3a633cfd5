"""Coverage of the intervals of H_V, k_u/H_V, Eqn 1 and b in simulated campaigns: ``python -m
benchmarks.campaign_intervals FOLDER``.

Each case writes one JSON file into the folder after every block of campaigns. A second call continues there.
``--table`` prints the Markdown table of docs/validation/reference-campaign.md from the files.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import numpy.typing as npt

from skisnow._support.units import MM
from skisnow.campaign import ReferenceCampaign, ReferenceNoise, reference_campaign
from skisnow.campaign.records import PenetrationTests
from skisnow.campaign.reference import design
from skisnow.estimation.campaign_model import CampaignModel, fit_campaign
from skisnow.estimation.errors_in_depth import volume_factor
from skisnow.estimation.hardness import DEFINITIONS, hardness, hardness_at_largest_load
from skisnow.estimation.readings import Readings, readings_of
from skisnow.estimation.screening import reading_uncertainty
from skisnow.estimation.spread_groups import fit_in_groups
from skisnow.estimation.unloading import unloading

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

HALF_AS_MUCH_AGAIN = 2.0 * math.log(1.5) / (math.log(design.LOADS[-1] / design.LOADS[0]) - math.log(1.5))
"""κ of the layering for which F/V grows by half from the smallest load to the largest."""
CLEAN: dict[str, Any] = {"depth_scatter": 0.02, "layering_sd": 0.15, "depths_grow": False}
"""Errors that the priors were chosen with; those of the reference campaign are larger."""
SNOWS: dict[str, dict[str, Any]] = {
    "even": CLEAN | {"layering_sd": 0.0},
    "layered": CLEAN,
    "harder": CLEAN | {"layering_mean": HALF_AS_MUCH_AGAIN, "layering_sd": 0.0},
    "ice": CLEAN,
    "reference": {},
}
SEATINGS_MM = (0.0, 0.02, 0.05)
RATIOS = (2.0, 5.0, 10.0, 50.0)
SIZES = ("1", "2", "5", "10")
FIRST_SEED = 300_000
"""Apart from the seeds that the priors were chosen with (0 to 8100) and those of the tests."""
BLOCK = 50
NOISIER = 4.0
ICE = "site H"


@dataclass(frozen=True)
class Case:
    """Simulated campaigns: the snow, the errors, k_u/H_V, and the series of each campaign.

    ``size`` is ``all``, ``site`` (each site is a campaign), or a number of series of one site. ``noisy`` are the sites
    whose seating and scatter are four times as large, or ``half`` for every other series.
    """

    snow: str
    seating_mm: float
    ratio: float
    size: str = "all"
    noisy: tuple[str, ...] = ()
    noise: tuple[tuple[str, float], ...] = ()

    @property
    def name(self) -> str:
        """Name of the file."""
        parts = [self.snow, f"seating{self.seating_mm:g}", f"ratio{self.ratio:g}", self.size]
        parts += [f"{key}{value:g}" for key, value in self.noise]
        return "_".join(parts + (["noisy", *(name[-1] for name in self.noisy)] if self.noisy else []))


def cases(group: str) -> Iterator[Case]:
    """The cases of a group."""
    if group == "main":
        yield from (
            Case(snow, d, k, "site" if snow == "ice" else "all")
            for snow in list(SNOWS)[:4]
            for d in SEATINGS_MM
            for k in RATIOS
        )
    elif group == "reference":
        yield from (Case("reference", d, k) for d in SEATINGS_MM for k in RATIOS)
    elif group == "small":
        yield from (Case("layered", d, k, size) for size in SIZES for d in (0.0, 0.05, 0.1) for k in (2.0, 10.0))
    elif group == "noisy":
        sites = tuple(site.name for site in design.PENETRATION_SITES)
        for noisy in (sites[:4], sites[4:], sites[::2], ("half",)):
            yield Case("layered", 0.02, 10.0, noisy=noisy)
    else:
        raise SystemExit(f"unknown group {group!r}. Allowed: main, small, noisy, reference")


@dataclass
class Tally:
    """Counts of one quantity: intervals, those that contain the truth, series without one, and half widths."""

    n: int = 0
    inside: int = 0
    lost: int = 0
    half: list[float] = field(default_factory=list)

    def add(self, error: FloatArray, half: FloatArray) -> None:
        """Add the errors of estimates with half of their intervals."""
        known = np.isfinite(error) & np.isfinite(half)
        self.n += int(known.sum())
        self.inside += int((np.abs(error[known]) <= half[known]).sum())
        self.lost += int((~known).sum())
        if known.any():
            self.half.append(float(np.median(half[known])))


def drawn_campaign(case: Case, seed: int) -> tuple[ReferenceCampaign, PenetrationTests]:
    """The campaign, and its penetration tests with the noisier series of the case."""
    changes: dict[str, Any] = SNOWS[case.snow] | dict(case.noise)
    noise = replace(ReferenceNoise(), seating_sd=case.seating_mm * MM, **changes)
    with mock.patch.object(design, "UNLOADING_RATIO", case.ratio):
        drawn = reference_campaign(seed, noise=noise)
        if not case.noisy:
            return drawn, drawn.penetration
        worse = replace(noise, seating_sd=NOISIER * noise.seating_sd, depth_scatter=NOISIER * noise.depth_scatter)
        tests, other = drawn.penetration, reference_campaign(seed, noise=worse).penetration
    chosen = np.arange(len(tests)) % 2 == 0 if case.noisy == ("half",) else np.isin(tests.site, case.noisy)
    depth = np.where(chosen[tests.series_of_reading], other.penetration_depth, tests.penetration_depth)
    back, worse_back = tests.unloading, other.unloading
    assert back is not None
    assert worse_back is not None
    returned = np.where(chosen[back.series_of_reading], worse_back.penetration_depth, back.penetration_depth)
    unloaded = replace(back, penetration_depth=returned)
    return drawn, replace(tests, penetration_depth=depth, unloading=unloaded)


def campaign_of_series(sites: npt.NDArray[np.object_], size: str, rng: np.random.Generator) -> npt.NDArray[np.int64]:
    """Campaign of each series, -1 for a series in none."""
    if size == "all":
        return np.zeros(len(sites), dtype=np.int64)
    campaign, number = np.full(len(sites), -1), 0
    for name in sorted(set(sites.tolist())):
        mine = rng.permutation(np.flatnonzero(sites == name))
        n = len(mine) if size == "site" else int(size)
        for first in range(0, len(mine) - n + 1, n):
            campaign[mine[first : first + n]] = number
            number += 1
    return campaign


def simulate(case: Case, seed: int, tallies: dict[str, Tally]) -> int:
    """Draw and estimate the campaigns of one seed; returns their number."""
    drawn, tests = drawn_campaign(case, seed)
    campaign = drawn.campaign()
    sites = np.array(tests.site, dtype=object)
    group = campaign_of_series(sites, case.size, np.random.default_rng(seed + 10**7))
    readings = readings_of(tests, campaign.tools, geometry="extended")
    H = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    counts = (group >= 0) & np.isfinite(H) & (H > 0)
    if case.snow == "ice":
        counts &= sites == ICE
    names, group = np.unique(np.where(counts, group, -1), return_inverse=True)
    group = np.where(counts, group - (names[0] == -1), 0)
    uncertainty = reading_uncertainty(campaign)
    if case.size == "all":
        model = fit_in_groups(readings, H, uncertainty, labels={"site": tests.site, "tool": tests.tool}, counts=counts)
    else:
        model = fit_campaign(readings, H, uncertainty, counts=counts, group=group)
    add_series(case, drawn, tests, readings, model, counts, tallies)
    if case.ratio == RATIOS[0] or case.noisy:
        add_factors(readings, H, model, counts, group if case.size != "all" else np.zeros_like(group), tallies)
    return int(group[counts].max()) + 1


def add_series(
    case: Case,
    drawn: ReferenceCampaign,
    tests: PenetrationTests,
    readings: Readings,
    model: CampaignModel,
    counts: BoolArray,
    tallies: dict[str, Tally],
) -> None:
    """Add H_V by both procedures and k_u/H_V of each series, over all and by site."""
    sites, truth = np.array(tests.site, dtype=object), np.log(drawn.snow_hardness)
    eqn_1 = hardness(readings, DEFINITIONS["H_V"], model)
    back = unloading(tests, readings, eqn_1, model, np.zeros(len(tests), dtype=bool))
    low, high = back.rebound_ratio_interval.T
    rebound = 1.0 / drawn.unloading_ratio
    half_rebound = np.where(back.below_step, np.nan, 0.5 * (high - low))
    values = {
        "H_V": (model.log_hardness - truth, model.half_width(0)),
        "Eqn 1": (np.log(eqn_1.value) - truth, np.log(eqn_1.interval[:, 1] / eqn_1.value)),
        "k_u/H_V": (0.5 * (low + high) / rebound - 1.0, half_rebound / rebound),
    }
    kinds = {"": np.ones(len(sites), dtype=bool)} | {f" {name}": sites == name for name in sorted(set(sites.tolist()))}
    if case.noisy == ("half",):
        noisy = np.arange(len(sites)) % 2 == 0
        kinds |= {" noisy": noisy, " others": ~noisy}
    for quantity, (error, half) in values.items():
        usable = counts & np.isfinite(drawn.unloading_ratio) if quantity == "k_u/H_V" else counts
        for kind, mask in kinds.items():
            if (chosen := usable & mask).any():
                tallies.setdefault(quantity + kind, Tally()).add(error[chosen], half[chosen])
    resolved = counts & (low > 0)
    tallies.setdefault("k_u/H_V resolved", Tally()).add(*(values["k_u/H_V"][i][resolved] for i in range(2)))


def add_factors(
    readings: Readings,
    H: FloatArray,
    model: CampaignModel,
    counts: BoolArray,
    campaign: npt.NDArray[np.int64],
    tallies: dict[str, Tally],
) -> None:
    """Add b of each campaign: corrected against 1, and by least squares against the value that this estimates."""
    for number in range(int(campaign[counts].max()) + 1):
        mine = counts & (campaign == number)
        b = volume_factor(readings.of(mine), H[mine], model.of(mine))
        half = np.array([0.5 * (b.high - b.low)])
        tallies.setdefault("b", Tally()).add(np.array([b.value - 1.0]), half)
        tallies.setdefault("raw b against 1", Tally()).add(np.array([b.raw - 1.0]), half)
        tallies.setdefault("raw b against its own value", Tally()).add(np.array([b.raw - b.expected_raw]), half)


def run(case: Case, folder: Path, wanted: int) -> None:
    """Continue a case up to the wanted number of campaigns."""
    path = folder / f"{case.name}.json"
    done: dict[str, Any] = {"campaigns": 0, "next": FIRST_SEED}
    if path.exists():
        done = json.loads(path.read_text(encoding="utf-8"))
    tallies = {name: Tally(**values) for name, values in done.get("tallies", {}).items()}
    campaigns, seed = done["campaigns"], done["next"]
    while campaigns < wanted:
        for _ in range(BLOCK):
            campaigns += simulate(case, seed, tallies)
            seed += 1
            if campaigns >= wanted:
                break
        content = {
            "case": case.__dict__,
            "campaigns": campaigns,
            "first": FIRST_SEED,
            "next": seed,
            "tallies": {name: tally.__dict__ for name, tally in tallies.items()},
        }
        path.with_suffix(".part").write_text(json.dumps(content), encoding="utf-8")
        path.with_suffix(".part").replace(path)


def table(folder: Path) -> Iterator[str]:
    """Rows of a Markdown table: coverage (%) of all series, lowest and highest site, and median half width."""
    yield "| case | campaigns | quantity | covers | sites | half width | without |"
    yield "| --- | ---: | --- | ---: | ---: | ---: | ---: |"
    for path in sorted(folder.glob("*.json")):
        done = json.loads(path.read_text(encoding="utf-8"))
        tallies = {name: Tally(**values) for name, values in done["tallies"].items()}
        for name, tally in tallies.items():
            if not tally.n or " site" in name:
                continue
            by_site = [100.0 * t.inside / t.n for key, t in tallies.items() if key.startswith(f"{name} site") and t.n]
            sites = f"{min(by_site):.1f}-{max(by_site):.1f}" if by_site else ""
            yield (
                f"| {path.stem} | {done['campaigns']} | {name} | {100.0 * tally.inside / tally.n:.1f} | {sites} | "
                f"{np.median(tally.half):.4f} | {100.0 * tally.lost / (tally.n + tally.lost):.1f} |"
            )


def main() -> None:
    """Run the cases, or print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.campaign_intervals")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--group", default="main", help="main, small, noisy or reference (default: main)")
    parser.add_argument("--campaigns", type=int, default=1000)
    parser.add_argument("--table", action="store_true")
    options = parser.parse_args()
    if options.table:
        print("\n".join(table(options.folder)))
        return
    options.folder.mkdir(parents=True, exist_ok=True)
    for case in cases(options.group):
        run(case, options.folder, options.campaigns)


if __name__ == "__main__":
    main()
