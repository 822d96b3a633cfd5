"""Intervals of fitted headings: coverage over simulated tracks, and none where other headings fit as well."""

from __future__ import annotations

import json

import numpy as np
import pytest
from benchmarks.track_headings import KINDS, fitted_track, row

from skisnow.comparison import compare_tracks, comparison_dict

from .made_tracks import FloatArray, build_track


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in KINDS if name != "arc of one radius"])
def test_coverage_of_200_tracks(name: str) -> None:
    """Seeds that were not used to design the interval."""
    tracks = [fitted_track(*KINDS[name], seed) for seed in range(1000, 1200)]
    covers = [track.covers for track in tracks if track.covers is not None]
    assert len(covers) > 160, row(name, tracks)
    assert 0.90 <= np.mean(covers) <= 0.99, row(name, tracks)


@pytest.mark.parametrize("seed", range(5))
def test_arc_of_one_radius_has_no_interval(seed: int) -> None:
    motion = fitted_track("arc", 0.0, seed).motion
    assert motion.rival is not None
    assert motion.turned_error is None


def test_a_comparison_reports_the_other_heading_instead_of_an_interval() -> None:
    angle = np.linspace(0.0, 2.0, 200)
    circle: FloatArray = 15.0 * np.column_stack([np.cos(angle), np.sin(angle)])
    noise = 0.02 * np.random.default_rng(7).normal(size=(120, 2))
    found = compare_tracks(
        build_track(circle, angle), build_track(circle[40:160] + noise, angle[40:160]), fit=("start", "heading")
    )
    fitted = json.loads(json.dumps(comparison_dict(found)))["fitted"]
    assert fitted["turned_error_deg"] is None
    assert abs(fitted["rival"]["turned_deg"] - fitted["turned_deg"]) > 5.0
    assert fitted["rival"]["rms_m"] < 0.05
    assert len(found.warnings) == 1
