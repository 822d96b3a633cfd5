import math
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tests.coded import Coded, coded, raises, warns
from tests.key_names import IGNORE_RANGE_WARNING

from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.ski import read_ski, ski_named, ski_names
from skisnow.ski.file_keys import BASE, COLUMNS, RIGID, SKI_KEYS, SkiFile
from skisnow.ski.layout import BaseShape
from skisnow.ski.ski_file import Sources
from skisnow.snow import published_snow

Written = Callable[..., Path]


# sidecut radius printed on the ski (m), δ by hand from the widths (mm), mass (kg), camber (mm), EI in the middle (N m²)
SHEET = {
    "slalom": (12.6, (116 + 101 - 2 * 68) / 4, 2.231, 7.0, 440.0),
    "giant-slalom": (18.8, (110 + 96 - 2 * 67) / 4, 2.434, 7.0, 630.0),
    "carver": (14.1, (127 + 111 - 2 * 74) / 4, 2.246, 6.0, 460.0),
}


@pytest.mark.parametrize("name", SHEET)
def test_catalogue_ski_is_the_measured_one(name: str) -> None:
    radius, depth_mm, mass, camber_mm, stiffness = SHEET[name]
    ski = ski_named(name)
    assert ski.name == name
    assert "Sooth Ski" in ski.source
    assert ski.sidecut_depth * 1e3 == pytest.approx(depth_mm, abs=1e-9)
    # both definitions come out 0-5 % above what is printed on such skis
    assert 1.0 <= ski.sidecut_radius_of_three_widths / radius <= 1.05
    assert 1.0 <= ski.sidecut_radius_of_edge_line / radius <= 1.05
    assert ski.mass == pytest.approx(mass, rel=1e-12)
    assert -ski.at(ski.contact_points).base_height * 1e3 == pytest.approx([camber_mm, camber_mm], abs=1e-9)
    assert float(ski.at(0.0).bending_stiffness) == pytest.approx(stiffness, rel=1e-12)
    assert (ski.sidecut_middle, ski.base_bevel, ski.edge_width) == (0.0, 0.0, 0.002)


def test_the_papers_tool_is_a_straight_flat_rigid_piece() -> None:
    tool = ski_named("paper-tool")
    assert tool.length == pytest.approx(0.2, abs=1e-12)
    assert np.all(tool.width == 0.062)
    assert np.all(tool.base_height == 0.0)
    assert tool.sidecut_radius_of_three_widths == math.inf
    assert np.all(tool.bending_stiffness == RIGID)
    # half of it, held in the middle, under half of 500 N spread evenly: q l⁴/8 EI against a depth of 0.23 mm on ice
    assert (500.0 / 0.2) * 0.1**4 / (8.0 * RIGID) < 0.23e-3 * 1e-3


def test_names() -> None:
    assert set(ski_names()) == {"slalom", "giant-slalom", "carver", "paper-tool"}
    assert read_ski("carver").name == "carver"


@pytest.mark.parametrize("reader", [read_ski, ski_named])
def test_misspelt_name_names_the_nearest_and_all(reader: Callable[[str], object]) -> None:
    with raises(ParameterError, "unknown_name", similar="giant-slalom") as raised:
        reader("giantslalom")
    assert all(name in str(raised.value) for name in ski_names())


def test_file_with_the_numbers_of_the_catalogue_is_the_same_ski(ski_file: Written) -> None:
    mine, known = read_ski(ski_file()), ski_named("slalom")
    assert (mine.name, mine.source) == ("mine", "file mine.toml")
    assert np.array_equal(mine.width, known.width)
    assert np.array_equal(mine.base_height, known.base_height)


def test_every_number_reaches_the_ski_in_si(ski_file: Written) -> None:
    changes = {"boot_position_mm": 25, "base_bevel_deg": 0.5, "edge_width_mm": 2.2, "tail_overhang_mm": 30}
    heights = {"shovel_height_mm": 60, "tail_height_mm": 5, "name": "mine too", "source": "measured"}
    ski = read_ski(ski_file(**changes, **heights))
    assert (ski.name, ski.source) == ("mine too", "measured")
    assert ski.sidecut_middle == pytest.approx(-0.025)
    assert ski.base_bevel == pytest.approx(math.pi / 360.0, rel=1e-12)
    assert ski.edge_width == pytest.approx(0.0022)
    assert ski.station[-1] == pytest.approx(-0.025 - 0.729 - 0.030)
    low = float(ski.at(ski.contact_points[0]).base_height)
    assert ski.base_height[0] - low == pytest.approx(0.060, abs=1e-12)
    assert ski.base_height[-1] - low == pytest.approx(0.005, abs=1e-12)


def test_rocker_and_stiffness_stations_of_a_file_and_one_stiffness_holds_everywhere(ski_file: Written) -> None:
    rocker = {
        "tip_rocker_length_mm": 200,
        "tip_rocker_height_mm": 6,
        "tail_rocker_length_mm": 100,
        "tail_rocker_height_mm": 2,
    }
    ski = read_ski(ski_file(**rocker, stiffness_station_mm=[600, 300, 0, -300, -600]))
    low, end = ski.at([0.698 - 0.2, 0.698]).base_height
    assert end - low == pytest.approx(0.006, abs=1e-6)  # interpolated linearly between stations
    assert float(ski.at(0.3).bending_stiffness) == pytest.approx(250.0, abs=0.01)
    assert np.all(read_ski(ski_file(EI_N_m2=[300])).bending_stiffness == 300.0)


@pytest.mark.filterwarnings(IGNORE_RANGE_WARNING)
@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"tip_with_mm": 116}, coded("unknown_name", similar="tip_width_mm", key="tip_with_mm")),
        ({"Length_mm": 1593}, coded("unknown_name", similar="length_mm", key="Length_mm")),
        ({"running_length_mm": None}, coded("missing", key="running_length_mm")),
        ({"mass_kg": None}, coded("missing", key="mass_kg")),
        ({"tip_width_mm": None}, coded("missing", key="tip_width_mm")),
        ({"EI_N_m2": None}, coded("missing", key="EI_N_m2")),
        ({"waist_width_mm": 0.068}, coded("out_of_range", unit="metres", value=68.0)),
        ({"waist_width_mm": 6.8}, coded("out_of_range", unit="centimetres", value=68.0)),
        (
            {"mass_kg": 2231},
            coded("out_of_range", unit="grams", value=2.231, problem="mass_kg is 2231; allowed is from 0.01 to 50 kg"),
        ),
        (
            {"waist_width_mm": 130},
            coded("out_of_range", key="tip_width_mm", width=116.0, value="130"),
        ),
        (
            {"waist_width_mm": 105},
            coded("out_of_range", key="tail_width_mm", width=101.0, value="105"),
        ),
        ({"EI_N_m2": [100, -250, 440]}, "out_of_range"),
        ({"GJ_N_m2": [100, 0, 440]}, "out_of_range"),
        ({"EI_N_m2": 440}, "wrong_kind"),
        ({"EI_N_m2": []}, "wrong_kind"),
        ({"camber_mm": "7"}, coded("wrong_kind", problem="camber_mm is '7'; it must be a number")),
        ({"camber_mm": True}, coded("wrong_kind", problem="camber_mm is True; it must be a number")),
        ({"name": ""}, "out_of_range"),
        ({"rigid": "yes"}, "wrong_kind"),
        ({"rigid": True}, coded("contradiction", key="EI_N_m2", other="rigid")),
        ({"sidecut_length_mm": 1590}, coded("contradiction", name="sidecut_length", length=1590.0, front=795.0)),
        ({"running_length_mm": 1600}, coded("contradiction", name="running_length", length=1600.0)),
        ({"stiffness_station_mm": [500, 0, -500]}, coded("wrong_shape", size=5, size_2=3, key="EI_N_m2")),
        ({"stiffness_station_mm": [-500, -250, 0, 250, 500]}, "not_falling"),
        ({"base_bevel_deg": 6}, coded("out_of_range", problem="base_bevel_deg is 6; allowed is from 0 to 5 °")),
        ({"edge_width_mm": 20, "waist_width_mm": 40}, coded("invalid_ski", width=0.02, limit=0.02)),
        ({"tip_rocker_height_mm": 5}, coded("contradiction", name="shovel", rocker_height=5.0)),
    ],
)
def test_errors_have_file_key_value_remedy(ski_file: Written, changes: dict[str, object], named: str | Coded) -> None:
    path = ski_file(**changes)
    with raises(ParameterError, named) as raised:
        read_ski(path)
    assert str(raised.value).startswith(str(path.parent))
    assert str(raised.value).count(str(path)) <= 1


@pytest.mark.filterwarnings(IGNORE_RANGE_WARNING)
def test_lengths_in_centimetres_are_rejected(ski_file: Written) -> None:
    path = ski_file(length_mm=159.3, running_length_mm=139.6, sidecut_length_mm=145.8)
    with raises(ParameterError, "out_of_range", least=290.00000000000006, value="159.3"):
        read_ski(path)


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"EI_N_m2": [100, 6000, 100]}, coded("unusual", place="EI_N_m2[2]", value=6000.0, low=5, high=5000)),
        ({"EI_N_m2": [0.1, 0.44, 0.1]}, coded("unusual", place="EI_N_m2[1]", value=100.0, count=2, unit="kN m²")),
        ({"GJ_N_m2": [60e6, 175e6 / 2, 60e6]}, coded("unusual", value=60.0, unit="N mm²")),
        ({"camber_mm": 0.007}, coded("unusual", place="camber_mm", value=7.0, unit="metres")),
        ({"camber_mm": 40}, coded("unusual", place="camber_mm", value=40.0, low=0.5, high=25)),
        ({"base_bevel_deg": 0.01}, coded("unusual", place="base_bevel_deg", unit="radians")),
        ({"running_length_mm": 139.6}, coded("unusual", place="running_length_mm", value=1396.0, unit="centimetres")),
        ({"running_length_mm": 400}, coded("unusual", key="running_length_mm", value=400.0, length=1593.0)),
    ],
)
@pytest.mark.filterwarnings(IGNORE_RANGE_WARNING)
def test_warnings_of_unusual_numbers(ski_file: Written, changes: dict[str, object], named: str | Coded) -> None:
    path = ski_file(**changes)
    with warns(RangeWarning, named) as warned:
        ski = read_ski(path)
    assert str(path) in str(warned[0].message)
    assert ski.length == pytest.approx(1.593)


def test_usual_numbers_are_not_warned_of(ski_file: Written) -> None:
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        ski = read_ski(ski_file())
    assert warned == []
    assert ski.length == pytest.approx(1.593)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with raises(ParameterError, "cannot_read"):
        read_ski(tmp_path / "gone.toml")
    (tmp_path / "broken.toml").write_text("length_mm = = 3\n", encoding="utf-8")
    with raises(ParameterError, "not_toml"):
        read_ski(tmp_path / "broken.toml")
    (tmp_path / "latin.toml").write_bytes("name = 'Mössner'\n".encode("latin-1"))
    with raises(ParameterError, "not_text"):
        read_ski(tmp_path / "latin.toml")


def test_what_is_usual_is_allowed() -> None:
    for key in (*SKI_KEYS.values(), *COLUMNS.values()):
        if key.kind in ("number", "numbers"):
            assert key.usual is not None
            assert key.lowest <= key.usual[0] < key.usual[1] <= key.highest, key.name


def test_a_file_says_shape_stiffness_mass_and_where_the_rest_stands() -> None:
    assert len(SKI_KEYS) == 29
    assert {key.kind for key in SKI_KEYS.values()} == {"text", "number", "numbers", "switch"}
    assert all(SKI_KEYS[name].factor == 1e-3 for name in BASE)


def test_a_base_in_python_is_held_to_the_ranges_of_files() -> None:
    with pytest.raises(ParameterError, match=r"camber_mm is 60\.0;"):
        BaseShape(camber=0.06)


def test_defaults_in_si() -> None:
    empty = SkiFile()
    assert (empty.tail_overhang, empty.boot_position, empty.base_bevel, empty.edge_width) == (0.02, 0.0, 0.0, 0.002)


SKI = """name = "mine"
length_mm = 1650
"""


def test_a_word_of_the_catalogue_is_no_file() -> None:
    sources = Sources()
    assert sources.ski_file("slalom") is None
    ski, told = sources.ski("slalom")
    assert ski.name == ski_named("slalom").name
    assert isinstance(told, tuple)
    assert sources.ski("slalom")[0] is ski  # read once


def test_what_looks_like_a_file_is_one_beside_who_names_it(tmp_path: Path) -> None:
    sources = Sources(tmp_path)
    assert sources.path("a.csv") == tmp_path / "a.csv"
    assert Sources().path("a.csv") == Path("a.csv")
    assert sources.ski_file("mine.toml") == tmp_path / "mine.toml"
    assert sources.ski_file("there/mine") == tmp_path / "there" / "mine"
    assert sources.ski_file("mine") is None
    (tmp_path / "mine").write_text(SKI, encoding="utf-8")
    assert sources.ski_file("mine") == tmp_path / "mine"
    with pytest.raises(ParameterError):
        sources.ski("no-such-ski")


def test_a_snow_is_read_once_and_one_at_hand_is_taken(tmp_path: Path) -> None:
    sources = Sources(tmp_path)
    word = {"published": "race-piste"}
    snow = sources.named_snow(word)
    assert snow.snow_hardness == published_snow("race-piste").snow_hardness
    assert sources.named_snow(word) is snow
    sources.take_snow(snow, results="results", site="A")
    assert sources.named_snow({"results": "results", "site": "A"}) is snow
    with pytest.raises(ParameterError):
        sources.named_snow({"published": None})
