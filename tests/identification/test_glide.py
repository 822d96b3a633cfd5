"""Friction and drag from glides, and six parameters at once."""

import math
from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from skisnow.identification import Identification, identify
from skisnow.identification.glide import Glide, passage_times, slope_line
from skisnow.scenario import Plane, Profile, load_scenario
from skisnow.simulation.simulated_run import simulate
from skisnow.track.track import Track
from tests.present import present

from . import glide_in_closed_form as exact

ANGLE = math.radians(12.0)
STATION = np.linspace(5.0, 305.0, 13)


def glide(mu: float, drag: float, speed: float, mu_1: float = 0.0) -> Glide:
    one = np.ones(1)
    return Glide(
        friction=mu * one, friction_by_speed=mu_1 * one, drag_per_mass=drag * one, speed=speed * one, gravity=9.81 * one
    )


@pytest.mark.parametrize("speed", [0.5, 6.0, 14.0])
def test_times_on_a_plane_are_those_of_the_closed_form(speed: float) -> None:
    """Fourth order with 200 steps over 30 s: terms change over ℓ/v > 5 s, (0.15/5)⁴ is 10⁻⁶ of a step's change."""
    mass = 85.0
    wanted = exact.passage_times(STATION, mu=0.05, drag_area=0.5, speed=speed, mass=mass, angle=ANGLE)
    found = passage_times(slope_line(Plane(ANGLE), 0.0), glide(0.05, 0.5 * 1.2 * 0.5 / mass, speed), STATION, 30.0)
    assert found[0] == pytest.approx(wanted, abs=2e-7)


def test_a_start_from_rest_is_no_trouble() -> None:
    """Without drag s = a t²/2."""
    acceleration = 9.81 * (math.sin(ANGLE) - 0.05 * math.cos(ANGLE))
    found = passage_times(slope_line(Plane(ANGLE), 0.0), glide(0.05, 0.0, 0.0), STATION, 20.0)
    assert found[0] == pytest.approx(np.sqrt(2.0 * STATION / acceleration), rel=1e-9)


def test_friction_by_speed_alone_slows_exponentially() -> None:
    """On a level, v' = -μ_1 g v: s = v₀ (1 - e^{-kt})/k with k = μ_1 g, never beyond v₀/k."""
    k = 0.01 * 9.81
    stations = np.array([10.0, 50.0, 90.0, 110.0])
    found = passage_times(slope_line(Plane(0.0), 0.0), glide(0.0, 0.0, 10.0, mu_1=0.01), stations, 30.0)[0]
    assert found[:3] == pytest.approx(-np.log(1.0 - stations[:3] * k / 10.0) / k, abs=1e-6)
    assert found[3] == pytest.approx(150.0 + (110.0 - 10.0 / k) / 0.1, abs=1e-3)  # it crawls on after the wait


def test_in_a_hollow_the_snow_presses_more() -> None:
    """A circular hollow, against dw/ds = 2 g sin α - 2 μ (g cos α + κ w), w = v², integrated over the way.

    The profile has points every 0.25 m: its cubics' curvature is right to some per cent piece by piece and right on the
    whole, which leaves 10⁻⁴ of the time.
    """
    radius, first = 60.0, math.radians(35.0)
    x = np.arange(0.0, 2.0 * radius * math.sin(first) * 0.75, 0.25)
    bottom = radius * math.sin(first)
    height = radius - np.sqrt(radius**2 - (x - bottom) ** 2)
    line = slope_line(Profile(x, height), 0.0)
    stations = np.array([10.0, 20.0, 30.0, 40.0])

    def slopes(way: float, state: Any) -> list[float]:
        alpha = first - way / radius
        w = max(state[0], 1e-12)
        return [2.0 * 9.81 * math.sin(alpha) - 2.0 * 0.1 * (9.81 * math.cos(alpha) + w / radius), w**-0.5]

    wanted = solve_ivp(slopes, (0.0, 40.0), [25.0, 0.0], t_eval=stations, rtol=1e-10, atol=1e-12).y[1]
    found = passage_times(line, glide(0.1, 0.0, 5.0), stations, 5.0)[0]
    assert found == pytest.approx(wanted, rel=1e-4)
    flat = passage_times(slope_line(Plane(first), 0.0), glide(0.1, 0.0, 5.0), stations, 5.0)[0]
    assert np.all(found > flat)


def test_stations_count_along_the_surface() -> None:
    """On a profile that is a plane of 45° the way is √2 times the horizontal distance."""
    x = np.linspace(0.0, 30.0, 61)
    line = slope_line(Profile(x, -x), 10.0)
    assert line.length == pytest.approx(20.0 * math.sqrt(2.0), rel=1e-9)
    on_profile = passage_times(line, glide(0.05, 0.003, 3.0), np.array([5.0, 20.0]), 5.0)
    on_plane = passage_times(slope_line(Plane(math.pi / 4.0), 0.0), glide(0.05, 0.003, 3.0), np.array([5.0, 20.0]), 5.0)
    assert on_profile == pytest.approx(on_plane, abs=1e-8)


def two_planes(first: float, second: float, spacing: float) -> Profile:
    """60 m of one plane and 80 m of another, angles in rad."""
    x = np.arange(0.0, 140.0 + spacing / 2.0, spacing)
    return Profile(x, -math.tan(first) * np.minimum(x, 60.0) - math.tan(second) * np.maximum(x - 60.0, 0.0))


def times_on_two_planes(first: float, second: float, mu: float, drag: float, station: Any) -> Any:
    """On a plane d(v²)/ds = 2 (A - k v²), so v² = A/k + (v₀² - A/k) e^{-2ks}; t = ∫ ds/v.

    At the edge the snow takes m v² dα of pressure only, dv = -μ v dα: v falls by e^{-μ (α₁ - α₂)}.
    """

    def speed(angle: float, begin: float, way: Any) -> Any:
        terminal = 9.81 * (math.sin(angle) - mu * math.cos(angle)) / drag
        return np.sqrt(terminal + (begin**2 - terminal) * np.exp(-2.0 * drag * way))

    def time(angle: float, begin: float, way: float) -> float:
        return float(quad(lambda s: 1.0 / speed(angle, begin, s), 0.0, way, epsabs=1e-12)[0])

    edge = 60.0 / math.cos(first)
    behind = float(speed(first, 6.0, edge)) * math.exp(-mu * (first - second))
    whole = time(first, 6.0, edge)
    return np.array([time(first, 6.0, s) if s <= edge else whole + time(second, behind, s - edge) for s in station])


@pytest.mark.parametrize("spacing", [0.5, 5.0])
def test_times_on_a_profile_of_two_planes(spacing: float) -> None:
    """In a hollow edge and over a slight crest: 0.1 ms for each metre between points, which round the edge."""
    stations = np.array([30.0, 60.0, 90.0, 120.0, 140.0])
    drag = 0.5 * 1.2 * 0.5 / 85.0
    for first, second, mu in ((20.0, 10.0, 0.05), (20.0, 10.0, 0.0), (14.0, 13.0, 0.08), (12.0, 12.2, 0.05)):
        angles = math.radians(first), math.radians(second)
        line = slope_line(two_planes(*angles, spacing), 0.0)
        found = passage_times(line, glide(mu, drag, 6.0), stations, 12.0)[0]
        wanted = times_on_two_planes(*angles, mu, drag, stations)
        assert found == pytest.approx(wanted, abs=1e-4 * spacing), (first, second, mu)


def test_bodies_together_pass_each_edge_for_themselves() -> None:
    """Three at once, each at its own time at every point: as each separately."""
    line = slope_line(two_planes(math.radians(20.0), math.radians(10.0), 1.0), 12.3)
    three = Glide(
        friction=np.array([0.0, 0.05, 0.1]), friction_by_speed=np.zeros(3), drag_per_mass=np.full(3, 0.003),
        speed=np.array([3.0, 6.0, 9.0]), gravity=np.full(3, 9.81),
    )  # fmt: skip
    stations = np.array([10.0, 55.0, 56.0, 100.0, line.length])
    together = passage_times(line, three, stations, 12.0)
    alone = [
        passage_times(line, glide(mu, 0.003, v), stations, 12.0)[0]
        for mu, v in zip(three.friction, three.speed, strict=True)
    ]
    assert together == pytest.approx(np.array(alone), abs=1e-12)


def test_a_body_that_stops_on_a_profile_crawls_on() -> None:
    """Up a plane of 10° v₀ = 5 m/s comes to s = v₀²/2a, a = g (sin 10° + μ cos 10°)."""
    x = np.linspace(0.0, 20.0, 41)
    line = slope_line(Profile(x, math.tan(math.radians(10.0)) * x), 0.0)
    deceleration = 9.81 * (math.sin(math.radians(10.0)) + 0.05 * math.cos(math.radians(10.0)))
    reach = 25.0 / (2.0 * deceleration)
    found = passage_times(line, glide(0.05, 0.0, 5.0), np.array([2.0, 15.0]), 2.0)[0]
    assert found[0] == pytest.approx((5.0 - math.sqrt(25.0 - 4.0 * deceleration)) / deceleration, abs=1e-6)
    assert found[1] == pytest.approx(10.0 + (15.0 - reach) / 0.1, abs=1e-2)


SCENARIO: Final = "carved-46m"
NOISE: Final = 0.02
TOLD: Final = {
    "friction.mu_0": 0.03,
    "sledge.edge_angle_deg": 31.0,
    "start.speed_m_per_s": 7.2,
    "start.heading_deg": -28.0,
    "start.x_m": 0.3,
    "start.y_m": -0.2,
}
OF_THE_SNOW: Final = {
    "friction.mu_0": 0.03,
    "friction.mu_1_s_per_m": 0.002,
    "drag.drag_area_m2": 0.5,
    "snow.S_f_N_per_mm2": 0.4,
    "snow.H_V_N_per_mm3": 0.25,
    "sledge.edge_angle_deg": 31.0,
}


def twin(truth: Mapping[str, float], duration_s: float) -> Track:
    """Ten points a second with 2 cm of noise, stated."""
    run = simulate(load_scenario(SCENARIO, changes={**truth, "run.duration_s": duration_s, "run.output_ms": 10.0}))
    time, place = run.time[::10], run.place[::10].copy()
    place += NOISE * np.random.default_rng(6).standard_normal(place.shape)
    return Track(
        name="twin", time=time, place=place, speed=np.full(len(time), np.nan), time_scale="local", frame="slope",
        place_sd=np.full(place.shape, NOISE), axes="slope",
    )  # fmt: skip


def rms_residual(found: Identification) -> float:
    return float(np.sqrt(np.mean([(fit.residual[:, :2] / fit.sd[:, :2]) ** 2 for fit in found.fits])))


@pytest.mark.slow
def test_six_that_a_track_tells() -> None:
    """Each within four standard errors. The six squares go with χ²: below 22.5 but for one case in a thousand."""
    found = identify(SCENARIO, twin(TOLD, 3.0), list(TOLD))
    assert found.outcome == "converged"
    values = np.array([found[key].value for key in TOLD], dtype=float)
    away = values - np.array(list(TOLD.values()))
    errors = np.array([found[key].standard_error for key in TOLD], dtype=float)
    assert np.all(np.abs(away) < 4.0 * errors)
    assert float(away @ np.linalg.solve(found.covariance, away)) < 22.5
    assert errors[0] < 0.01
    assert errors[1] < 1.0
    assert rms_residual(found) == pytest.approx(1.0, abs=0.35)  # of 62 - 6: ± 0.09


@pytest.mark.slow
def test_six_that_a_track_does_not_tell_are_reported_to_be_untold() -> None:
    """One carved turn on one slope: three that brake alike, two that bend alike, and a strength that holds anyway."""
    found = identify(SCENARIO, twin(OF_THE_SNOW, 4.0), list(OF_THE_SNOW))
    assert found.outcome == "not_identifiable"
    assert rms_residual(found) == pytest.approx(1.0, abs=0.35)  # the track itself is met
    told = "\n".join(found.warnings)
    for one, other in (("mu_0", "drag_area"), ("mu_1", "drag_area"), ("H_V", "edge_angle")):
        assert f"{one} and {other} " in told
    braking = ("mu_0", "mu_1", "drag_area")
    for name in braking:
        others = " and ".join(each for each in braking if each != name)
        assert not found[name].identifiable
        assert f"{name} is left" in told
        assert f" {others} were" in told
    for key, true in OF_THE_SNOW.items():  # wide as they are, the intervals hold the truth
        interval = found[key].interval
        if interval is not None:
            low, high = interval
            assert present(low) < true < present(high)
