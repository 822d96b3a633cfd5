"""Bodies on one, two and three skis: they glide straight, and what carries them adds up."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np
import pytest

from skisnow import Scenario
from skisnow.dynamics import Body, Ended
from tests.present import present

from .sledges import ahead, body_of, given, left_over, on_one_ski, on_three_skis, sledge, snow_forces

FLAT: Final = given(
    sledge__edge_angle_deg=0.0, start__heading_deg=0.0, drag__drag_area_m2=0.0, snow__H_V_N_per_mm3=0.03,
    sledge__centre_of_mass_height_m=0.01,
)  # fmt: skip
KINDS: Final = {1: on_one_ski, 2: body_of, 3: on_three_skis}


@pytest.mark.parametrize(("skis", "body_on"), KINDS.items())
def test_rests_on_all_its_skis(skis: int, body_on: Callable[[Scenario], Body]) -> None:
    body = body_on(FLAT)
    dynamics = sledge(FLAT, body=body)
    assert dynamics.find_equilibrium() < 1e-9
    assert dynamics.part("beam_dofs").shape[0] == len(body.skis) == skis
    normal = snow_forces(dynamics).wrench[:, 2]
    weight = -body.mass * body.gravity[2]
    assert normal.sum() == pytest.approx(weight, rel=1e-4)  # a pitch of 0.01 lets 5e-5 of it act along
    assert normal[0] == pytest.approx(normal[-1], rel=1e-7)
    assert normal.min() > 0.3 * weight / skis
    on_body, on_skis = left_over(dynamics)
    assert np.abs(on_body[2:5]).max() < 1e-5
    assert max(np.abs(each).max() for each in on_skis) < 1e-5


@pytest.mark.parametrize(("skis", "body_on"), KINDS.items())
def test_glides_straight(skis: int, body_on: Callable[[Scenario], Body]) -> None:
    """Down the fall line, slower than g (sin α - μ cos α) says by what pressing the track takes."""
    body, speed, duration = body_on(FLAT), 3.0, 0.3
    dynamics = sledge(FLAT, body=body)
    dynamics.find_equilibrium()
    dynamics.begin(ahead(speed))
    assert dynamics.advance(duration) is Ended.REACHED
    roll = 1e-6  # one ski alone hardly holds it upright
    assert np.abs(dynamics.rotation[:, 1] - [0.0, 1.0, 0.0]).max() < roll
    # a start rolled by 1e-7 or 1e-6 rad drifts by 0.041 m for each rad
    assert abs(dynamics.position[1]) < (0.041 * roll if skis == 1 else 1e-9)
    mu = FLAT.contact.friction
    free = speed * duration + 0.5 * (body.gravity[0] + mu * body.gravity[2]) * duration**2
    assert 0.9 * free < dynamics.position[0] < free
    friction, normal = dynamics.part("work")[1], dynamics.part("work")[2]
    assert friction == pytest.approx(-mu * body.mass * body.gravity[2] * dynamics.position[0], rel=0.02)
    assert normal < 0.0
    sums = [-np.trapezoid(dynamics.part("along")[k][1], dynamics.contact.runners[k].nodes) for k in range(skis)]
    assert sum(sums) == pytest.approx(-body.mass * body.gravity[2], rel=0.2)


ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "methods" / "dynamics.md").read_text("utf-8")
PLAIN = re.sub(r"\$.*?\$", "", re.sub(r"\$\$.*?\$\$", "", PAGE, flags=re.DOTALL), flags=re.DOTALL)
CORE = ROOT / "src" / "core"
FILES = (
    "dynamics/boots.cpp",
    "dynamics/dynamics.cpp",
    "dynamics/moving_boots.cpp",
    "dynamics/statics.cpp",
    "dynamics/steps.cpp",
    "beam/along.hpp",
    "contact/tangent_kernels.hpp",
)
SOURCES = "\n".join((CORE / name).read_text("utf-8") for name in FILES)


def test_marks() -> None:
    """In brackets, without links."""
    in_sources = set(re.findall(r"^// \[([a-z ]+)\]", SOURCES, re.MULTILINE))
    assert {"predict", "static matrix", "observe"} <= in_sources
    assert set(re.findall(r"\[([a-z ]+)\](?!\()", PLAIN)) == in_sources


def test_constants() -> None:
    """Of the error's estimate and of the choice of steps."""
    milne, safety = (re.search(rf"\b{name} = ([\d.]+)", SOURCES) for name in ("MILNE", "SAFETY"))
    assert f"e = {present(milne)[1]}" in PAGE
    assert f"${present(safety)[1]}\\,(\\text{{tolerance}}/e)" in PAGE
    assert "longest * std::exp2(0.25 *" in SOURCES  # four rungs to a factor of two
