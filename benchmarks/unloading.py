"""How well k_u/H_V is found in campaigns whose truth is known: ``python -m benchmarks.unloading --campaigns 1000``.

Prints a Markdown table; that of the page on unloading is its output. The truth of a site is the mean of H_V/k_u over
the distribution that its spots are drawn from.
"""

from __future__ import annotations

import argparse
import math

import numpy as np

from benchmarks.campaign_intervals import CLEAN
from benchmarks.page_tables import write_tables
from skisnow._support.units import MM
from skisnow.campaign import ReferenceNoise, reference_campaign
from skisnow.campaign.reference import design
from skisnow.estimation.readings import readings_of
from skisnow.estimation.screening import series_estimates
from skisnow.estimation.unloading import site_unloading

CASES = {
    "all stated errors": ReferenceNoise(**CLEAN),
    "rebound scatters by 10 %": ReferenceNoise(**CLEAN, rebound_scatter=0.1),
    "gauge of 0.1 mm": ReferenceNoise(**CLEAN, gauge_resolution=0.1 * MM),
}
HEAD = (
    "| errors in the data | site | H_V (N/mm³) | mean error of a series | rms | coverage | unresolved | "
    "mean error of the site | coverage |",
    "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
)


def series_and_sites(seed: int, noise: ReferenceNoise) -> tuple[dict[str, list[np.ndarray]], dict[str, np.ndarray]]:
    """By site: relative error of s, whether covered, whether unresolved of each series; the same of the site's mean."""
    drawn = reference_campaign(seed, noise=noise)
    campaign, tests = drawn.campaign(), drawn.penetration
    readings = readings_of(tests, campaign.tools, geometry="extended")
    found = series_estimates(campaign, tests, readings).unloading
    truth = 1.0 / drawn.unloading_ratio
    low, high = found.rebound_ratio_interval.T
    series = np.stack((found.rebound_ratio / truth - 1.0, (low <= truth) & (truth <= high), found.is_unresolved))
    known = np.isfinite(found.rebound_ratio)
    names = np.array(tests.site, dtype=object)
    of_series = {site: [series[:, known & (names == site)]] for site in design.UNLOADED_SITES}
    mean = math.exp(noise.unloading_log_sd**2 / 2.0) / design.UNLOADING_RATIO
    of_sites = {
        each.site: np.array([1.0 / each.ratio / mean - 1.0, each.low_rebound <= mean <= each.high_rebound])
        for each in site_unloading(found, known, tests.site)
        if each.site is not None
    }
    return of_series, of_sites


def rows(name: str, noise: ReferenceNoise, seeds: range) -> list[str]:
    """The table of one case."""
    series: dict[str, list[np.ndarray]] = {}
    sites: dict[str, list[np.ndarray]] = {}
    for seed in seeds:
        of_series, of_sites = series_and_sites(seed, noise)
        for site in of_series:
            series.setdefault(site, []).extend(of_series[site])
            sites.setdefault(site, []).append(of_sites[site])
    hardness_of = {site.name: site.snow_hardness / 1e9 for site in design.PENETRATION_SITES}
    return [
        _cells(name, site, hardness_of[site], np.concatenate(series[site], axis=1), np.array(sites[site]))
        for site in series
    ]


def _cells(name: str, site: str, hardness_of_site: float, series: np.ndarray, sites: np.ndarray) -> str:
    error, covered, unresolved = series.astype(float)
    return (
        f"| {name} | {site} | {hardness_of_site:.2g} | {error.mean():+.2%} | {np.sqrt(np.mean(error**2)):.1%} | "
        f"{covered.mean():.1%} | {unresolved.mean():.1%} | {np.nanmean(sites[:, 0]):+.2%} | {sites[:, 1].mean():.1%} |"
    )


def main() -> None:
    """Write the table of docs/validation/reference-campaign.md."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.unloading")
    parser.add_argument("--campaigns", type=int, default=1000)
    seeds = range(parser.parse_args().campaigns)
    lines = [*HEAD, *(row for name, noise in CASES.items() for row in rows(name, noise, seeds))]
    write_tables("validation/reference-campaign", {"unloading": lines})


if __name__ == "__main__":
    main()
