"""What is kept of a run under way, moment by moment."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from skisnow.dynamics import Ended
from skisnow.scenario import read_scenario
from skisnow.simulate.run_record import Moment, Record, _arc, _at_boot, _heading, at_nodes, turn_radius
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


def books(*, shear: float, normal: float) -> tuple[float, ...]:
    """What a record keeps of energies and works (J) that stand here; 1 and 2 were in the snow at the start."""
    dynamics: Any = SimpleNamespace(
        snow_energies=(1.0, 2.0), energies=(100.0, 200.0, 7.0), work=(shear, 20.0, normal, 4.0, 5.0, 6.0),
        work_given=(8.0, 9.0), contact=SimpleNamespace(delayed_energy=0.5), body=SimpleNamespace(skis=()), time=0.0,
        position=np.zeros(3), rotation=np.eye(3), boots=None, boot_wrench=None, beam_dofs=np.zeros((0, 0)),
    )  # fmt: skip
    setup: Any = SimpleNamespace(dynamics=dynamics, place=np.zeros(3), attitude=np.eye(3), velocity=np.zeros(3))
    record = Record(setup)
    dynamics.snow_energies = (5.0, 3.0)
    return record._present().energies


def test_who_pays_for_what_the_snow_takes() -> None:
    """30 J of the normal force less 4 that the snow keeps and 6.5 of its dashpot; of 10 J by shear one is kept."""
    assert books(shear=10.0, normal=-30.0) == (100.0, 200.0, 7.0, 8.0, 19.5, 9.0, 20.0, 4.0, 5.0, 6.5, 8.0, 9.0)
    pressed = books(shear=-2.0, normal=-30.0)  # an edge that is pressed deeper: penetration pays 3 J
    assert pressed[4:6] == (16.5, 0.0)
    lifted = books(shear=10.0, normal=-5.0)  # sideways motion pays for what lifts
    assert lifted[4:6] == (0.0, 3.5)
    both = books(shear=-2.0, normal=-5.0)
    assert both[4:6] == (0.0, -8.5)


def moment(place: Any = (0.0, 0.0, 0.0), velocity: Any = (1.0, 0.0, 0.0), energies: Any = (0.0,) * 12) -> Moment:
    nothing = np.zeros(0)
    return Moment(
        0.0, np.array(place, float), np.eye(3), np.array(velocity, float), tuple(energies), (), nothing,
        (nothing, nothing), nothing, nothing,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("first", "last", "gains"),
    [
        ((100.0, 50.0, 0.0, 0.0), (114.9, 50.0, 0.0, 0.0), False),  # 10 J and 5 % of 100
        ((100.0, 50.0, 0.0, 0.0), (100.0, 50.0, 15.1, 0.0), True),
        ((100.0, 500.0, 0.0, 0.0), (300.0, 280.0, 0.0, 0.0), False),  # 220 J of height became 200 of speed
        ((100.0, 500.0, 0.0, 0.0), (325.9, 300.0, 0.0, 0.0), True),  # 25.9 against 10 + 5 % of 300
        ((100.0, 500.0, 0.0, 0.0), (324.9, 300.0, 0.0, 0.0), False),
        ((100.0, 50.0, 0.0, 0.0), (135.9, 50.0, 0.0, 20.0), False),  # of 20 that were given: 10 and 5 % of 120
        ((100.0, 50.0, 0.0, 0.0), (136.1, 50.0, 0.0, 20.0), True),
        ((100.0, 50.0, 0.0, 0.0), (116.1, 50.0, 0.0, -10.0), True),
        ((100.0, 50.0, 0.0, 0.0), (math.nan, 50.0, 0.0, 0.0), True),
    ],
)
def test_more_energy_than_there_was_is_told(first: Any, last: Any, gains: bool) -> None:
    """Kinetic, potential, elastic in the skis, and what boots give; what is in the snow counts not."""
    kept = [moment(energies=(*each[:3], 1e6 * i, *(0.0,) * 6, each[3], 0.0)) for i, each in enumerate((first, last))]
    record = Record(set_up(read_scenario("carved-46m")))
    record._moments = kept
    assert record.gains_energy is gains


def test_steps_that_cannot_go_on_are_an_outcome() -> None:
    record = Record(set_up(read_scenario("carved-46m")))
    for ended, outcome in ((Ended.STEP_TOO_SMALL, "step_too_small"), (Ended.NOT_FINITE, "not_finite")):
        record.setup = replace_advance(record.setup, ended)
        assert record.advance(0.1) == outcome


def replace_advance(setup: Any, ended: Ended) -> Any:
    names = ("dynamics", "place", "attitude", "velocity")
    return SimpleNamespace(advance=lambda *_: ended, **{name: getattr(setup, name) for name in names})


def test_the_way_between_two_moments_is_that_of_an_arc() -> None:
    """0.1 rad of a circle of 10 m; where one of them rests, or turns about, the chord."""
    cos, sin = math.cos(0.1), math.sin(0.1)
    end, chord = (10.0 * sin, 10.0 * (1.0 - cos), 0.0), 20.0 * math.sin(0.05)
    start = moment(velocity=(4.0, 0.0, 0.0))
    assert _arc(start, moment(end, (5.0 * cos, 5.0 * sin, 0.0))) == pytest.approx(1.0, rel=1e-6)
    assert _arc(start, moment(end, (0.0, 0.0, 0.0))) == pytest.approx(chord)
    assert _arc(start, moment(end, (-4.0, 0.1, 0.0))) == pytest.approx(chord)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_radius_of_a_circle(side: float) -> None:
    time = np.linspace(0.0, 1.0, 101)
    velocity = 6.0 * np.column_stack([np.cos(0.5 * time), side * np.sin(0.5 * time), np.zeros(101)])
    normal = np.tile([0.0, 0.0, 1.0], (101, 1))
    assert turn_radius(time, velocity, normal) == pytest.approx(np.full(101, side * 12.0), rel=1e-2)
    assert turn_radius(time, velocity, normal)[1:-1] == pytest.approx(np.full(99, side * 12.0), rel=1e-4)
    assert np.isinf(turn_radius(time, velocity * [1.0, 0.0, 1.0], normal)).all()
    assert np.isinf(turn_radius(time, 1e-3 * velocity, normal)).all()
    assert turn_radius(time[:1], velocity[:1], normal[:1]).tolist() == [math.inf]
    assert np.isfinite(turn_radius(time[:2], velocity[:2], normal[:2])).all()


def test_headings_go_on_beyond_half_a_turn() -> None:
    angle = np.linspace(0.0, 7.0, 40)
    attitude = np.zeros((40, 3, 3))
    attitude[:, 0, 0], attitude[:, 1, 0] = np.cos(angle), np.sin(angle)
    assert _heading(attitude, np.tile([0.0, 0.0, 1.0], (40, 1))) == pytest.approx(angle)


def test_unknowns_stand_at_their_nodes() -> None:
    """Of two skis with three nodes, the middle one held."""
    dofs = np.arange(12.0).reshape(2, 6)
    found = at_nodes(dofs, np.array([0, -1, 3]))
    assert found.tolist() == [
        [[0.0, 1.0, 2.0], [0.0, 0.0, 0.0], [3.0, 4.0, 5.0]],
        [[6.0, 7.0, 8.0], [0.0, 0.0, 0.0], [9.0, 10.0, 11.0]],
    ]
