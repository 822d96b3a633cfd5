"""How often each regression of the reference campaign is significant: ``python -m benchmarks.regressions``.

The truth behind the synthetic campaign has S_f from density by Eqn 14 and its printed rmse, Eqn 13 on the soft snow,
and no other relation. Writes the table of the page on the reference campaign, for seeds 0 to 199.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass

from benchmarks.page_tables import write_tables
from skisnow.campaign import reference_campaign
from skisnow.estimation.hardness import DEFINITIONS, hardness_at_largest_load, shear_stress
from skisnow.estimation.readings import readings_of
from skisnow.estimation.regressions import (
    Regression,
    penetration_observations,
    regressions,
    shear_observations,
    spot_observations,
)
from skisnow.estimation.screening import screened_penetration, screened_shear

LEVELS = (0.05, 0.01)
"""The usual one, and the paper's: it prints p < 0.01 for Eqns 13 and 14."""


@dataclass
class Count:
    """In how many campaigns p is below each level, and the interval with sites as clusters leaves out zero."""

    below: list[int]
    by_site: int = 0


def found(seed: int) -> tuple[Regression, ...]:
    """The regressions of one reference campaign, as `skisnow.analyse` does them."""
    campaign = reference_campaign(seed).campaign()
    assert campaign.penetration is not None
    assert campaign.shear is not None
    readings = readings_of(campaign.penetration, campaign.tools, geometry="extended")
    hardness = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    pressed = penetration_observations(campaign, hardness, screened_penetration(campaign, geometry="extended").used)
    sheared = shear_observations(campaign, shear_stress(campaign, campaign.shear).value, screened_shear(campaign).used)
    return regressions({"penetration": pressed, "shear": sheared, "spots": spot_observations(pressed, sheared)})


def significant(seeds: range) -> dict[tuple[str, str, str], Count]:
    """Count by response, predictor and group."""
    counts: dict[tuple[str, str, str], Count] = {}
    for seed in seeds:
        for row in found(seed):
            key = row.plan.response, row.plan.predictor, row.group
            count = counts.setdefault(key, Count([0] * len(LEVELS)))
            if row.fit is not None and row.withheld is None:
                count.below = [n + int(row.fit.p < level) for n, level in zip(count.below, LEVELS, strict=True)]
            if row.interval_by_site is not None:
                low, high = row.interval_by_site[1]
                count.by_site += int(low > 0 or high < 0)
    return counts


def table(seeds: range) -> list[str]:
    """The counts as rows of Markdown."""
    head = [
        f"| of {len(seeds)} campaigns | group | p < 0.05 | p < 0.01 | sites as clusters |",
        "| --- | --- | ---: | ---: | ---: |",
    ]
    return head + [_cells(*key, count) for key, count in significant(seeds).items()]


def _cells(response: str, predictor: str, group: str, count: Count) -> str:
    by_site = count.by_site if group == "all" else "–"
    return f"| `{response}` on `{predictor}` | {group} | {count.below[0]} | {count.below[1]} | {by_site} |"


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.regressions")
    parser.add_argument("--campaigns", type=int, default=200)
    write_tables("validation/reference-campaign", {"regressions": table(range(parser.parse_args().campaigns))})


if __name__ == "__main__":
    main()
