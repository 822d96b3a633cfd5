"""The counts of significant regressions that the page of the reference campaign prints are those of its command."""

from __future__ import annotations

import pytest
from benchmarks.page_tables import stale_tables
from benchmarks.regressions import found, significant, table

EQN_14 = ("S_f_N_per_mm2", "snow_density_kg_per_m3", "all")


@pytest.mark.slow
def test_the_page_has_the_table_of_two_hundred_seeds() -> None:
    assert stale_tables("validation/reference-campaign", {"regressions": table(range(200))}) == []


def test_counts_are_those_of_the_p_values() -> None:
    seeds = range(3)
    p = [row.fit.p for seed in seeds for row in found(seed) if row.plan.predictor == EQN_14[1] and row.fit is not None]
    shear = p[::2]  # each campaign regresses S_f on density first, then H_V
    count = significant(seeds)[EQN_14]
    assert count.below == [sum(value < 0.05 for value in shear), sum(value < 0.01 for value in shear)]
    assert count.below[0] > 0
