"""Laws of glide friction: physics, exact values, and laws of a file."""

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from tests.coded import raises, warns
from tests.key_names import IGNORE_RANGE_WARNING

from skisnow import load_scenario, simulate
from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.forces.friction import (
    LAWS,
    ConstantFriction,
    FrictionLaw,
    LinearFriction,
    QuadraticFriction,
    WaterFilmFriction,
    read_friction_file,
)


@dataclass(frozen=True)
class Sample:
    law: FrictionLaw
    stronger: FrictionLaw
    """The same with every coefficient doubled."""
    outside: tuple[Callable[[], object], ...]


FEW = settings(max_examples=25)
"""For each of many laws."""
SAMPLES = (
    Sample(
        ConstantFriction(0.05), ConstantFriction(0.10), (lambda: ConstantFriction(0.02), lambda: ConstantFriction(0.2))
    ),
    Sample(LinearFriction(0.03, 0.001), LinearFriction(0.06, 0.002), (lambda: LinearFriction(0.05, 0.01),)),
    Sample(
        QuadraticFriction(0.03, 0.0005, 2e-5),
        QuadraticFriction(0.06, 0.001, 4e-5),
        (lambda: QuadraticFriction(0.05, 0.0, 1e-3),),
    ),
    Sample(
        WaterFilmFriction(0.03, 0.04, 1.0, 4e-4),
        WaterFilmFriction(0.06, 0.08, 1.0, 8e-4),
        (lambda: WaterFilmFriction(0.0, 0.04, 1.0, 4e-4),),
    ),
)
EVERY_SAMPLE = pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: type(sample.law).__name__)
SPEEDS = np.linspace(0.0, 40.0, 401)
COMPONENT = st.floats(-40.0, 40.0, allow_subnormal=False)  # those have few digits left for a direction


def test_every_registered_law_has_a_sample() -> None:
    assert {type(sample.law) for sample in SAMPLES} == set(LAWS)


@EVERY_SAMPLE
def test_never_negative_and_continuous_in_speed(sample: Sample) -> None:
    assert np.all(sample.law.coefficient(SPEEDS) >= 0.0)
    coarse, fine = (np.abs(np.diff(sample.law.coefficient(np.linspace(0, 40, n)))).max() for n in (2001, 4001))
    assert fine <= max(0.75 * coarse, 1e-15)


@EVERY_SAMPLE
@FEW
@given(st.floats(0.0, 3000.0), st.tuples(COMPONENT, COMPONENT, COMPONENT))
def test_against_the_sliding_and_of_the_right_size(sample: Sample, load: float, velocity: tuple[float, ...]) -> None:
    force = sample.law.friction_force(load, velocity)
    speed = math.hypot(*velocity)
    power = float(np.dot(force, velocity))
    assert power <= 0.0  # no energy gained on any path
    # 10⁻³⁰⁰ W are nobody's
    assert power == pytest.approx(-float(sample.law.coefficient(speed)) * load * speed, rel=1e-9, abs=1e-300)
    assert np.linalg.norm(np.cross(force, velocity)) <= 1e-9 * load * speed + 1e-300


@EVERY_SAMPLE
@FEW
@given(st.floats(0.0, 2 * math.pi), COMPONENT, COMPONENT)
@example(1.0, 3e-160, 0.0)
def test_rotation_of_the_frame(sample: Sample, turn: float, along: float, across: float) -> None:
    rotation = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    velocity = np.array([along, across])
    turned = sample.law.friction_force(800.0, rotation @ velocity)
    np.testing.assert_allclose(turned, rotation @ sample.law.friction_force(800.0, velocity), atol=1e-9)


@EVERY_SAMPLE
def test_at_rest_and_without_contact_the_force_is_zero(sample: Sample) -> None:
    assert sample.law.friction_force(800.0, [0.0, 0.0]).tolist() == [0.0, 0.0]
    assert not np.any(sample.law.friction_force(-10.0, [1.0, 2.0]))


@EVERY_SAMPLE
@FEW
@given(st.floats(0.0, 40.0))
def test_scaling_with_the_parameters(sample: Sample, speed: float) -> None:
    assert float(sample.stronger.coefficient(speed)) == pytest.approx(2 * float(sample.law.coefficient(speed)))
    one, three = (sample.law.friction_force(load, [speed, 1.0]) for load in (250.0, 750.0))
    assert three == pytest.approx(3 * one)


@EVERY_SAMPLE
def test_scalar_equals_array(sample: Sample) -> None:
    assert sample.law.coefficient(SPEEDS).tolist() == [float(sample.law.coefficient(float(v))) for v in SPEEDS]
    velocity = np.array([[3.0, 4.0], [0.0, 0.0], [-6.0, 8.0]])
    load = np.array([[100.0], [800.0]])
    table = sample.law.friction_force(load, velocity)
    assert table.shape == (2, 3, 2)
    for i, j in np.ndindex(2, 3):
        assert table[i, j].tolist() == sample.law.friction_force(float(load[i, 0]), velocity[j]).tolist()


@EVERY_SAMPLE
def test_a_warning_outside_the_measured_range(sample: Sample) -> None:
    assert sample.outside
    for make in sample.outside:
        with warns(RangeWarning, "outside_measured") as caught:
            make()
        assert [warning.filename for warning in caught] == [__file__]


def test_values_by_hand() -> None:
    assert float(LinearFriction(0.03, 0.001).coefficient(15.0)) == pytest.approx(0.045)
    assert float(QuadraticFriction(0.03, 0.001, -2e-5).coefficient(20.0)) == pytest.approx(0.042)
    assert float(WaterFilmFriction(0.03, 0.04, 2.0, 1e-3).coefficient(2.0)) == pytest.approx(0.052)
    assert float(WaterFilmFriction(0.03, 0.04, 2.0, 1e-3).coefficient(0.0)) == pytest.approx(0.07)


def test_friction_switched_off_is_not_warned_of() -> None:
    assert not np.any(ConstantFriction(0.0).friction_force(800.0, [3.0, 4.0]))


@given(st.floats(0.001, 0.2), st.floats(0.1, 5.0), st.floats(1e-5, 2e-2))
@pytest.mark.filterwarnings(IGNORE_RANGE_WARNING)
def test_the_minimum_is_where_it_is_stated(dry: float, film_speed: float, slope: float) -> None:
    law = WaterFilmFriction(0.02, dry, film_speed, slope)
    best = law.speed_of_least_friction
    grid = np.concatenate([np.linspace(0.0, 100.0, 2001), best * np.linspace(0.9, 1.1, 21)])
    least = float(law.coefficient(best))
    assert least <= float(law.coefficient(grid).min()) * (1 + 1e-12)
    stated = 0.02 + 2 * math.sqrt(dry * slope * film_speed) - slope * film_speed if best > 0 else 0.02 + dry
    assert least == pytest.approx(stated, rel=1e-9)


def test_the_minimum_at_the_ends() -> None:
    assert WaterFilmFriction(0.03, 0.001, 5.0, 1e-3).speed_of_least_friction == 0.0
    assert WaterFilmFriction(0.03, 0.04, 1.0, 0.0).speed_of_least_friction == math.inf
    assert WaterFilmFriction(0.03, 0.0, 1.0, 0.0).speed_of_least_friction == 0.0  # the same at every speed


def test_a_negative_coefficient_is_rejected() -> None:
    law = LinearFriction(0.06, -0.002)
    assert float(law.coefficient(30.0)) == pytest.approx(0.0, abs=1e-15)
    with raises(ParameterError, "negative_friction", fastest=31.0):
        law.coefficient([10.0, 31.0])
    with raises(ParameterError, "negative_friction", fastest=40.0):
        law.friction_force(800.0, [0.0, 40.0])


@pytest.mark.parametrize(
    "make",
    [
        lambda: ConstantFriction(-0.01),
        lambda: LinearFriction(math.nan, 0.0),
        lambda: LinearFriction(0.05, math.inf),
        lambda: QuadraticFriction(0.05, 0.0, math.nan),
        lambda: WaterFilmFriction(0.03, 0.04, 0.0, 1e-3),
        lambda: WaterFilmFriction(0.03, -0.04, 1.0, 1e-3),
        lambda: ConstantFriction(0.05).coefficient(-1.0),
    ],
)
def test_impossible_parameters_are_rejected(make: Callable[[], object]) -> None:
    with pytest.raises(ParameterError):
        make()


# Friction over speed, temperature and liquid water from a file, alone and in a run


STATES = """
source = "a test"
speed_m_per_s = [1, 20]
film_speed_m_per_s = 2
[[state]]
temperature_C = -20
mu = 0.04
dry_mu = 0.08
[[state]]
temperature_C = -4
mu = 0.03
[[state]]
temperature_C = 0
liquid_water_percent = 5
mu = 0.05
viscous_s_per_m = 0.002
"""
KUROIWA = "src/skisnow/samples/files/friction.toml"


def law_file(folder: Path, text: str = STATES) -> Path:
    path = folder / "friction.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_between_states_each_part_is_on_a_line(tmp_path: Path) -> None:
    law = read_friction_file(law_file(tmp_path))
    cold = law.at(-8.0)
    assert (cold.lubricated_friction, cold.dry_friction, cold.film_speed) == pytest.approx((0.0325, 0.02, 2.0))
    assert law.at(-8.0).coefficient(2.0) == pytest.approx(0.0425)
    assert law.at(-40.0) == law.at(-20.0)
    wet = law.at(0.0, 0.5)  # half way from -4 °C to 5 % of water
    assert (wet.lubricated_friction, wet.viscous_slope) == pytest.approx((0.04, 0.001))


def test_published_values_of_skis() -> None:
    law = read_friction_file(KUROIWA)
    assert law.at(None).coefficient([5.0, 22.0]) == pytest.approx([0.03, 0.1], abs=1e-5)
    with warns(RangeWarning, "outside_measured", quantity="speed", value=25.0):
        law.warn_outside(-5.0, 0.0, (6.0, 25.0))


def test_snow_beyond_the_states_is_warned_of(tmp_path: Path) -> None:
    path = law_file(tmp_path)
    law, of = read_friction_file(path), {"source": "a test", "relation": str(path)}
    with warns(RangeWarning, "outside_measured", quantity="snow temperature", value=-25.0, lowest=-20.0, **of):
        law.warn_outside(-25.0, 0.0, (2.0, 10.0))
    with warns(RangeWarning, "outside_measured", quantity="snow temperature", value=0.5, highest=0.0, unit="°C", **of):
        law.warn_outside(0.5, 0.0, (2.0, 10.0))
    with warns(RangeWarning, "outside_measured", quantity="liquid water", value=8.0, highest=5.0, unit="%", **of):
        law.warn_outside(0.0, 8.0, (2.0, 10.0))
    with warns(RangeWarning, "outside_measured", quantity="liquid water", value=-0.5, lowest=0.0):
        law.warn_outside(0.0, -0.5, (2.0, 10.0))
    for beyond in ((0.9, 20.0), (1.0, 20.5)):
        with warns(RangeWarning, "outside_measured", quantity="speed", lowest=1.0, highest=20.0, unit="m/s", **of):
            law.warn_outside(None, 99.0, beyond)  # without a temperature only speeds are compared
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        law.warn_outside(None, 99.0, (1.0, 20.0))
        law.warn_outside(-20.0, 0.0, (1.0, 20.0))
        law.warn_outside(0.0, 5.0, (1.0, 20.0))
        read_friction_file(KUROIWA).warn_outside(-50.0, 30.0, (5.0, 22.0))


def test_a_single_state_may_have_a_temperature(tmp_path: Path) -> None:
    """Then it holds for any snow that has one; without, the temperature has no effect."""
    end = STATES.index("[[state]]\ntemperature_C = -4")
    cold = read_friction_file(law_file(tmp_path, STATES[:end]))
    assert cold.at(-4.0) == cold.at(0.0, 20.0) == WaterFilmFriction(0.04, 0.08, 2.0, 0.0)
    with raises(ParameterError, "missing", path=cold.path):
        cold.at(None)
    with raises(ParameterError, "contradiction", water=1.0, temperature=-4.0):
        cold.at(-4.0, 1.0)
    wet = STATES[:end].replace("-20", "0\nliquid_water_percent = 0.5")
    assert read_friction_file(law_file(tmp_path, wet)).states[0].wetness == 0.5
    with raises(ParameterError, "contradiction"):
        read_friction_file(law_file(tmp_path, wet.replace("temperature_C = 0\n", "")))
    law = read_friction_file(law_file(tmp_path, STATES[:end].replace("temperature_C = -20\n", "")))
    assert law.at(None) == law.at(-30.0) == law.at(0.0, 3.0) == WaterFilmFriction(0.04, 0.08, 2.0, 0.0)


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("mu = 0.04\n", "", "missing"),
        ("mu = 0.04", "mu = 1.4", "out_of_range"),
        ("dry_mu", "dry_m", "unknown_name"),
        ("temperature_C = -20", "temperature_C = -2", "out_of_order"),
        ("temperature_C = -20\n", "", "out_of_order"),
        ("temperature_C = 0\n", "temperature_C = -1\n", "contradiction"),
        ("[1, 20]", "[20, 1]", "out_of_range"),
        ("[[state]]", "[[states]]", "unknown_name"),
        ('source = "a test"', "", "missing"),
        ("[1, 20]", "[1, 20, 30]", "out_of_range"),
        ("[1, 20]", "[20, 20]", "out_of_range"),
        ("temperature_C = -20", "temperature_C = -4", "out_of_order"),
        ("temperature_C = 0\nliquid_water_percent = 5", "temperature_C = -4", "out_of_order"),
        (STATES[STATES.index("[[state]]") :], "", "out_of_order"),
        (STATES[STATES.index("[[state]]") :], "state = 1", "wrong_kind"),
        (STATES[STATES.index("[[state]]") :], "state = [1]", "wrong_kind"),
        (STATES[STATES.index("[[state]]") :], "[state]\nmu = 0.04", "wrong_kind"),
    ],
)
def test_faults_are_named(tmp_path: Path, old: str, new: str, code: str) -> None:
    with raises(ParameterError, code):
        read_friction_file(law_file(tmp_path, STATES.replace(old, new)))


CHANGES = {
    "slope.angle_deg": 0.0,
    "start.heading_deg": 0.0,
    "start.speed_m_per_s": 8.0,
    "sledge.edge_angle_deg": 0.0,
    "drag.drag_area_m2": 0.0,
    "snow.unloading_ratio": 1.0,
    "snow.S_f_N_per_mm2": 0.04,
    "run.duration_s": 1.0,
    "friction.mu_0": 0.0,
}


def test_a_glide_slows_down_by_the_closed_form() -> None:
    """Elastic level snow: v' = -g (μ + c v)."""
    run = simulate(load_scenario("carved-46m", changes=CHANGES | {"friction.law_file": KUROIWA}))
    mu, slope, g = 0.00941, 0.004118, run.scenario.gravity
    fell = math.exp(-g * slope * run.time[-1])
    assert run.speed[-1] == pytest.approx((run.speed[0] + mu / slope) * fell - mu / slope, rel=2e-3)
    assert run.speed[-1] < 0.97 * run.speed[0]


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"friction.law_file": KUROIWA, "friction.mu_0": 0.05}, "contradiction"),
        ({"friction.temperature_C": -5.0}, "contradiction"),
    ],
)
def test_one_friction_counts(changes: dict[str, Any], code: str) -> None:
    with raises(ParameterError, code):
        load_scenario("carved-46m", changes=changes)


def test_a_law_with_temperatures_needs_one(tmp_path: Path) -> None:
    changes = {"friction.mu_0": 0.0, "friction.law_file": str(law_file(tmp_path))}
    with raises(ParameterError, "missing"):
        load_scenario("carved-46m", changes=changes)
    cold = load_scenario("carved-46m", changes=changes | {"friction.temperature_C": -8.0})
    assert cold.contact.friction_at(2.0) == pytest.approx(0.0425)
