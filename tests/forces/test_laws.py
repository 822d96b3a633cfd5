"""Cutting resistance, drag, and the pages of the laws."""

import importlib
import importlib.util
import math
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.image import imread
from tests.coded import raises, warns

from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.forces import friction, penetration, shear
from skisnow.forces.drag import AirDrag
from skisnow.forces.friction import ConstantFriction
from skisnow.forces.penetration import AreaLaw, BilinearLaw, HypoplasticPoint, MeanPressureLaw
from skisnow.forces.shear import MachiningShear, cutting_stress, cutting_thrust

from ..versions import SAME_PIXELS

DRAG = AirDrag(drag_area=0.42, air_density=1.2)
COMPONENT = st.floats(-50.0, 50.0)


@given(st.floats(0.0, 2 * math.pi), COMPONENT, COMPONENT, COMPONENT, COMPONENT)
def test_rotation_of_the_frame(turn: float, along: float, across: float, tail: float, side: float) -> None:
    """Drag taken component by component would fail this: √2 too little at 45°."""
    rotation = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    velocity, wind = np.array([along, across]), np.array([tail, side])
    turned = DRAG.force(rotation @ velocity, wind=rotation @ wind)
    np.testing.assert_allclose(turned, rotation @ DRAG.force(velocity, wind=wind), atol=1e-9)


@given(COMPONENT, COMPONENT, COMPONENT)
def test_size_and_direction(x: float, y: float, z: float) -> None:
    velocity = np.array([x, y, z])
    force = DRAG.force(velocity)
    speed = math.hypot(x, y, z)
    # a square that underflows is nobody's wind
    assert float(np.linalg.norm(force)) == pytest.approx(0.5 * 1.2 * 0.42 * speed**2, rel=1e-9, abs=1e-140)
    assert float(force @ velocity) <= 0.0


def test_wind() -> None:
    """With the wind at its own speed a body feels nothing; against 10 m/s it feels 20."""
    assert DRAG.force([10.0, 0.0], wind=[10.0, 0.0]).tolist() == [0.0, 0.0]
    assert DRAG.force([10.0, 0.0], wind=[-10.0, 0.0]) == pytest.approx(4 * DRAG.force([10.0, 0.0]))
    assert DRAG.force([0.0, 0.0], wind=[0.0, 5.0])[1] == pytest.approx(0.5 * 1.2 * 0.42 * 25)


def test_scaling_and_arrays() -> None:
    velocity = np.array([[[3.0, 4.0], [0.0, 0.0]], [[-6.0, 8.0], [1.0, 1.0]]])
    table = DRAG.force(velocity)
    assert table.shape == velocity.shape
    for place in np.ndindex(2, 2):
        assert table[place].tolist() == DRAG.force(velocity[place]).tolist()
    assert AirDrag(0.63, 1.2).force([3.0, 4.0]) == pytest.approx(1.5 * DRAG.force([3.0, 4.0]))
    assert AirDrag(0.42, 0.6).force([3.0, 4.0]) == pytest.approx(0.5 * DRAG.force([3.0, 4.0]))


def test_speed_over_the_path_on_a_plane_slope() -> None:
    """v²(s) = v∞² + (v₀² - v∞²) exp(-s/ℓ), ℓ = m/(ρ C_dA): friction and drag together, by Runge-Kutta over s."""
    mass, gravity, slope, start = 80.0, 9.81, math.radians(15.0), 5.0
    friction = ConstantFriction(0.05)

    def gain(v2: float) -> float:
        v = [math.sqrt(v2), 0.0]
        normal = mass * gravity * math.cos(slope)
        force = mass * gravity * math.sin(slope) + friction.friction_force(normal, v)[0] + DRAG.force(v)[0]
        return 2.0 * float(force) / mass

    v2, step = start**2, 0.5
    for _ in range(400):
        k1 = gain(v2)
        k2 = gain(v2 + step / 2 * k1)
        k3 = gain(v2 + step / 2 * k2)
        v2 += step / 6 * (k1 + 2 * k2 + 2 * k3 + gain(v2 + step * k3))
    length = mass / (1.2 * 0.42)
    final = 2 * mass * gravity * (math.sin(slope) - 0.05 * math.cos(slope)) / (1.2 * 0.42)
    # the step is 1/300 of the length: fourth order leaves some 10⁻¹²
    assert v2 == pytest.approx(final + (start**2 - final) * math.exp(-200.0 / length), rel=1e-9)


@pytest.mark.parametrize("drag_area", [0.1, 0.9])
def test_a_warning_outside_the_measured_range(drag_area: float) -> None:
    with warns(RangeWarning, "outside_measured", unit="m²", lowest=0.23, highest=0.66) as caught:
        AirDrag(drag_area, 1.2)
    assert caught[0].filename == __file__


def test_no_drag_is_not_warned_of() -> None:
    assert not np.any(AirDrag(0.0, 1.2).force([30.0, 0.0]))


@pytest.mark.parametrize(("drag_area", "air_density"), [(-0.1, 1.2), (0.4, 0.0), (math.nan, 1.2), (0.4, math.inf)])
def test_impossible_parameters_are_rejected(drag_area: float, air_density: float) -> None:
    with raises(ParameterError, "out_of_range", kind="AirDrag"):
        AirDrag(drag_area, air_density)


ANGLES_DEG = (30.0, 45.0, 60.0, 75.0, 90.0)


@pytest.mark.parametrize(("angle_deg", "depth_mm"), list(zip(ANGLES_DEG, (1.25, 2.01, 2.85, 3.82, 4.99), strict=True)))
def test_worked_example(angle_deg: float, depth_mm: float) -> None:
    """900 N on 1.7 m of edge, S = 0.05 N/mm², μ_t = 0.06: the depth that balances."""
    stress = float(cutting_stress(0.05e6, math.radians(angle_deg), transverse_friction=0.06))
    assert 900.0 / (1.7 * stress) * 1e3 == pytest.approx(depth_mm, abs=0.005)


def test_a_vertical_blade_without_friction_cuts_at_twice_the_shear_strength() -> None:
    assert float(cutting_stress(1.0, math.pi / 2, transverse_friction=0.0)) == pytest.approx(2.0)
    # Eqn 13 at 90° is 0.0344 N/mm² as printed, so S = 0.0172
    assert float(cutting_stress(0.0172e6, math.pi / 2, transverse_friction=0.0)) == pytest.approx(0.0344e6)


@pytest.mark.parametrize("angle_deg", ANGLES_DEG)
def test_shear_stress_on_the_shear_plane_is_the_strength(angle_deg: float) -> None:
    """Equilibrium of the chip: force along the plane over its area L e/sin φ equals S."""
    friction = 0.2
    phi = (math.radians(angle_deg) - math.atan(friction)) / 2
    cut = float(cutting_stress(3.0, math.radians(angle_deg), transverse_friction=friction))
    thrust = float(cutting_thrust(3.0, math.radians(angle_deg), transverse_friction=friction))
    assert (cut * math.cos(phi) - thrust * math.sin(phi)) * math.sin(phi) == pytest.approx(3.0)


DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE = (DOCS / "methods" / "forces.md").read_text(encoding="utf-8")
REFERENCE: str = importlib.import_module("api_reference").reference()
LAWS = (*penetration.LAWS, *penetration.POINT_LAWS, *shear.LAWS, *friction.LAWS)
LIMIT = 60_000
"""Bytes of a figure: a page of the docs stays light."""


def drawing_script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("figures_of_forces", DOCS / "figures_of_forces.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
def test_every_law_has_a_row_and_a_reference(law: type) -> None:
    assert f"| `{law.__name__}` |" in PAGE
    assert f"autoclass:: {law.__module__.rsplit('.', 1)[0]}.{law.__name__}\n" in REFERENCE


@pytest.mark.parametrize(
    ("law", "check"),
    [
        (BilinearLaw, "zero at zero depth"),
        (AreaLaw, "zero at zero depth"),
        (MeanPressureLaw, "zero at zero depth"),
        (HypoplasticPoint, "continuous in depth"),
        (MachiningShear, "finite at every edge angle"),
    ],
)
def test_every_exception_is_in_the_table_with_a_reason(law: type, check: str) -> None:
    cells = [line.split("|") for line in PAGE.splitlines() if line.startswith(f"| `{law.__name__}`")]
    assert [row for row in cells if row[2].strip() == check and len(row[3]) > 20]


FIGURES = sorted(path.stem for path in (DOCS / "_static" / "forces").iterdir())


def test_every_figure_is_drawn_and_shown() -> None:
    assert sorted(drawing_script().FIGURES) == FIGURES
    for name in FIGURES:
        assert f"](../_static/forces/{name}.png)" in PAGE
        assert (DOCS / "_static" / "forces" / f"{name}.png").stat().st_size < LIMIT


@SAME_PIXELS
@pytest.mark.parametrize("name", FIGURES)
def test_the_committed_figure_is_that_which_the_script_draws(name: str, tmp_path: Path) -> None:
    """Compared as pictures: another version of the drawing library may move an edge by a pixel."""
    drawing_script().draw(tmp_path, [name])
    drawn, committed = (imread(folder / f"{name}.png") for folder in (tmp_path, DOCS / "_static" / "forces"))
    assert drawn.shape == committed.shape
    assert float(np.mean(np.abs(drawn - committed))) < 0.01
