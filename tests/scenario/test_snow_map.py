"""Snow that varies over the place: contents of the file, order of precedence, and refusals."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from skisnow import simulate
from skisnow._support.errors import ParameterError
from skisnow._support.units import N_PER_MM2, N_PER_MM3
from skisnow.forces.penetration import LayeredPoint, ProfilePoint
from skisnow.forces.shear import AngleShear, DensityShear, MachiningShear
from skisnow.geometry.surfaces import Grid
from skisnow.scenario import SnowMap, load_scenario, read_snow_map, scenario_file
from skisnow.scenario.sledge import Shear
from skisnow.scenario.snow_map import _corners_that_may_swing, read_snow_layers
from skisnow.simulation.run_setup import laid_out
from skisnow.snow import published_snow
from tests.coded import raises
from tests.forces.friction.test_friction import STATES
from tests.key_names import DAMPING, IGNORE_RANGE_WARNING
from tests.present import present

ALONG = "x_m,H_V_N_per_mm3,S_f_N_per_mm2\n0,0.1,0.3\n10,0.4,0.5\n40,0.4,0.4\n"
OVER = "x_m,y_m,S_f_N_per_mm2\n0,-5,0.2\n0,5,0.4\n20,-5,0.2\n20,5,0.4\n"


def written(folder: Path, text: str) -> Path:
    path = folder / "snow.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_table_along_the_slope_holds_its_values_and_does_not_overshoot(tmp_path: Path) -> None:
    found = read_snow_map(written(tmp_path, ALONG))
    assert found.hardness is not None
    assert found.failure_shear_stress is not None
    x = np.array([-9.0, 0.0, 10.0, 40.0, 90.0])
    np.testing.assert_allclose(found.hardness.values_at(x, 7.0) / N_PER_MM3, [0.1, 0.1, 0.4, 0.4, 0.4], rtol=1e-12)
    np.testing.assert_allclose(found.failure_shear_stress.values_at(x, 0.0) / N_PER_MM2, [0.3, 0.3, 0.5, 0.4, 0.4])
    between = found.hardness.values_at(np.linspace(10.0, 40.0, 99), 0.0) / N_PER_MM3
    np.testing.assert_allclose(between, 0.4, atol=2e-4)  # flat, but for the bend at its start


def test_grid_holds_its_values(tmp_path: Path) -> None:
    found = read_snow_map(written(tmp_path, OVER))
    assert found.hardness is None
    assert float(present(found.failure_shear_stress).values_at(3.0, 0.0)) == pytest.approx(0.3 * N_PER_MM2)
    assert repr(found).startswith("<SnowMap S_f 0.2 to 0.4 N/mm²")


def test_friction_over_the_place_leaves_the_snow_as_it_is(tmp_path: Path) -> None:
    path = written(tmp_path, "x_m,mu_share\n0,0.5\n10,2\n20,2\n")
    given, plain = load_scenario("carved-46m", changes={"snow.map_file": str(path)}), load_scenario("carved-46m")
    values = present(present(given.contact.snow_map).friction_share).values_at(np.array([0.0, 10.0, 15.0]), 3.0)
    np.testing.assert_allclose(values, [0.5, 2.0, 2.0], atol=1e-12)
    assert given.contact.snow == plain.contact.snow
    assert repr(present(given.contact.snow_map)).startswith("<SnowMap mu_share 0.5")


def test_means_stand_for_the_snow_and_what_the_map_has_not_comes_from_the_snow(tmp_path: Path) -> None:
    path = written(tmp_path, "x_m,H_V_N_per_mm3,S_f_N_per_mm2\n0,0.1,0.3\n10,0.4,0.5\n")
    given = scenario_file("carved-46m", changes={"snow.map_file": str(path)})
    snow = given.scenario.contact.snow
    grid = read_snow_map(path)
    assert snow.snow_hardness == grid.mean_hardness
    assert grid.mean_hardness == pytest.approx(0.2336 * N_PER_MM3, rel=0.02)  # exp of the mean of ln over 0.1 to 0.4
    assert snow.failure_shear_stress == grid.mean_stress == pytest.approx(0.4 * N_PER_MM2)
    assert given.values["snow.H_V_N_per_mm3"] == pytest.approx(snow.snow_hardness / N_PER_MM3)
    assert given.values["snow.map_file"] == str(path)
    assert path in given.files
    path = written(tmp_path, OVER)
    contact = load_scenario("carved-46m", changes={"snow.map_file": str(path)}).contact
    assert contact.snow.snow_hardness == 0.2 * N_PER_MM3
    assert contact.snow.failure_shear_stress == pytest.approx(0.3 * N_PER_MM2)
    assert contact.hardness_at(0.0, 0.0) == contact.greatest_hardness == 0.2 * N_PER_MM3
    named = load_scenario("carved-46m", changes={"snow.published": "race-piste"})
    named = named.with_(snow_map=read_snow_map(path))
    assert named.contact.snow.failure_shear_stress == pytest.approx(0.3 * N_PER_MM2)
    assert named.with_(snow="race-piste").contact.snow_map is None


def test_hardness_of_the_map_comes_before_that_of_a_named_snow_and_hardness_where_it_matters(tmp_path: Path) -> None:
    path = written(tmp_path, "x_m,H_V_N_per_mm3\n0,0.1\n10,0.4\n")
    snow = load_scenario(
        "carved-46m", changes={"snow.map_file": str(path), "snow.published": "race-piste"}
    ).contact.snow
    assert snow.snow_hardness == read_snow_map(path).mean_hardness
    assert snow.failure_shear_stress == published_snow("race-piste").failure_shear_stress
    path = written(tmp_path, ALONG)
    changed = {"snow.map_file": str(path), "start.x_m": 10}
    soft, hard = (
        laid_out(load_scenario("carved-46m", changes=each)) for each in ({"snow.map_file": str(path)}, changed)
    )
    assert soft.scenario.contact.hardness_at(0.0, 0.0) == pytest.approx(0.1 * N_PER_MM3)
    assert soft.scenario.contact.greatest_hardness == pytest.approx(0.4 * N_PER_MM3, rel=1e-3)
    above = [setup.dynamics.position[2] for setup in (soft, hard)]
    # set down as a rigid ski would lie: e ~ 1/√H_V, four times as hard is half as deep
    edge = 0.5 * float(soft.scenario.ski.at(0.0).width) * math.sin(soft.scenario.sledge.edge_angle)
    assert (edge - above[0]) / (edge - above[1]) == pytest.approx(2.0, rel=1e-6)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("y_m,H_V_N_per_mm3\n0,1\n", "x_m is missing"),
        ("x_m,y_m\n0,0\n", "S_f_N_per_mm2"),
        ("x_m,H_V_N_per_mm3\n0,1\n1,-2\n", "row 3"),
        ("x_m,H_V_N_per_mm3\n0,1\n1,0\n", "row 3"),
        ("x_m,H_V_N_per_mm3\n0,1\n1,1e308\n", "row 3"),
        ("x_m,H_V_N_per_mm3\n0,1\n1,2e8\n", "row 3"),  # N/m³
        ("x_m,H_V_N_per_mm3\n0,1\n1e308,1\n", "row 3"),
        ("x_m,H_V_N_per_mm3\n0,1\n5e-324,1\n", "row 3"),
        (OVER.replace("20,5,", "20,1e308,"), "row 5"),
        (OVER.replace("20,", "0.0002,").replace("5,0.", ".00005,0."), "looks like degrees"),
        ("x_m,H_V_N_per_mm3\n0,1\n1,soft\n", "row 3"),
        ("x_m,H_V_N_per_mm3\n0,1\n0,2\n", "row 3"),
        ("x_m,H_V_N_per_mm3\n0,1\n", "there are 1 rows"),
        (OVER + "20,5,0.3\n", "row 6"),
    ],
)
def test_a_fault_is_reported_with_its_place(tmp_path: Path, text: str, said: str) -> None:
    path = written(tmp_path, text)
    with pytest.raises(ParameterError, match=said) as error:
        read_snow_map(path)
    assert str(error.value).startswith(str(path))


@pytest.mark.parametrize("step", [0.1, 20.0])
@pytest.mark.parametrize("curve", [[4.0, 4.0, 0.01, 0.01], [2.5, 1.0, 0.01, 3.0], [3.0, 0.01, 1.0, 2.5]])
def test_curve_that_falls_below_zero_is_rejected(curve: list[float], step: float) -> None:
    """From 4 to 0.01 and on as flat: central differences let the curve swing 0.3 below, however far apart they are.

    In the others it does so beside one low place only, before it or behind it.
    """
    values = np.array(curve) * N_PER_MM3
    with pytest.raises(ParameterError, match="goes below 0 at x = "):
        SnowMap(hardness=Grid.along(step * np.arange(4.0), values))
    with pytest.raises(ParameterError, match="goes below 0 at x = 0 m, y = "):
        SnowMap(hardness=Grid(np.zeros(1), step * np.arange(4.0), values[None, :]))


def test_a_map_of_nothing_is_rejected() -> None:
    with raises(ParameterError, "missing"):
        SnowMap()


def test_a_large_map_is_looked_through_as_finely() -> None:
    """Between two of 200 × 200 places, and of 30,000 in a row, as between two of four."""
    values = np.full((200, 200), 4.0)
    values[120:, :] = 0.01
    SnowMap(failure_shear_stress=Grid(np.arange(200.0), np.arange(200.0), values + 0.5))
    with pytest.raises(ParameterError, match=r"S_f .* below 0 at x = 12\d\.\d+ m, y = 0 m"):
        SnowMap(failure_shear_stress=Grid(np.arange(200.0), np.arange(200.0), values))
    row = np.full(30_000, 4.0)
    row[20_000:] = 0.01
    with pytest.raises(ParameterError, match=r"goes below 0 at x = 0 m, y = 20000\.\d+ m"):
        SnowMap(hardness=Grid(np.zeros(1), np.arange(30_000.0), row[None, :]))


def test_given_twice_is_rejected(tmp_path: Path) -> None:
    path = written(tmp_path, ALONG)
    with raises(ParameterError, "contradiction"):
        load_scenario("carved-46m", changes={"snow.map_file": str(path), "snow.H_V_N_per_mm3": 0.3})
    turn = load_scenario("carved-46m", changes={"snow.map_file": str(path)})
    with pytest.raises(ParameterError, match=r"snow\.map_file"):
        turn.with_(S_f_N_per_mm2=0.3)
    assert turn.with_(snow_map=None, S_f_N_per_mm2=0.3).contact.snow.failure_shear_stress == 0.3 * N_PER_MM2


LAYERS = {"snow.layer_depth_mm": 5, "snow.lower_H_V_N_per_mm3": 2}


def test_the_law_of_the_keys() -> None:
    law = load_scenario("carved-46m", changes=LAYERS | {"snow.hardness_growth_per_mm": 0.02}).contact.penetration
    assert isinstance(law, LayeredPoint)
    assert (law.layer_depth, law.lower_hardness, law.hardness_growth) == pytest.approx((5e-3, 2e9, 20.0))
    assert law.snow_hardness == load_scenario("carved-46m").contact.snow.snow_hardness
    assert load_scenario("carved-46m").contact.penetration is None


@pytest.mark.parametrize(
    "changes",
    [
        {"snow.layer_depth_mm": 5},
        {"snow.lower_H_V_N_per_mm3": 2},
        LAYERS | {DAMPING: 0.01},
        LAYERS | {"snow.delayed_share": 0.1},
    ],
)
def test_contradictions(changes: dict[str, Any]) -> None:
    with raises(ParameterError, "contradiction"):
        load_scenario("carved-46m", changes=changes)


def test_a_run_on_equal_layers_is_that_on_one() -> None:
    short = {"run.duration_s": 0.15, "solver.method": "fast"}
    one = load_scenario("carved-46m", changes=short)
    hardness = one.contact.snow.snow_hardness / 1e9
    layers = {"snow.layer_depth_mm": 2, "snow.lower_H_V_N_per_mm3": hardness}
    two = load_scenario("carved-46m", changes=short | layers)
    found, expected = simulate(two), simulate(one)
    np.testing.assert_allclose(found.place, expected.place, atol=1e-6)


@pytest.mark.parametrize(
    ("text", "shares"),
    [
        ("depth_mm,hardness_share\n0,1\n5,10\n", (1.0, 10.0)),
        ("depth_mm,force_N\n0,1\n2,4\n8,9\n", (1.0 / 3.25, 4.0 / 3.25, 9.0 / 3.25)),  # mean (2 + 24)/8
    ],
)
def test_layers_of_a_file(tmp_path: Path, text: str, shares: tuple[float, ...]) -> None:
    path = tmp_path / "layers.csv"
    path.write_text(text, encoding="utf-8")
    given = scenario_file("carved-46m", changes={"snow.layers_file": str(path)})
    law = given.scenario.contact.penetration
    assert isinstance(law, ProfilePoint)
    assert law.shares == pytest.approx(shares)
    assert law.bends == pytest.approx([float(line.split(",")[0]) / 1e3 for line in text.split()[2:]])
    assert given.values["snow.layers_file"] == str(path)
    with raises(ParameterError, "contradiction"):
        load_scenario("carved-46m", changes={"snow.layers_file": str(path), **LAYERS})


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("depth_mm,hardness_share\n1,1\n", "not_rising"),
        ("depth_mm,hardness_share\n0,1\n0,2\n", "not_rising"),
        ("depth_mm,hardness_share\n0,0\n", "out_of_range"),
        ("depth_mm,hardness_share,force_N\n0,1,1\n", "wrong_kind"),
        ("depth_mm\n0\n", "wrong_kind"),
    ],
)
def test_wrong_layers(tmp_path: Path, text: str, code: str) -> None:
    path = tmp_path / "layers.csv"
    path.write_text(text, encoding="utf-8")
    with raises(ParameterError, code):
        read_snow_layers(path)


S_F = 0.4e6


@pytest.mark.filterwarnings(IGNORE_RANGE_WARNING)
def test_each_word_is_its_law_with_the_numbers_given() -> None:
    assert Shear().of(S_F) is None
    assert Shear(law="by-angle", relative_decrease=0.3).of(S_F) == AngleShear(
        flat_shear_stress=S_F, relative_decrease=0.3
    )
    assert Shear(law="by-density", snow_density=400.0).of(S_F) == DensityShear(snow_density=400.0)
    with raises(ParameterError, "missing"):
        Shear(law="by-density")


def test_machining_takes_half_of_the_snows_stress_or_its_own() -> None:
    given = Shear(law="machining", transverse_friction=0.1, least_shear_plane=0.2)
    assert given.of(S_F) == MachiningShear(0.5 * S_F, 0.1, least_shear_plane=0.2)
    own = Shear(law="machining", dynamic_shear_strength=0.1e6, transverse_friction=0.1, least_shear_plane=0.2)
    assert own.of(S_F) == MachiningShear(0.1e6, 0.1, least_shear_plane=0.2)


def test_friction_is_that_of_a_law_file_or_a_line(tmp_path: Path) -> None:
    path = tmp_path / "friction.toml"
    path.write_text(STATES, encoding="utf-8")
    changes: dict[str, Any] = {"friction.mu_0": 0.0, "friction.law_file": str(path), "friction.temperature_C": -8.0}
    cold = load_scenario("carved-46m", changes=changes).contact
    assert cold.friction_at(2.0) == pytest.approx(0.0425)  # half-way between two states of the file
    wet = replace(cold, temperature=0.0, liquid_water=0.5)
    assert wet.glide_friction == present(cold.friction_law).at(0.0, 0.5) != cold.glide_friction
    with raises(ParameterError, "not_supported"):
        cold.require_linear_friction()
    line = load_scenario("carved-46m", changes={"mu_0": 0.05, "mu_1_s_per_m": 0.002}).contact
    line.require_linear_friction()
    assert line.friction_at(3.0) == pytest.approx(0.056)
    assert float(line.glide_friction.coefficient(3.0)) == pytest.approx(0.056)
    for contact, wrong in (
        (line, {"temperature": -5.0}),
        (line, {"liquid_water": 1.0}),
        (cold, {"friction": 0.05}),
        (cold, {"friction_by_speed": 0.001}),
    ):
        with raises(ParameterError, "contradiction"):
            replace(contact, **wrong)  # type: ignore[arg-type]


def test_growing_hardness_alone_is_a_law_and_needs_one_hardness(tmp_path: Path) -> None:
    contact = load_scenario("carved-46m").contact
    growing, hardness = replace(contact, hardness_growth=20.0), contact.snow.snow_hardness
    assert growing.penetration == LayeredPoint(hardness, 10.0, 1e3, hardness, 20.0)
    strength, share = (Grid.along([0.0, 9.0], np.array(values)) for values in ([3e5, 4e5], [0.5, 0.6]))
    assert replace(growing, snow_map=SnowMap(failure_shear_stress=strength, friction_share=share)).is_layered
    (tmp_path / "layers.csv").write_text("depth_mm,hardness_share\n0,1\n5,10\n", encoding="utf-8")
    layers = read_snow_layers(tmp_path / "layers.csv")
    for wrong in ({"snow_map": SnowMap(hardness=Grid.along([0.0, 9.0], np.array([1e8, 2e8])))}, {"layers": layers}):
        with raises(ParameterError, "contradiction"):
            replace(growing, **wrong)


@pytest.mark.parametrize("low", [(2, 1), (1, 2), (0, 0), (4, 3), (0, 3)])
def test_patches_around_a_low_place_may_swing(low: tuple[int, int]) -> None:
    """The patches of which it is a corner; one beyond the last place repeats its edge."""
    values = np.ones((5, 4))
    values[low] = 0.5
    grid: Any = SimpleNamespace(
        values=values, x=10.0 * np.arange(5), y=1.0 * np.arange(4), steps=(10.0, 1.0),
        gradients=lambda *_: (np.full((5, 4), -0.1), np.full((5, 4), 0.5)),
    )  # fmt: skip
    x, y = _corners_that_may_swing(grid)
    rows, columns = ({max(place - 1, 0), place} for place in low)
    assert set(zip((x / 10.0).tolist(), y.tolist(), strict=True)) == {(i, j) for i in rows for j in columns}
    values[low] = 0.51  # a third of 0.1 · 10 + 0.5 · 1 is 0.5
    assert len(_corners_that_may_swing(grid)[0]) == 0
