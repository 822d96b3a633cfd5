"""How a body leans, and what would be in balance, of motions that are known in closed form."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

from skisnow._support.errors import ParameterError
from skisnow.scenario import Profile, load_scenario
from skisnow.simulation.moving_boots import BootHistory
from skisnow.simulation.run import Run
from skisnow.simulation.run_forces import balance_of

from .straight_run import STRAIGHT, straight_run

FloatArray = npt.NDArray[np.float64]

ANGLE = math.radians(20.0)
PLAIN = load_scenario("carved-46m", changes={**STRAIGHT, "angle_deg": 20.0})
TIME = np.linspace(0.0, 2.0, 401)
SPEED, RADIUS, HEIGHT = 9.0, 15.0, 0.9
STANCE, LEFT, RIGHT = 0.4, 300.0, 500.0
INNER = slice(4, -4)


def moved(*, lean: float = 0.4, rise: float = 0.0, roll: float = 0.0, load: float = 1.0) -> Run:
    """The centre of mass on a circle to the left, up and down by `rise` (m), the body rolling by `roll` (rad).

    Its skis stand to its right, where it leans to, and bear LEFT and RIGHT (N), or a share of it.
    """
    heading = SPEED / RADIUS * TIME - 0.5
    ahead, to_left = (np.stack([np.cos(a), np.sin(a), 0.0 * a], axis=1) for a in (heading, heading + math.pi / 2.0))
    up = np.broadcast_to([0.0, 0.0, 1.0], ahead.shape)
    centre = RADIUS * np.stack([np.sin(heading), -np.cos(heading), 0.0 * heading], axis=1)
    height = HEIGHT + rise * np.sin(5.0 * TIME)
    middle = centre - HEIGHT * math.tan(lean) * to_left
    tilt = roll * np.sin(4.0 * TIME)[:, None]
    body = np.stack([ahead, np.cos(tilt) * to_left - np.sin(tilt) * up, np.sin(tilt) * to_left + np.cos(tilt) * up], 2)
    flat = np.stack([ahead, to_left, up], axis=1)
    run = straight_run(PLAIN)
    return replace(
        run,
        time=TIME,
        place=middle,
        attitude=body,
        boots=BootHistory(
            place=np.stack([middle + side * STANCE / 2.0 * to_left for side in (1.0, -1.0)], axis=1),
            axes=np.repeat(flat[:, None], 2, axis=1),
            own_force=np.broadcast_to(load * np.array([[0.0, 0.0, LEFT], [0.0, 0.0, RIGHT]]), (len(TIME), 2, 3)),
            own_moment=np.zeros((len(TIME), 2, 3)),
            centre_of_mass=centre + height[:, None] * up,
        ),
    )


def needed(run: Run, rise: float = 0.0) -> tuple[FloatArray, FloatArray]:
    """To the left and off the snow, what the skis give a kilogram of a body on that path (m/s²)."""
    heading = SPEED / RADIUS * TIME - 0.5
    g = run.scenario.gravity
    to_left = SPEED**2 / RADIUS + g * math.sin(ANGLE) * np.sin(heading)
    return to_left, g * math.cos(ANGLE) - 25.0 * rise * np.sin(5.0 * TIME)


def test_lean_and_pressure_are_those_of_the_places_and_forces() -> None:
    """The load's centre lies where it balances 300 N on the left and 500 N on the right ski, 0.4 m apart."""
    found = balance_of(moved())
    aside = HEIGHT * math.tan(0.4)
    pressure = STANCE / 2.0 * (LEFT - RIGHT) / (LEFT + RIGHT)
    assert found.lean == pytest.approx(np.full(len(TIME), 0.4))
    assert found.pressure == pytest.approx(np.full(len(TIME), pressure))
    assert found.pressure_lean == pytest.approx(np.full(len(TIME), math.atan2(aside - pressure, HEIGHT)))
    assert found.leg == pytest.approx(np.full(len(TIME), math.hypot(aside, HEIGHT)))
    assert found.load == pytest.approx(np.broadcast_to([LEFT, RIGHT], (len(TIME), 2)))
    assert found.angulation == pytest.approx(np.full(len(TIME), -0.4))  # flat skis under a body that leans


def test_skis_in_a_plough_lean_no_less() -> None:
    """Each turned by 30 degrees: the mean of their axes is shorter than either, and the way ahead is the same."""
    run = moved()
    assert run.boots is not None
    turned = []
    for ski, angle in enumerate((-math.pi / 6.0, math.pi / 6.0)):
        own = run.boots.axes[:, ski]
        ahead = math.cos(angle) * own[:, 0] + math.sin(angle) * own[:, 1]
        turned.append(np.stack([ahead, np.cross(own[:, 2], ahead), own[:, 2]], axis=1))
    found = balance_of(replace(run, boots=replace(run.boots, axes=np.stack(turned, axis=1))))
    assert found.lean == pytest.approx(np.full(len(TIME), 0.4))
    assert found.pressure == pytest.approx(balance_of(run).pressure)


def test_a_moment_of_the_skis_moves_the_pressure() -> None:
    """40 N m about the axis ahead, under 800 N: 5 cm, to the left as a heavier left ski."""
    run = moved()
    assert run.boots is not None
    moment = np.zeros((len(TIME), 2, 3))
    moment[:, :, 0] = 20.0
    turned = balance_of(replace(run, boots=replace(run.boots, own_moment=moment)))
    assert turned.pressure - balance_of(run).pressure == pytest.approx(np.full(len(TIME), 40.0 / 800.0))


def test_skis_that_hardly_bear_have_no_centre_of_pressure() -> None:
    for share, known in ((0.0624, False), (0.0626, True)):  # of 800 N: 50 N
        found = balance_of(moved(load=share))
        assert np.isfinite(found.pressure).all() == np.isfinite(found.pressure_lean).all() == known
        assert np.isfinite(found.pressure).any() == known
    assert np.isfinite(balance_of(moved(load=0.0)).lean).all()


def test_a_body_in_balance_leans_as_what_its_skis_give_it() -> None:
    """tan Ψ = (v²/R + g sin α sin θ)/(g cos α), with θ from the fall line: uphill of it the slope helps."""
    run = moved()
    found = balance_of(run)
    aside, up = needed(run)
    assert np.tan(found.balanced_lean[INNER]) == pytest.approx((aside / up)[INNER], rel=1e-3)
    assert np.tan(found.rolling_lean[INNER]) == pytest.approx((aside / up)[INNER], rel=1e-3)
    for each in (found.balanced_lean, found.rolling_lean):
        assert np.isnan(each[[0, 1, -2, -1]]).all()
        assert np.isfinite(each[2:-2]).all()


def test_roll_and_rise_take_their_part() -> None:
    """I φ''/(m z) to the left, and the rise of the centre of mass beside gravity."""
    run = moved(rise=0.05, roll=0.2)
    found = balance_of(run)
    aside, up = needed(run, rise=0.05)
    sledge = run.scenario.sledge
    height = HEIGHT + 0.05 * np.sin(5.0 * TIME)
    rolled = -16.0 * 0.2 * np.sin(4.0 * TIME) * sledge.inertia[0] / (sledge.mass * height)
    assert np.max(np.abs(rolled)) > 0.1
    assert np.tan(found.rolling_lean[INNER]) == pytest.approx(((aside + rolled) / up)[INNER], rel=2e-3)
    steady = aside / (run.scenario.gravity * math.cos(ANGLE))
    assert np.tan(found.balanced_lean[INNER]) == pytest.approx(steady[INNER], rel=2e-3)


def test_a_straight_profile_is_a_plane() -> None:
    """The same motion in axes with z upwards: every number is the same."""
    run = moved(rise=0.05, roll=0.2)
    assert run.boots is not None
    c, s = math.cos(ANGLE), math.sin(ANGLE)
    level = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])  # rows: the slope's axes
    x = np.linspace(-60.0, 60.0, 25)
    other = replace(
        run,
        scenario=run.scenario.with_(slope=Profile(x, -math.tan(ANGLE) * x)),
        place=run.place @ level,
        attitude=level.T @ run.attitude,
        boots=replace(
            run.boots,
            place=run.boots.place @ level,
            axes=run.boots.axes @ level,
            centre_of_mass=run.boots.centre_of_mass @ level,
        ),
    )
    one, two = balance_of(run), balance_of(other)
    for name in ("lean", "pressure_lean", "balanced_lean", "rolling_lean", "leg", "pressure", "load"):
        assert getattr(two, name) == pytest.approx(getattr(one, name), rel=1e-9, abs=1e-9, nan_ok=True), name


def test_of_a_few_moments_nothing_is_in_balance_and_without_boots_nothing_is_known() -> None:
    run = moved()
    assert run.boots is not None
    for n, known in ((4, 0), (5, 1)):
        few = replace(
            run,
            time=TIME[:n],
            place=run.place[:n],
            attitude=run.attitude[:n],
            boots=BootHistory(**{name: getattr(run.boots, name)[:n] for name in BootHistory.__slots__}),
        )
        found = balance_of(few)
        assert np.isfinite(found.lean).all()
        assert [int(np.isfinite(each).sum()) for each in (found.balanced_lean, found.rolling_lean)] == [known, known]
    with pytest.raises(ParameterError, match="boots"):
        balance_of(straight_run(PLAIN))
