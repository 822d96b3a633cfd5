"""The benchmarks of turns on runs of 0.05 s: what they count and compare, not how fast anything is."""

import importlib.util
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.turns import clamped_modes, one_process, own_flight, peers, processes, speed, table
from benchmarks.turns.cases import Case, Runs, fixed
from tests.key_names import LINE_SPACING

from skisnow.ski import read_ski
from skisnow.ski.ski import Ski

SECONDS = 0.05
REFERENCE = fixed(0.1)
FAST = Case("long steps", fixed(1.0), REFERENCE, "40")
HALF = Case("half as long", fixed(0.5), REFERENCE)
ITSELF = Case("itself", REFERENCE, REFERENCE)
TIPS_OVER = Case("on its edge", {"sledge.centre_of_mass_height_m": 2.0, "start.heading_deg": 90.0}, REFERENCE)


@pytest.fixture(scope="module")
def found() -> list[speed.Speed]:
    return speed.speeds(Runs(SECONDS), repeats=2, cases=[FAST, HALF, ITSELF, TIPS_OVER])


def test_steps_are_those_of_the_duration(found: list[speed.Speed]) -> None:
    assert [each.steps for each in found[:3]] == [50, 100, 500]
    assert all(each.simulated_s == pytest.approx(SECONDS, rel=1e-12) and not each.trouble for each in found[:3])


def test_speed_is_simulated_over_wall_time() -> None:
    measured = speed.Speed(FAST, seconds=0.5, simulated_s=5.0, steps=5000)
    assert measured.times_real_time == pytest.approx(10.0)
    assert measured.us_per_step == pytest.approx(100.0)


def test_the_error_beside_it_is_that_of_the_step(found: list[speed.Speed]) -> None:
    """A run against itself is exact; a step of half the length is nearer."""
    fast, default, itself = (each.end_off_m for each in found[:3])
    assert itself == 0.0
    assert 0.0 < default < fast < 0.01  # m: 0.05 s at 7 m/s are 0.35 m


def test_a_run_that_cannot_be_says_so(found: list[speed.Speed]) -> None:
    lines = list(table.speed_table(found))
    assert found[3].trouble
    assert found[3].trouble in lines[-1]


def test_rows_of_the_tables_have_the_columns_of_their_heads(found: list[speed.Speed]) -> None:
    theirs = [peers.Peer("one", 30.0, 5.0, 1e-4, (1.0, 0.99)), peers.Peer("other", absent="not installed")]
    for lines in (list(table.speed_table(found)), list(table.peer_table(theirs, found[1]))):
        assert len({line.count("|") for line in lines if line}) == 1


def test_finer_in_space() -> None:
    found = list(speed.finer(Runs(SECONDS), HALF.changes))
    assert [each.key for each in found] == ["solver.elements", LINE_SPACING, "solver.groove_tolerance"]
    assert all(0.0 < each.end_moves_m < 0.01 for each in found)


def test_many_runs_have_the_bits_of_one() -> None:
    """In this process; tests of pools start others."""
    batch = processes.many(SECONDS, HALF, count=2, workers=1)
    assert batch.same_bits
    assert 0.0 < batch.end_off_m < 0.01
    assert batch.per_s < batch.per_s_running
    lines = list(table.batch_table([batch, replace(batch, same_bits=False)]))
    assert len({line.count("|") for line in lines if line}) == 1
    assert any("**another**" in line for line in lines)


def test_arrays_of_a_run_are_below_5_MB() -> None:
    """Memory that NumPy asks for; a further run in the same process needs no more."""
    assert 0.1 < one_process.costs(SECONDS)["arrays_of_a_run_MB"] < 5.0


@pytest.fixture(scope="module")
def ski() -> Ski:
    return read_ski("giant-slalom")


def test_first_clamped_frequency_of_a_uniform_beam(ski: Ski) -> None:
    """f = 1.8751²/(2π l²) √(EI/m') of the longer end; torsion f = 1/(4 l) √(GJ/(m' w²/12))."""
    n, EI, GJ, m, w = len(ski.station), 200.0, 100.0, 1.2, 0.07
    uniform = replace(
        ski,
        width=np.full(n, w), bending_stiffness=np.full(n, EI), torsional_stiffness=np.full(n, GJ),
        mass_per_length=np.full(n, m),
    )  # fmt: skip
    length = max(ski.station[0], -ski.station[-1]) - clamped_modes.CLAMP_LENGTH / 2.0
    bending, torsion = clamped_modes.first_frequencies(uniform)
    assert bending == pytest.approx(1.87510407**2 / (2 * np.pi * length**2) * np.sqrt(EI / m), rel=1e-4)
    # linear elements: their lowest frequency is high by (π/4n)²/6 at about 20 elements, 0.03 %
    assert torsion == pytest.approx(np.sqrt(GJ / (m * w**2 / 12)) / (4 * length), rel=1e-3)


def test_a_peer_that_is_absent_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(peers, "find_spec", lambda _: None)
    own, *others = peers.peers(duration_s=SECONDS, repeats=1)
    assert not own.absent
    assert [each.absent for each in others] == [
        f"{program} is not installed: pip install 'skisnow[peers]'" for program in ("mujoco", "exudyn")
    ]


def test_our_sledge_flies() -> None:
    """In 0.2 s it falls as a stone, but for what skis and air do; a sledge that is not lifted is refused."""
    record = own_flight.released(0.5)
    flying = record.setup.dynamics
    height, tips, rising = flying.position[2], own_flight.tips(record), flying.rotation[2] @ flying.velocity[:3]
    own_flight.flown(record, 0.2)
    fallen = 0.5 * 0.2**2 * -flying.body.gravity[2] - 0.2 * rising
    assert height - flying.position[2] == pytest.approx(fallen, rel=0.01)
    assert tips[:, 2] - own_flight.tips(record)[:, 2] == pytest.approx(fallen, abs=0.05)  # they unbend by a centimetre
    found = peers.own(duration_s=SECONDS, repeats=1)
    assert 0.0 < found.tip_off_m < 0.005
    on_snow = own_flight.released(0.5, lifted_m=0.0)
    with pytest.raises(AssertionError, match="touches snow"):
        own_flight.flown(on_snow, 0.002)


@pytest.mark.skipif(importlib.util.find_spec("mujoco") is None, reason="needs MuJoCo")
def test_ski_in_mujoco_is_ours(ski: Ski) -> None:
    """Bending and torsion within 1 %; with twice our bending stiffness √2 times as fast, and refused."""
    (first, *_) = peers.mujoco_flight(ski, duration_s=SECONDS, repeats=1)
    assert first.frequencies == pytest.approx((1.0, 1.0), abs=0.01)
    assert 0.0 < first.tip_off_m < 0.005
    from benchmarks.turns import mujoco_skis

    stiffer = mujoco_skis.flight(replace(ski, bending_stiffness=2.0 * ski.bending_stiffness), step=2e-4)
    bending, torsion = mujoco_skis.clamped_frequencies(stiffer)
    ours = clamped_modes.first_frequencies(ski)
    assert bending / ours[0] == pytest.approx(2**0.5, rel=0.01)
    assert torsion / ours[1] == pytest.approx(1.0, rel=0.01)
    with pytest.raises(AssertionError, match="another ski"):
        peers.agreeing("MuJoCo", (bending, torsion), ours)


@pytest.mark.skipif(importlib.util.find_spec("exudyn") is None, reason="needs Exudyn")
def test_ski_in_exudyn_is_ours(ski: Ski) -> None:
    """Its swing, of large deflections, has our frequency within 2 %."""
    (found,) = peers.exudyn_swing(ski, duration_s=SECONDS, repeats=1)
    assert found.frequencies == pytest.approx((1.0,), abs=0.02)
    assert found.tip_off_m < 0.005
