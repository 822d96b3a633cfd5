"""The interval of a site's mean is one number, whether a report of the campaign or of a turn prints it."""

from __future__ import annotations

import pytest

import skisnow
from skisnow._support.units import N_PER_MM2, N_PER_MM3
from skisnow.campaign import reference_campaign


def test_the_snow_of_a_site_has_the_interval_of_its_mean() -> None:
    found = skisnow.analyse(reference_campaign(1).campaign(), n_resamples=100)
    means = {(row["quantity"], row["site"]): row for row in found.results["site_means"]}
    for letter in "CE":
        snow = found.snow(letter)
        for key, unit, value, interval in (
            ("H_V_N_per_mm3", N_PER_MM3, snow.snow_hardness, snow.snow_hardness_interval),
            ("S_f_N_per_mm2", N_PER_MM2, snow.failure_shear_stress, snow.failure_shear_stress_interval),
        ):
            row = means[key, f"site {letter}"]
            assert value is not None
            assert interval is not None
            assert value / unit == pytest.approx(row["mean"], rel=1e-12)
            assert [end / unit for end in interval] == pytest.approx(row["interval"], rel=1e-9)
