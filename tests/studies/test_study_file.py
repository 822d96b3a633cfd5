"""STUDY.toml: its points, and every mistake told."""

import itertools
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.studies import Study, read_study
from skisnow.studies.study import TOP_KEYS
from tests.coded import Coded, coded, raises

FIXED = '[fixed]\nski = "slalom"\npublished = "race-piste"\nload_N = 800\nunloading_ratio = 10\n'
GRID = "[grid]\nedge_angle_deg = [30, 45]\n"
OUT = 'out = "table.csv"\n'


def study(folder: Path, text: str) -> Study:
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    return read_study(path)


def test_grid_has_every_combination_and_the_last_varies_fastest(tmp_path: Path) -> None:
    fixed = FIXED.replace("load_N = 800\n", "")
    found = study(
        tmp_path, f"{OUT}{fixed}[grid]\nload_N = [400, 800]\nedge_angle_deg = {{ from = 30, to = 60, n = 4 }}\n"
    )
    pairs = [(point["load_N"], point["edge_angle_deg"]) for point in found.points]
    assert pairs == [(load, angle) for load in (400.0, 800.0) for angle in (30.0, 40.0, 50.0, 60.0)]
    assert all(point["ski"] == "slalom" for point in found.points)
    assert found.varied == ("load_N", "edge_angle_deg")
    assert found.out == tmp_path / "table.csv"


def test_logarithmic_range_has_even_ratios_and_exact_ends(tmp_path: Path) -> None:
    snow = FIXED.replace('published = "race-piste"', "S_f_N_per_mm2 = 0.3\nedge_angle_deg = 40")
    found = study(tmp_path, f"{OUT}{snow}[grid]\nH_V_N_per_mm3 = {{ from = 0.02, to = 90, n = 5, log = true }}\n")
    values = [point["H_V_N_per_mm3"] for point in found.points]
    assert (values[0], values[-1]) == (0.02, 90.0)
    ratios = [b / a for a, b in itertools.pairwise(values)]
    assert ratios == pytest.approx([4500.0**0.25] * 4, rel=1e-12)


def test_latin_hypercube_has_one_point_in_each_slice_and_follows_its_seed(tmp_path: Path) -> None:
    fixed = FIXED.replace("load_N = 800\n", "").replace('ski = "slalom"\n', "")
    ranges = 'load_N = { from = 300, to = 1500 }\nedge_angle_deg = { from = 10, to = 70 }\nski = ["slalom", "carver"]\n'
    text = f"{OUT}{fixed}[latin_hypercube]\nn = 40\nseed = 5\n{ranges}"
    found = study(tmp_path, text)
    for name, low, high in (("load_N", 300.0, 1500.0), ("edge_angle_deg", 10.0, 70.0)):
        share = (np.array([point[name] for point in found.points]) - low) / (high - low)
        assert sorted(np.floor(share * 40).astype(int).tolist()) == list(range(40))
    skis = [point["ski"] for point in found.points]
    assert skis.count("slalom") == skis.count("carver") == 20
    # a sample: angle and load are not sorted alike
    load, angle = (np.array([point[name] for point in found.points]) for name in ("load_N", "edge_angle_deg"))
    assert abs(np.corrcoef(load, angle)[0, 1]) < 0.5
    assert study(tmp_path, text).points == found.points
    assert study(tmp_path, text.replace("seed = 5", "seed = 6")).points != found.points


def test_paths_are_relative_to_the_study(tmp_path: Path) -> None:
    fixed = FIXED.replace('ski = "slalom"\n', "")
    found = study(tmp_path, f'{OUT}{fixed}{GRID}ski = ["mine/ski.toml", "slalom"]\n')
    assert found.subject.files(found.points) == [tmp_path / "mine" / "ski.toml"]


def test_fingerprint_follows_points_and_files_but_not_the_place_of_the_table(tmp_path: Path) -> None:
    fixed = FIXED.replace('ski = "slalom"\n', "")
    text = f'{OUT}{fixed}{GRID}ski = ["ski.toml"]\n'
    (tmp_path / "ski.toml").write_text("one", encoding="utf-8")
    first = study(tmp_path, text).fingerprint()
    assert study(tmp_path, text.replace("800", "800.0").replace("table", "other")).fingerprint() == first
    assert study(tmp_path, text.replace("[30, 45]", "[45, 30]")).fingerprint() != first
    (tmp_path / "ski.toml").write_text("two", encoding="utf-8")
    assert study(tmp_path, text).fingerprint() != first


AXES, SAMPLED = f"{OUT}{FIXED}[grid]\n", f"{OUT}{FIXED}[latin_hypercube]\n"
ANGLES = f"{AXES}edge_angle_deg = "


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (OUT + FIXED, "contradiction"),
        (OUT + FIXED + GRID + "[latin_hypercube]\nn = 3\nseed = 1\nload_N = { from = 1, to = 2 }", "contradiction"),
        (AXES, "missing"),
        (OUT + FIXED + "[gird]\nload_N = [1]\n", coded("unknown_name", similar="grid", key="gird")),
        (
            AXES + "edge_angel_deg = [30]\n",
            coded("unknown_name", similar="edge_angle_deg", table="grid", name="edge_angel_deg"),
        ),
        (OUT + FIXED + "laod_N = 3\n" + GRID, coded("unknown_name", similar="load_N", table="fixed", name="laod_N")),
        (AXES + "load_N = [400]\n", coded("contradiction", name="load_N", form="grid")),
        (ANGLES + "[]\n", "out_of_range"),
        (ANGLES + "[30, 30.0]\n", coded("repeated", repeated=30.0)),
        (OUT + FIXED + '[grid]\nedge_angle_deg = [30, "forty"]\n', coded("wrong_kind", value="'forty'")),
        (ANGLES + "[true]\n", "wrong_kind"),
        (ANGLES + "{ from = 3, to = 60 }\n", "missing"),
        (ANGLES + "{ from = 3, till = 60 }\n", coded("unknown_name", name="till")),
        (ANGLES + "{ from = 3, n = 60 }\n", coded("missing", name="to")),
        (ANGLES + "{ from = 60, to = 3, n = 6 }\n", "wrong_kind"),
        (OUT + FIXED.replace("race-piste", "race-pist") + GRID, coded("unknown_name", similar="race-piste")),
        (OUT + FIXED.replace("slalom", "slalon") + GRID, coded("unknown_name", similar="slalom", name="slalon")),
        (OUT + FIXED.replace("slalom", "mine.toml") + GRID, "cannot_read"),
        (
            OUT + FIXED.replace("_ratio = 10", "_ratio = 0.5") + GRID,
            coded("out_of_range", low=1.0, name="unloading_ratio", value="0.5"),
        ),
        (
            OUT + FIXED.replace("= 800", "= -800") + GRID,
            coded("out_of_range", low=0.0, name="load_N", value="-800", allowed="above 0", unit="N"),
        ),
        (
            OUT + FIXED.replace("slalom", "paper-tool") + GRID,
            coded("out_of_range", clamp_length=0.3, name="paper-tool"),
        ),
        (OUT + FIXED + "clamp_length_m = 300\n" + GRID, coded("out_of_range", clamp_length=300.0)),
        (OUT + FIXED + 'results = "nowhere.json"\n' + GRID, "contradiction"),
        (OUT + FIXED.replace("published", "results") + GRID, "wrong_kind"),
        (OUT + FIXED + GRID + "S_f_N_per_mm2 = [0.2]\n", "contradiction"),
        (ANGLES + "{ from = 3, to = 3, n = 6 }\n", "out_of_range"),
        (ANGLES + "{ from = 3, to = nan, n = 6 }\n", coded("out_of_range", name="to", value="nan")),
        (ANGLES + "{ from = 0, to = 3, n = 6, log = true }\n", coded("out_of_range", low=0.0)),
        (ANGLES + "{ from = 3, to = 60, n = 1 }\n", coded("out_of_range", low=2, name="n", value="1")),
        (OUT + FIXED + '[grid]\nedge_angle_deg = { from = 3, to = 60, n = 6, log = "yes" }\n', "wrong_kind"),
        (ANGLES + "{ from = 3, to = 60, n = 2000000 }\n", coded("out_of_range", n=2000000)),
        (AXES + "twist = { from = 0, to = 1, n = 2 }\n", coded("no_data", name="twist")),
        (AXES + "elements = [80, 80.5]\n", coded("wrong_kind", value="80.5")),
        (OUT + FIXED + "edge_angle_deg = [3]\n[grid]\nelements = [80]\n", "wrong_kind"),
        (SAMPLED + "n = 5\nedge_angle_deg = { from = 3, to = 60 }\n", coded("missing", name="seed")),
        (SAMPLED + "n = 0\nseed = 1\nelements = [80]\n", coded("out_of_range", low=1, name="n", value="0")),
        (SAMPLED + "n = 5\nseed = 1\nedge_angle_deg = { from = 3, to = 60, n = 3 }\n", "contradiction"),
        (FIXED + GRID, "wrong_kind"),
        ('out = "table.xlsx"\n' + FIXED + GRID, "wrong_ending"),
        (OUT + GRID, coded("missing", name="ski")),
        (OUT + FIXED.replace('published = "race-piste"\n', "") + GRID, "missing"),
        (OUT + FIXED + "H_V_N_per_mm3 = 3\n" + GRID, "contradiction"),
        (OUT + FIXED.replace("unloading_ratio = 10\n", "") + GRID, coded("missing", name="unloading_ratio")),
        ("out = table.csv\n", "not_toml"),
    ],
)
def test_each_mistake_is_reported_with_the_file(text: str, told: str | Coded, tmp_path: Path) -> None:
    with raises(ParameterError, told) as caught:
        study(tmp_path, text)
    assert str(tmp_path / "study.toml") in str(caught.value)


def test_file_that_is_not_there_or_not_text(tmp_path: Path) -> None:
    with raises(ParameterError, "cannot_read"):
        read_study(tmp_path / "study.toml")
    (tmp_path / "study.toml").write_bytes(b'out = "\xff"')
    with raises(ParameterError, "not_text", byte=8):
        read_study(tmp_path / "study.toml")


def test_top_keys_are_those_of_the_contract() -> None:
    assert set(TOP_KEYS) == {"out", "scenario", "fixed", "grid", "latin_hypercube"}


HEAD = 'out = "t.csv"\n[fixed]\nski = "slalom"\npublished = "race-piste"\nunloading_ratio = 10\n'
SAMPLE = (
    HEAD.replace('ski = "slalom"\n', "") + '[latin_hypercube]\nn = 2345\nseed = 7\nski = ["slalom", "giant-slalom"]\n'
    "load_N = { from = 300, to = 1500, log = true }\nelements = { from = 40, to = 80 }\nedge_angle_deg = [20, 30]\n"
)


def test_a_grid_is_every_combination_with_the_last_axis_fastest(tmp_path: Path) -> None:
    axes = {"load_N": (400.0, 800.0), "at_rest": (True, False), "elements": (40, 60, 80)}
    grid = (
        "load_N = [400, 800]\nat_rest = [true, false]\nelements = { from = 40, to = 80, n = 3 }\nedge_angle_deg = 30\n"
    )
    found = study(tmp_path, f"{HEAD}[grid]\n{grid}")
    fixed = {"ski": "slalom", "published": "race-piste", "unloading_ratio": 10.0}
    wanted = [
        {**fixed, **dict(zip(axes, of, strict=True)), "edge_angle_deg": 30.0}
        for of in itertools.product(*axes.values())
    ]
    assert found.points == wanted
    assert [list(point) for point in found.points] == [list(point) for point in wanted]  # the order of the columns, too
    fewer = Study(found.file, found.out, found.subject, found.varied, found.points[:-1])
    assert fewer.fingerprint() != found.fingerprint()


def test_a_sample_holds_each_slice_of_each_axis_once(tmp_path: Path) -> None:
    points = study(tmp_path, SAMPLE).points
    loads = sorted(point["load_N"] for point in points)
    n = len(loads)
    assert all(300 * 5 ** (place / n) <= load <= 300 * 5 ** ((place + 1) / n) for place, load in enumerate(loads))
    assert {type(point["elements"]) for point in points[:9]} == {int}
    assert {point["ski"] for point in points} == {"slalom", "giant-slalom"}


@pytest.mark.parametrize(
    ("grid", "points"),
    [
        ("edge_angle_deg = { from = 10, to = 60, n = 1_000_000_000_000 }", 1_000_000_000_000),
        ("edge_angle_deg = { from = 10, to = 60, n = 101 }\nload_N = { from = 400, to = 800, n = 1000 }", 101_000),
        ("edge_angle_deg = [10, 20]\nload_N = { from = 400, to = 800, n = 50_001 }", 100_002),
    ],
)
def test_more_points_than_anybody_waits_for_take_no_memory(grid: str, points: int, tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=f"{points} points"):
        study(tmp_path, f"{HEAD}[grid]\n{grid}\n")
