"""Every ski, snow, angle and load has a named outcome, and the outcome is the right one."""

import itertools
import math
from collections import Counter

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.carving.equilibrium import carve, rest
from skisnow.carving.result import SINKING_DEPTH, Equilibrium
from skisnow.ski import read_ski
from tests.present import present

from .synthetic import plain_ski, snow

HARDNESSES = (0.02, 0.04, 0.2, 1.0, 10.0, 90.0)
ANGLES_DEG = (0.0, 1.0, 5.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0)
LOADS = (100.0, 400.0, 1000.0, 3000.0)
RATIOS = (1.0, 2.0, 10.0, 50.0, math.inf)


def pieces(depth: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> int:
    below = np.concatenate([[False], depth > 0.0, [False]])
    return int(np.count_nonzero(np.diff(below.astype(int)) == 1))


def check(found: Equilibrium, load: float, angle_deg: float) -> None:
    """A named outcome with the numbers that it promises."""
    assert found.outcome in ("equilibrium", "slips", "bridges", "sinks")
    if found.outcome == "sinks":
        assert found.edge_depth is None
        assert found.holds is None
        return
    assert found.edge_depth is not None
    assert np.all(np.isfinite(found.edge_depth))
    assert np.all(present(found.force_per_length) >= 0.0)
    assert found.edge_depth.max() <= SINKING_DEPTH
    # 1e-8, or where rounding ends the iteration a few times that; the moment per metre of lever
    assert abs(found.residual_force or 0.0) <= 1e-7 * load
    assert abs(found.residual_moment or 0.0) <= 1e-7 * load
    assert present(found.side_force) == pytest.approx(load * math.tan(math.radians(angle_deg)))
    slips = present(found.side_force) > present(found.side_force_limit) and angle_deg > 0.0
    assert (found.outcome == "slips") is slips
    assert found.holds is not slips
    at_boot = float(found.edge_depth[np.argmin(np.abs(found.station))])
    whole = pieces(found.edge_depth) == 1 and at_boot > 0.0
    if not slips:
        assert (found.outcome == "equilibrium") is whole
    assert (found.turn_radius_boot is None) is (angle_deg == 0.0)


def sweep(
    names: tuple[str, ...],
    hardnesses: tuple[float, ...],
    angles: tuple[float, ...],
    loads: tuple[float, ...],
    ratios: tuple[float, ...],
) -> tuple[Counter[str], list[tuple[float, float, float]]]:
    """Outcomes by their count; hardness, angle and ratio of what was not found."""
    outcomes: Counter[str] = Counter()
    missing = []
    for name, hardness, angle, load, ratio in itertools.product(names, hardnesses, angles, loads, ratios):
        found = carve(read_ski(name), snow(hardness), edge_angle=math.radians(angle), load=load, unloading_ratio=ratio)
        outcomes[found.outcome] += 1
        if found.outcome == "not_converged":
            missing.append((hardness, angle, ratio))
        else:
            check(found, load, angle)
    return outcomes, missing


def test_corners() -> None:
    outcomes, missing = sweep(
        ("slalom",), (0.02, 0.2, 90.0), (0.0, 1.0, 45.0, 80.0), (100.0, 3000.0), (1.0, 10.0, math.inf)
    )
    assert missing == []
    assert min(outcomes[word] for word in ("equilibrium", "slips", "bridges")) > 0


def test_flat_skis_on_ice() -> None:
    """A few stations bear all: the snow's memory grows in more than a hundred stages."""
    _, missing = sweep(("giant-slalom", "carver"), (200.0,), (0.0, 0.2), (3000.0,), (50.0, math.inf))
    assert missing == []


@pytest.mark.slow
@pytest.mark.parametrize("name", ["slalom", "giant-slalom", "carver"])
def test_everything(name: str) -> None:
    """1,080 points a ski, each with an outcome."""
    outcomes, missing = sweep((name,), HARDNESSES, ANGLES_DEG, LOADS, RATIOS)
    assert missing == []
    assert sum(outcomes.values()) == len(HARDNESSES) * len(ANGLES_DEG) * len(LOADS) * len(RATIOS)


@pytest.mark.slow
@pytest.mark.parametrize("clamp", [0.0, 0.1])
@pytest.mark.parametrize("moment_per_load", [-0.1, 0.1])
def test_everything_else(clamp: float, moment_per_load: float) -> None:
    """Another clamp and a moment, on one ski."""
    for hardness, angle, load, ratio in itertools.product(HARDNESSES, ANGLES_DEG, LOADS, (1.0, 10.0)):
        found = carve(
            read_ski("slalom"),
            snow(hardness),
            edge_angle=math.radians(angle),
            load=load,
            moment=moment_per_load * load,
            unloading_ratio=ratio,
            clamp_length=clamp,
        )
        check(found, load, angle)


@pytest.mark.slow
def test_path_grooves() -> None:
    """The groove along the path is found by repetition, which has no end at 70° under small loads: named, and few."""
    missing = []
    for hardness, angle, load, ratio in itertools.product((0.02, 0.2, 1.0), (15.0, 45.0, 70.0), LOADS, (2.0, 10.0)):
        found = carve(
            read_ski("slalom"),
            snow(hardness),
            edge_angle=math.radians(angle),
            load=load,
            unloading_ratio=ratio,
            groove="path",
        )
        if found.outcome == "not_converged":
            missing.append((hardness, angle, load))
        else:
            check(found, load, angle)
    assert len(missing) <= 3
    assert all(angle == 70.0 and load < 1000.0 for _, angle, load in missing)


@pytest.mark.parametrize("angle_deg", [0.0, 10.0, 45.0])
def test_fresh_snow_swallows_the_ski(angle_deg: float) -> None:
    """H_V = 1e-5 N/mm³: a flat ski would need 800 N/(1e4 N/m³ · 0.12 m²) = 0.7 m."""
    found = carve(read_ski("slalom"), snow(1e-5), edge_angle=math.radians(angle_deg), load=800.0, unloading_ratio=10.0)
    assert found.outcome == "sinks"
    assert "30 cm" in found.remedy
    assert found.turn_radius_boot is None
    assert found.edge_depth is None


def test_the_sinking_depth() -> None:
    """A rigid flat ski sinks exactly beyond 0.30 m: F = H_V · area · 0.30 m."""
    ski = plain_ski(bending=1e16, torsional=1e16)
    limit = 1e5 * 1.6 * 0.065 * 0.30
    outcomes = [rest(ski, snow(1e-4), edge_angle=0.0, load=limit * factor).outcome for factor in (0.9999, 1.0001)]
    assert outcomes == ["equilibrium", "sinks"]


def test_weak_snow_slips_exactly_when_asked_for_more_than_it_holds() -> None:
    """The limit is S_f ∫ e ds and e does not depend on S_f: halfway up to the demand it slips, twice it holds."""
    ski, angle = read_ski("giant-slalom"), math.radians(40.0)
    found = carve(ski, snow(0.2, 0.35), edge_angle=angle, load=700.0, unloading_ratio=10.0)
    critical = 0.35 * present(found.side_force) / present(found.side_force_limit)
    for factor, outcome, holds in ((1e-3, "slips", False), (0.9999, "slips", False), (1.0001, "equilibrium", True)):
        other = carve(ski, snow(0.2, critical * factor), edge_angle=angle, load=700.0, unloading_ratio=10.0)
        assert (other.outcome, other.holds) == (outcome, holds)
        assert other.side_force_limit == pytest.approx(present(found.side_force) * factor, rel=1e-9)
        assert np.array_equal(np.asarray(other.edge_depth), np.asarray(found.edge_depth))


def test_ice_is_bridged_by_a_cambered_ski() -> None:
    """A light skier on ice, flat: 7 mm of camber stay open, the ski stands before and behind the boot."""
    found = carve(read_ski("slalom"), snow(90.0), edge_angle=0.0, load=40.0, unloading_ratio=1.0)
    assert found.outcome == "bridges"
    assert pieces(present(found.edge_depth)) == 2
    assert present(found.edge_depth)[np.argmin(np.abs(found.station))] < -1e-4


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("edge_angle", -0.1),
        ("edge_angle", math.radians(86.0)),
        ("load", 0.0),
        ("load", math.nan),
        ("load", math.inf),
        ("unloading_ratio", 0.5),
        ("unloading_ratio", math.nan),
        ("moment", math.inf),
        ("clamp_length", -0.1),
        ("groove", "sideways"),
    ],
)
def test_bad_input_is_named(name: str, value: object) -> None:
    arguments: dict[str, object] = {"edge_angle": 0.5, "load": 800.0, "unloading_ratio": 2.0, name: value}
    with pytest.raises(ParameterError, match=name):
        carve(read_ski("slalom"), snow(0.2), **arguments)  # type: ignore[arg-type]
