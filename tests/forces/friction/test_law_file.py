"""Friction over speed, temperature and liquid water from a file, alone and in a run."""

import math
from pathlib import Path
from typing import Any

import pytest
from tests.coded import raises, warns

from skisnow import load_scenario, simulate
from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.forces.friction import read_friction_file

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
    law = read_friction_file(law_file(tmp_path))
    with warns(RangeWarning, "outside_measured", quantity="snow temperature", value=-25.0):
        law.warn_outside(-25.0, 0.0, (2.0, 10.0))
    with warns(RangeWarning, "outside_measured", quantity="liquid water", value=8.0):
        law.warn_outside(0.0, 8.0, (2.0, 10.0))


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
