"""Scenarios from files and by name, with changes: SI values, equivalent forms, and refusals."""

import json
import math
import re
from pathlib import Path

import pytest

from skisnow import scenario_names
from skisnow._support.errors import ParameterError
from skisnow.scenario import Plane, Profile, load_scenario, scenario_file, scenario_text, scenario_values
from skisnow.scenario.keys import SCENARIO_KEYS, parse_change
from skisnow.scenario.reading import build_input, load_input
from skisnow.scenario.resolution import CONDITIONS
from skisnow.scenario.skier import Skier
from tests.coded import Coded, coded, raises
from tests.key_names import EDGE_ANGLE

PROFILE = "x,y\n" + "".join(f"{x},{-0.2 * x}\n" for x in range(0, 60, 3))


def written(folder: Path, *, replaced: dict[str, str] | None = None) -> Path:
    """The text of carved-46m, some lines replaced by others, as a file."""
    lines = scenario_text("carved-46m").splitlines()
    for start, new in (replaced or {}).items():
        assert any(line.startswith(start) for line in lines), start
        lines = [new if line.startswith(start) else line for line in lines]
    path = folder / "mine.toml"
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def test_built_in_scenario_in_si() -> None:
    """The contract's numbers of carved-46m, converted by hand."""
    scenario = load_scenario("carved-46m")
    assert isinstance(scenario.slope, Plane)
    assert scenario.slope.angle == pytest.approx(0.17453292519943295, rel=1e-15)
    assert scenario.contact.snow.snow_hardness == 2e8
    assert scenario.contact.snow.failure_shear_stress == 5e5
    assert scenario.contact.unloading_ratio == 10.0
    assert scenario.contact.friction == 0.01
    assert scenario.air.drag_area == 0.42
    assert scenario.sledge.mass == 80.0
    assert scenario.sledge.stance_width == 0.5
    assert scenario.sledge.edge_angle == pytest.approx(0.5235987755982988, rel=1e-15)
    assert scenario.start.speed == 7.0
    assert scenario.start.heading == pytest.approx(-0.5235987755982988, rel=1e-15)
    assert scenario.stop.duration == 5.0
    assert scenario.stop.length is None
    assert scenario.solver.step == pytest.approx(5e-4, rel=1e-15)
    assert scenario.ski.name == "giant-slalom"
    assert scenario.gravity == 9.81


@pytest.mark.parametrize(
    ("name", "length", "ski"), [("giant-slalom-67m", 67.0, "giant-slalom"), ("carver-42m", 42.0, "carver")]
)
def test_runs_named_after_the_paper_have_its_lengths_and_kinds_of_ski(name: str, length: float, ski: str) -> None:
    scenario = load_scenario(name)
    assert (scenario.stop.length, scenario.stop.duration, scenario.ski.name) == (length, None, ski)


@pytest.mark.parametrize("name", scenario_names())
def test_every_value_of_a_built_in_scenario_says_where_it_is_from(name: str) -> None:
    lines = [line for line in scenario_text(name).splitlines() if re.match(r"\w+ = ", line)]
    for line in lines:
        key, comment = line.split(" = ")[0], line.partition("#")[2].strip()
        assert comment.startswith(("ours", "default", "as published", "of the catalogue")), line
        if comment.startswith("default"):
            (full,) = [each for each in SCENARIO_KEYS if each.endswith(f".{key}")]
            assert load_input(name).values[full] == SCENARIO_KEYS[full].default
    left_out = {"elements", "line_spacing_mm", "footprint_stiffness_N_per_mm2", "camber_rounding_mm"}
    left_out |= {"snow_density_kg_per_m3", "dynamic_shear_strength_N_per_mm2"}  # of laws other than the default
    left_out |= {"layer_depth_mm", "lower_H_V_N_per_mm3", "law_file", "temperature_C", "liquid_water_percent"}
    given = {line.split(" = ")[0] for line in lines}
    assert not left_out & given  # from ski and snow
    absent = ("course.",) if "\n[skier]\n" in scenario_text(name) else ("course.", "skier.")
    no_course = {full for full in SCENARIO_KEYS if not full.startswith(absent)}
    every = {full.split(".")[1] for full in no_course} - left_out
    other_ways = {"profile", "profile_gap", "grid", "smooth_m", "origin_x_m", "origin_y_m"}
    other_ways |= {"results", "site", "map_file", "layers_file", "file"}
    values = scenario_values(load_scenario(name))
    other_ways |= {key.split(".")[1] for key, needed in CONDITIONS.items() if not needed.holds(values.get(needed.key))}
    snow = {"published"} if "H_V_N_per_mm3" in given else {"H_V_N_per_mm3", "S_f_N_per_mm2"}
    stop = {"length_m"} if "duration_s" in given else {"duration_s"}
    assert given == every - other_ways - snow - stop


def test_changes_by_full_name_and_without_section() -> None:
    scenario = load_scenario("carved-46m", changes={"sledge.mass_kg": 90, "inertia_kg_m2": [5, 6, 7]})
    assert (scenario.sledge.mass, scenario.sledge.inertia) == (90.0, (5.0, 6.0, 7.0))


@pytest.mark.parametrize(
    ("word", "change"),
    [
        ("sledge.mass_kg=90", ("sledge.mass_kg", 90)),
        ("mass_kg = 90.5", ("sledge.mass_kg", 90.5)),
        ("inertia_kg_m2=[5, 6, 7]", ("sledge.inertia_kg_m2", [5, 6, 7])),
        ("snow.published=race-piste", ("snow.published", "race-piste")),
        ('snow.published="race-piste"', ("snow.published", "race-piste")),
        ("ski.file=a=b.toml", ("ski.file", "a=b.toml")),
        ("snow.site=7", ("snow.site", "7")),
        ("compaction_resistance=false", ("snow.compaction_resistance", False)),
        ("mass_kg=heavy", ("sledge.mass_kg", "heavy")),
    ],
)
def test_change_on_a_command_line(word: str, change: tuple[str, object]) -> None:
    assert parse_change(word) == change


def test_a_word_without_an_equals_sign_changes_nothing() -> None:
    with raises(ParameterError, "changes_nothing", text="=90"):
        parse_change("=90")
    with raises(ParameterError, "changes_nothing", text="mass_kg 90"):
        parse_change("mass_kg 90")


def test_a_first_turn_that_never_comes_is_rejected() -> None:
    with raises(ParameterError, "out_of_range", low=0.0, name="skier.first_turn_s", value="inf", unit="s"):
        Skier(first_turn=math.inf)


@pytest.mark.parametrize("word", ["mass_kg=90,5", "sledge.mass_kg = 90,5", "mu_0=0,04"])
def test_a_decimal_comma_is_reported_how_to_write(word: str) -> None:
    with pytest.raises(ParameterError, match=f"Write {word.replace(',', '.')}$"):
        parse_change(word)


@pytest.mark.parametrize(
    "word", ["mass_kg=80\nspeed_m_per_s=3", "mass_kg=80\n[x]", "mass_kg=" + "[" * 3000, "mass_kg=1" + "0" * 400]
)
def test_change_that_is_not_one_value_is_rejected_in_a_short_sentence(word: str) -> None:
    with raises(ParameterError, "wrong_kind", name="sledge.mass_kg") as error:
        load_scenario("carved-46m", changes=dict([parse_change(word)]))
    assert len(str(error.value)) < 200


def test_named_snow_takes_the_place_of_numbers_and_back() -> None:
    named = load_scenario("carved-46m", changes={"published": "spring-snow"})
    assert "spring snow" in named.contact.snow.source
    # 2 × 0.0036/cos² 55° and 0.063/sin² 55°, by hand
    assert named.contact.snow.snow_hardness == pytest.approx(0.0218852e9, rel=1e-5)
    assert named.contact.snow.failure_shear_stress == pytest.approx(0.0938885e6, rel=1e-5)
    numbers = {"H_V_N_per_mm3": 1.0, "S_f_N_per_mm2": 0.1}
    assert load_scenario("carver-42m", changes=numbers).contact.snow.snow_hardness == 1e9


def test_elastic_snow_needs_no_unloading_ratio_and_takes_no_other() -> None:
    elastic = {"penetration": "elastic"}
    assert load_scenario("carved-46m", changes=elastic).contact.unloading_ratio == 1.0
    assert load_scenario("carved-46m", changes={**elastic, "unloading_ratio": 1}).contact.unloading_ratio == 1.0
    with raises(ParameterError, "contradiction", ratio=2.0):
        load_scenario("carved-46m", changes={**elastic, "unloading_ratio": 2})


def test_drag_acts_at_the_centre_of_mass_where_nothing_else_is_reported(tmp_path: Path) -> None:
    path = written(
        tmp_path, replaced={"centre_of_pressure": "", "centre_of_mass_height": "centre_of_mass_height_m = 0.2"}
    )
    assert load_scenario(path).air.centre_of_pressure_height == 0.2


def test_paths_begin_at_the_file_and_those_of_changes_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "slope").mkdir()
    (tmp_path / "slope" / "down.csv").write_text(PROFILE, encoding="utf-8")
    path = written(tmp_path, replaced={"kind": 'kind = "profile"', "angle_deg": 'profile = "slope/down.csv"'})
    scenario = load_scenario(path)
    assert isinstance(scenario.slope, Profile)
    assert scenario.slope.gradients(20.0) == pytest.approx(-0.2, abs=1e-12)
    monkeypatch.chdir(tmp_path / "slope")
    changes = {"slope.kind": "profile", "slope.profile": "down.csv"}
    found = scenario_file("carved-46m", changes=changes)
    assert isinstance(found.scenario.slope, Profile)
    assert [file.resolve() for file in found.files] == [tmp_path / "slope" / "down.csv"]
    assert found.values["slope.angle_deg"] is None


def test_snow_and_ski_of_files(tmp_path: Path) -> None:
    rows = [{"used": True, "site": "A", "H_V_N_per_mm3": value} for value in (0.1, 0.4)]
    shear = [{"used": True, "site": "A", "S_f_N_per_mm2": value} for value in (0.3, 0.5)]
    results = {"penetration": {"experiments": rows}, "shear": {"experiments": shear}}
    (tmp_path / "results.json").write_text(json.dumps(results), encoding="utf-8")
    shape = "length_mm = 1600\nrunning_length_mm = 1400\nsidecut_length_mm = 1400\n"
    widths = "tip_width_mm = 100\nwaist_width_mm = 70\ntail_width_mm = 95\nmass_kg = 2\nrigid = true\n"
    (tmp_path / "ski.toml").write_text(f'name = "mine"\n{shape}{widths}', encoding="utf-8")
    path = written(
        tmp_path, replaced={"H_V": 'results = "results.json"', "S_f": 'site = "A"', "name": 'file = "ski.toml"'}
    )
    found = scenario_file(path)
    assert found.scenario.ski.name == "mine"
    assert found.values["snow.H_V_N_per_mm3"] == pytest.approx(0.2, rel=1e-12)  # the geometric mean
    assert found.values["snow.S_f_N_per_mm2"] == pytest.approx(0.4, rel=1e-12)
    assert (found.values["snow.site"], found.values["ski.file"], found.values["ski.name"]) == ("A", "ski.toml", None)
    assert set(found.files) == {path, tmp_path / "results.json", tmp_path / "ski.toml"}
    assert found.values["ski.name"] is None  # the file names the ski's own file instead
    snow = load_scenario(path, changes={"S_f_N_per_mm2": 0.3}).contact.snow
    assert [snow.snow_hardness, snow.failure_shear_stress] == pytest.approx([0.2e9, 0.3e6], rel=1e-12)


def test_values_are_those_given_and_defaults() -> None:
    values = scenario_file("carved-46m", changes={"tolerance_mm": 0.003}).values
    assert list(values) == list(SCENARIO_KEYS)
    assert values["solver.tolerance_mm"] == 0.003
    assert values["snow.H_V_N_per_mm3"] == 0.2
    assert values["start.heading_deg"] == -30.0
    assert values["solver.elements"] is values["run.length_m"] is values["snow.published"] is None


@pytest.mark.parametrize("name", scenario_names())
def test_scenario_tells_its_values_back(name: str) -> None:
    found = scenario_file(name)
    told = scenario_values(found.scenario)
    assert list(told) == list(SCENARIO_KEYS)
    for key, value in found.values.items():
        if key != "snow.published":  # numbers in SI do not tell the name
            expected = pytest.approx(value, rel=1e-12) if isinstance(value, float) else value
            assert told[key] == expected, key


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"snow.H_V": 1}, coded("unknown_name", similar="snow.H_V_N_per_mm3")),
        ({"sledge.H_V_N_per_mm3": 1}, coded("unknown_name", similar="snow.H_V_N_per_mm3")),
        ({"edge_angel_deg": 1}, coded("unknown_name", similar=EDGE_ANGLE)),
        (
            {"slope.profile": "a.csv"},
            coded("contradiction", key="slope.kind", name="slope.profile", condition='slope.kind = "profile"'),
        ),
        ({"slope.kind": "profile"}, coded("missing", name="slope.profile")),
        ({"site": "A"}, coded("contradiction", name="snow.site", condition="snow.results")),
        ({"published": "race-pist"}, coded("unknown_name", similar="race-piste")),
        ({"ski.name": "slalon"}, coded("unknown_name", similar="slalom")),
        ({"ski.file": "nowhere.toml"}, "cannot_read"),
        ({"stance_width_m": 0.05}, "contradiction"),
        ({"clamp_length_m": 2}, "contradiction"),
        ({"inertia_kg_m2": [1, 1, 3]}, "out_of_range"),
        ({"mu_1_s_per_m": -0.01}, "contradiction"),
    ],
)
def test_bad_change_is_rejected_in_a_sentence(changes: dict[str, object], told: str | Coded) -> None:
    with raises(ParameterError, told):
        load_scenario("carved-46m", changes=changes)


@pytest.mark.parametrize(
    ("replaced", "told"),
    [
        ({"[snow]": "[sno]"}, coded("missing", similar="snow", section="sno")),
        ({"mass_kg": "mas_kg = 80"}, coded("unknown_name", name="sledge.mas_kg", similar="sledge.mass_kg")),
        ({"mass_kg": ""}, coded("missing", name="sledge.mass_kg")),
        ({"unloading_ratio": ""}, coded("missing", name="snow.unloading_ratio")),
        ({"H_V": ""}, "missing"),
        ({"S_f": ""}, coded("missing", name="snow.S_f_N_per_mm2")),
        ({"angle_deg": ""}, coded("missing", name="slope.angle_deg")),
        ({"name": ""}, "missing"),
        ({"duration_s": ""}, "no_data"),
        ({"mass_kg": "mass_kg ="}, "not_toml"),
        ({"step_ms": "step_ms = 1000"}, coded("out_of_range", low=0.001, high=5.0, name="solver.step_ms", unit="ms")),
    ],
)
def test_bad_file_is_rejected_with_its_name(tmp_path: Path, replaced: dict[str, str], told: str | Coded) -> None:
    path = written(tmp_path, replaced=replaced)
    with raises(ParameterError, told) as error:
        load_scenario(path)
    assert str(error.value).startswith(str(path))


def test_value_in_place_of_a_section_is_rejected(tmp_path: Path) -> None:
    path = tmp_path / "flat.toml"
    path.write_text("slope = 10\n", encoding="utf-8")
    with raises(ParameterError, "wrong_kind", section="slope"):
        load_scenario(path)


def test_scenario_that_is_not_there_is_reported_with_the_nearest(tmp_path: Path) -> None:
    with raises(ParameterError, "unknown_name", similar="carved-46m"):
        load_scenario("carved-46")
    with raises(ParameterError, "cannot_read"):
        load_scenario(tmp_path / "nowhere.toml")
    (tmp_path / "latin.toml").write_bytes("# Häng\n".encode("latin-1"))
    with raises(ParameterError, "not_text"):
        load_scenario(tmp_path / "latin.toml")


@pytest.mark.parametrize("place", [Path("nowhere"), "nowhere.toml", "nowhere.TOML", "folder/nowhere"])
def test_what_names_a_file_is_looked_for_as_a_file(place: str | Path) -> None:
    with pytest.raises(ParameterError, match=f"{re.escape(str(place))} cannot be read"):
        load_scenario(place)


def test_a_file_of_the_current_folder_needs_no_ending(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written(tmp_path, replaced={"mass_kg": "mass_kg = 71"}).rename(tmp_path / "mine")
    monkeypatch.chdir(tmp_path)
    assert load_scenario("mine").sledge.mass == 71.0


def test_the_text_of_a_scenario_that_is_not_built_in_is_rejected() -> None:
    with raises(ParameterError, "unknown_name", similar="carved-46m", name="carved-46"):
        scenario_text("carved-46")


def test_start_off_the_profile_is_rejected(tmp_path: Path) -> None:
    (tmp_path / "down.csv").write_text(PROFILE, encoding="utf-8")
    changes = {"slope.kind": "profile", "slope.profile": str(tmp_path / "down.csv")}
    with raises(ParameterError, "contradiction"):
        load_scenario("carved-46m", changes={**changes, "x_m": 58})
    assert load_scenario("carved-46m", changes={**changes, "x_m": 57}).start.x == 57.0


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"edge_angle_deg": -0.5236}, "write -30"),
        ({"angle_deg": 0.175}, "write 10.03"),
        ({"H_V_N_per_mm3": 2e8}, "write 0.2"),
        ({"H_V_N_per_mm3": 1e-6}, "1e-06 N/mm³ is outside"),
        ({"S_f_N_per_mm2": 0.9}, "S_f 0.9 N/mm²"),
        ({"edge_angle_deg": -70}, "70 °"),
        ({"mu_0": 0.2}, "0.023 to 0.139"),
        ({"drag_area_m2": 3}, "drag area 3 m²"),
    ],
)
def test_likely_slips_are_warned_of(changes: dict[str, object], told: str) -> None:
    warned = scenario_file("carved-46m", changes={"mu_0": 0.05, **changes}).warnings
    assert any(told in text for text in warned), warned
    assert scenario_file("carved-46m", changes={"mu_0": 0.05}).warnings == ()


def test_nothing_is_warned_of_where_friction_and_drag_are_off() -> None:
    assert scenario_file("carved-46m", changes={"mu_0": 0, "drag_area_m2": 0}).warnings == ()


@pytest.mark.parametrize("name", scenario_names())
def test_a_built_in_scenario_is_not_warned_of_itself(name: str) -> None:
    """Its file states where it is beyond the measurements. Changes by a user are marked."""
    assert scenario_file(name).warnings == ()
    assert scenario_file(name, changes={"start.speed_m_per_s": 8.0}).warnings == ()
    assert len(scenario_file(name, changes={"friction.mu_0": 0.011}).warnings) == 1


def test_a_copy_of_a_built_in_scenario_is_warned_of(tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(scenario_text("carved-46m"), encoding="utf-8")
    (told,) = scenario_file(path).warnings
    assert "0.01 is outside" in told


@pytest.mark.parametrize(
    ("section", "told"),
    [
        ("[identify]\nduration_s = 5", coded("not_free", key="run.duration_s")),
        ("[identify]\nmass_kg = 90", coded("wrong_kind", section="sledge")),
        ('[identify."mu_9"]\nlower = 0', "unknown_name"),
        ("[identify]\nclok = 'free'", coded("unknown_name", word="clok")),
        ("[identify]\nclock = 'fre'", "out_of_range"),
        ("[identify.mu_0]\nlowr = 0", coded("unknown_name", similar="lower")),
        ("[identify.mu_0]\nlower = nan", coded("out_of_range", name="lower", value="nan")),
        ("[identify.site]\nfall_line_azimut_deg = 0", coded("unknown_name", similar="fall_line_azimuth_deg")),
        ("[identify]\nsite = 3", coded("wrong_kind", name="site", line="[identify.site]")),
        ('[identify.runs."a"]\nmas_kg = 3', "unknown_name"),
        ("[identify.runs]\na = 3", coded("wrong_kind", run="a")),
    ],
)
def test_what_nobody_would_read_under_identify(tmp_path: Path, section: str, told: str | Coded) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(f"{scenario_text('carved-46m')}\n{section}\n", encoding="utf-8")
    with raises(ParameterError, told) as refused:
        load_scenario(path)
    assert str(path) in str(refused.value)


def test_what_a_run_does_not_heed_may_stand_under_identify(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    section = (
        '[identify]\nclock = "free"\n[identify.site]\nfall_line_azimuth_deg = 90\n[identify.runs."a b"]\nmass_kg = 90\n'
        '[identify."mu_0@each"]\nlower = 0.01\n[identify."snow.S_f_N_per_mm2"]\nprior_mean = 0.4\nprior_sd = 0.1\n'
    )
    path.write_text(f"{scenario_text('carved-46m')}\n{section}", encoding="utf-8")
    assert load_scenario(path).sledge.mass == 80.0


def test_a_scenario_from_python_has_the_ski_of_its_file() -> None:
    plain = load_scenario("carved-46m")
    name = scenario_file("carved-46m").values["ski.name"]
    assert name is not None
    assert build_input(load_input(plain)).values["ski.name"] == scenario_values(plain)["ski.name"] == name
