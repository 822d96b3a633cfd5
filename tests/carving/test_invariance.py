"""What physics asks whatever the numbers: units, mirror, continuity."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from skisnow.carving.equilibrium import carve, rest
from skisnow.carving.result import Equilibrium
from skisnow.ski import Ski, read_ski
from skisnow.snow.properties import SnowProperties

from .synthetic import snow


def ask(
    ski: Ski,
    *,
    hardness: float = 0.2,
    load: float = 800.0,
    angle: float = math.radians(45.0),
    unloading_ratio: float = 10.0,
    clamp_length: float = 0.3,
    moment: float = 0.0,
) -> Equilibrium:
    return carve(
        ski,
        snow(hardness),
        edge_angle=angle,
        load=load,
        unloading_ratio=unloading_ratio,
        clamp_length=clamp_length,
        moment=moment,
    )


def scaled(ski: Ski, length: float, force: float) -> Ski:
    """The ski in other units of length and force."""
    return replace(
        ski,
        station=ski.station * length,
        width=ski.width * length,
        base_height=ski.base_height * length,
        bending_stiffness=ski.bending_stiffness * force * length**2,
        torsional_stiffness=ski.torsional_stiffness * force * length**2,
        running_length=ski.running_length * length,
        sidecut_length=ski.sidecut_length * length,
        edge_width=ski.edge_width * length,
        sidecut_middle=ski.sidecut_middle * length,
    )


@pytest.mark.parametrize("force", [0.25, 4.0])
@pytest.mark.parametrize("length", [0.5, 0.9])
@pytest.mark.parametrize("ratio", [1.0, 10.0])
def test_units(length: float, force: float, ratio: float) -> None:
    """EI and GJ in force × length², H_V in force/length³, S_f in force/length²: depths and radii follow the length.

    The radius at the boot does not: its 0.4 m do not scale.
    """
    ski = read_ski("slalom")
    plain, other = (
        carve(
            scaled(ski, m, n),
            SnowProperties(0.2e9 * n / m**3, 0.3e6 * n / m**2, "test"),
            edge_angle=math.radians(45.0),
            load=800.0 * n,
            moment=20.0 * n * m,
            unloading_ratio=ratio,
            clamp_length=0.3 * m,
        )
        for m, n in ((1.0, 1.0), (length, force))
    )
    assert plain.edge_depth is not None
    # the same equations but for rounding; Newton's method stops at 1e-11 m and 1e-8 of the load
    assert other.edge_depth == pytest.approx(length * plain.edge_depth, rel=1e-6, abs=1e-9)
    for name, factor in (
        ("turn_radius_chord", length),
        ("contact_length", length),
        ("bearing_length", length),
        ("afterbody_depth_ratio", 1.0),
        ("side_force", force),
        ("side_force_limit", force),
    ):
        assert getattr(other, name) == pytest.approx(factor * getattr(plain, name), rel=1e-6), name
    assert other.bending == pytest.approx(length * np.asarray(plain.bending), rel=1e-6, abs=1e-8)
    assert other.twist == pytest.approx(np.asarray(plain.twist), rel=1e-6, abs=1e-8)


def turned(ski: Ski) -> Ski:
    """The ski with tip and tail exchanged."""
    return replace(
        ski,
        station=-ski.station[::-1],
        **{
            name: getattr(ski, name)[::-1]
            for name in ("width", "base_height", "bending_stiffness", "torsional_stiffness", "mass_per_length")
        },
        sidecut_middle=-ski.sidecut_middle,
    )


def test_mirror() -> None:
    """On elastic snow nothing tells forwards from backwards: a ski turned round under the opposite moment."""
    ski = read_ski("giant-slalom")
    plain = ask(ski, unloading_ratio=1.0, moment=25.0)
    back = ask(turned(ski), unloading_ratio=1.0, moment=-25.0)
    assert plain.edge_depth is not None
    assert back.edge_depth is not None
    assert back.edge_depth[::-1] == pytest.approx(plain.edge_depth, rel=1e-6, abs=1e-9)
    assert back.turn_radius_boot == pytest.approx(plain.turn_radius_boot, rel=1e-7)
    assert plain.afterbody_depth_ratio is not None
    assert back.afterbody_depth_ratio == pytest.approx(1.0 / plain.afterbody_depth_ratio, rel=1e-6)
    assert plain.forebody_load is not None and plain.afterbody_load is not None
    assert back.afterbody_load == pytest.approx(plain.forebody_load, rel=1e-6)
    assert plain.forebody_load + plain.afterbody_load == pytest.approx(800.0, rel=1e-7)
    assert plain.forebody_load > plain.afterbody_load  # the moment presses the tip down


def test_memory_tells_forwards_from_backwards() -> None:
    """The half that follows lies deeper, whichever it is."""
    ski = read_ski("giant-slalom")
    for each in (ski, turned(ski)):
        ratio = ask(each, unloading_ratio=10.0).afterbody_depth_ratio
        assert ratio is not None
        assert ratio > 1.3


@pytest.mark.parametrize("name", ["hardness", "load", "angle", "unloading_ratio", "clamp_length"])
@pytest.mark.parametrize("ratio", [1.0, 10.0])
@pytest.mark.parametrize("hardness", [0.04, 0.2, 10.0])
def test_small_changes_move_little(name: str, ratio: float, hardness: float) -> None:
    """A millionth more of any input moves radius, depth and contact by less than a hundred-thousandth."""
    start = {
        "hardness": hardness,
        "load": 800.0,
        "angle": math.radians(45.0),
        "unloading_ratio": ratio,
        "clamp_length": 0.3,
    }
    ski = read_ski("slalom")
    before, after = ask(ski, **start), ask(ski, **{**start, name: start[name] * (1.0 + 1e-6)})
    assert before.edge_depth is not None
    assert after.edge_depth is not None
    assert after.outcome == before.outcome
    assert after.turn_radius_boot == pytest.approx(before.turn_radius_boot, rel=1e-5)
    assert after.contact_length == pytest.approx(before.contact_length, rel=1e-5)
    assert after.edge_depth.max() == pytest.approx(before.edge_depth.max(), rel=1e-5)


def test_rest_is_a_carve_without_side_force_or_memory() -> None:
    ski = read_ski("slalom")
    standing = rest(ski, snow(0.2), edge_angle=math.radians(45.0), load=800.0)
    carving = ask(ski, unloading_ratio=1.0)
    unbent = carve(
        ski, snow(0.2), edge_angle=math.radians(45.0), load=800.0, unloading_ratio=1.0, side_force_bending=False
    )
    assert standing.edge_depth == pytest.approx(np.asarray(unbent.edge_depth), rel=1e-7, abs=1e-10)
    assert (standing.side_force, standing.holds) == (0.0, True)
    assert standing.turn_radius_boot is None  # it does not turn
    assert carving.turn_radius_boot != pytest.approx(unbent.turn_radius_boot, rel=0.01)


def test_harder_snow_heavier_load() -> None:
    """Depth falls with hardness and grows with the load; the radius moves the other way than the depth.

    From 500 N on: a light load does not bend the ski onto the snow, it stands on tip and tail and cuts deep there.
    """
    ski = read_ski("slalom")
    by_hardness = [ask(ski, hardness=h) for h in (0.04, 0.2, 1.0, 10.0)]
    by_load = [ask(ski, load=f) for f in (500.0, 1000.0, 1500.0, 2000.0)]
    for found, sign in ((by_hardness, -1.0), (by_load, 1.0)):
        depths = [float(np.max(np.asarray(each.edge_depth))) for each in found]
        assert np.all(sign * np.diff(depths) > 0.0)
