"""Verdicts on two skis and on two runs, with numbers worked out by hand."""

from typing import Any

import numpy as np
import pytest

from skisnow._support.messages import Message
from skisnow.report.summaries import RADII, run_verdict, ski_verdict
from skisnow.track.track import Track
from tests.present import present

NAMES = ("wide", "tight")


def answer(radius: float | None, changes: list[float] | None = None, chord: float | None = None) -> dict[str, Any]:
    other = dict.fromkeys(RADII[1:], radius) | ({} if chord is None else {"turn_radius_chord_m": chord})
    return {"turn_radius_boot_m": radius, **other, **({} if changes is None else {"radius_changes_by_snow_m": changes})}


def inner(verdict: Message) -> Message:
    found = verdict.fields["comparison"]
    assert isinstance(found, Message)
    return found


def test_tighter_ski_comes_first_with_the_interval_of_the_ratio() -> None:
    """12/10 is 20 % more; changes of 3 and 2 % by H_V, 5 and 1 % by S_f: ±120 % · √(0.01² + 0.04²) = 4.95 %."""
    for first, other, names in (
        (answer(12.0, [0.36, 0.6]), answer(10.0, [0.2, 0.1]), NAMES),
        (answer(10.0, [0.2, 0.1]), answer(12.0, [0.36, 0.6]), NAMES[::-1]),
    ):
        verdict = ski_verdict(first, other, names)
        fields = inner(verdict).fields
        assert (fields["a"], fields["b"]) == ("tight", "wide")
        assert fields["percent"] == pytest.approx(20.0)
        ends = fields["interval"].fields
        assert (ends["low"], ends["high"]) == pytest.approx((20.0 - 4.9477, 20.0 + 4.9477), abs=1e-3)
        assert "not certain" not in verdict


def test_uncertain_without_a_difference_beyond_the_snow_or_with_other_definitions() -> None:
    by_snow = ski_verdict(answer(10.2, [0.5, 0.0]), answer(10.0, [0.0, 0.0]), NAMES)
    by_definition = ski_verdict(answer(12.0, [0.0, 0.0]), answer(10.0, [0.0, 0.0], chord=13.0), NAMES)
    assert all("not certain" in verdict for verdict in (by_snow, by_definition))
    assert "another definition" in by_definition
    assert inner(ski_verdict(answer(12.0), answer(10.0), NAMES)).fields["interval"] == ""
    assert "same radius" in ski_verdict(answer(10.0), answer(10.0), NAMES)
    assert "cannot be compared" in ski_verdict(answer(None), answer(10.0), NAMES)


def run(name: str, speed: float, duration: float) -> Track:
    time = np.linspace(0.0, duration, 51)
    place = np.column_stack([speed * time, np.zeros((51, 2))])
    return Track(name, time, place, np.full(51, np.nan), "local", "slope")


def test_faster_run_over_the_length_of_both() -> None:
    """40 m at 10 m/s take 4 s, at 8 m/s 5 s."""
    found = present(run_verdict(run("slow", 8.0, 6.0), run("fast", 10.0, 4.0)))
    assert (found.fields["a"], found.fields["b"]) == ("fast", "slow")
    assert (found.fields["seconds"], found.fields["length"]) == pytest.approx((1.0, 40.0))
    same = present(run_verdict(run("a", 10.0, 4.0), run("b", 10.0, 5.0)))
    assert "equally fast" in same
