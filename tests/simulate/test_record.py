"""What is kept of a run under way, moment by moment."""

from __future__ import annotations

import numpy as np
import pytest

from skisnow.scenario import read_scenario
from skisnow.simulate.run_record import Record, _at_boot
from skisnow.simulate.run_setup import set_up


def chords(record: Record) -> float:
    """Of a turn of some 16 m radius, whose arcs of 0.1 m are longer by two millionths."""
    return float(np.linalg.norm(np.diff(record.histories()["place"], axis=0), axis=1).sum())


def test_moments_are_kept_replaced_and_dropped() -> None:
    record = Record(set_up(read_scenario("carved-46m")))
    assert (record.last_interval, record.run_length) == (0.0, 0.0)
    assert record.advance(0.01) is None
    assert record.last_interval == pytest.approx(0.01, abs=1e-12)
    record.advance(0.03)
    assert record.last_interval == pytest.approx(0.02, abs=1e-12)
    assert record.run_length == pytest.approx(chords(record), rel=1e-5)
    record.advance(0.035, replace=True)
    assert record.histories()["time"] == pytest.approx([0.0, 0.01, 0.035], abs=1e-12)
    assert record.run_length == pytest.approx(chords(record), rel=1e-5)
    record.advance(0.04)
    record.drop()
    assert record.run_length == pytest.approx(chords(record), rel=1e-5)
    record.drop()
    record.drop()
    assert record.histories()["time"].tolist() == [0.0]


@pytest.mark.parametrize(
    ("node", "at_boot"),
    [
        ([0.9, 0.5, 0.1, -0.3], 1.5),  # a quarter of the way from 2 to 0
        ([0.9, 0.3, -0.1, -0.3], 2.25),  # three quarters of the way from 3 to 2
        ([0.9, 0.5, 0.0, -0.3], 2.0),
        ([0.3, -0.1, -0.5, -0.9], 3.25),
    ],
)
def test_what_is_under_the_boot_lies_between_its_neighbours(node: list[float], at_boot: float) -> None:
    values = np.array([[4.0, 3.0, 2.0, 0.0], [8.0, 6.0, 4.0, 0.0]])
    assert _at_boot(np.array(node), values) == pytest.approx([at_boot, 2.0 * at_boot], rel=1e-12)
