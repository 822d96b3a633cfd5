"""Campaigns read: SI values known by hand, every spreadsheet program's form, nothing lost, nothing raised."""

import dataclasses
import hashlib
import math
import os
import random
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.present import present

from skisnow._support.errors import FieldDataError
from skisnow.campaign import Campaign, Problem, check_campaign, read_campaign
from skisnow.geometry import Disc, LyingCylinder, SkiPiece

from ..conftest import SmallCampaign

CSV_FILES = ("penetration.csv", "shear.csv", "density.csv", "drop_cone.csv")


def test_the_small_in_si(small: SmallCampaign) -> None:
    campaign = small.read()
    assert campaign.problems == ()
    assert (campaign.name, campaign.place, campaign.observers) == ("north slope", "Kühtai", ("A. Müller", "B"))
    assert campaign.gauge_resolution == pytest.approx(1e-5)
    assert campaign.load_uncertainty == 0.5
    assert campaign.moment_uncertainty == 0.02
    assert campaign.lever_arm_uncertainty == pytest.approx(4e-4)
    assert campaign.load_steps == (70.0, 140.5)
    assert campaign.tools["piece"] == SkiPiece(length=0.2, width=0.062)
    assert campaign.tools["disc 100"] == Disc(diameter=0.1)
    assert campaign.tools["roll"] == LyingCylinder(radius=0.05, width=0.08)
    assert campaign.plates == {"blade": 0.2}
    assert campaign.excluding == {"cancelled", "too_few_loads", "loads_not_rising", "depth_shrinks", "zero_depth"}


def test_penetration_in_si_and_the_other_tables_in_si(small: SmallCampaign) -> None:
    tests = present(small.read().penetration)
    assert tests.experiment == ("P1", "P2")
    assert tests.site == ("Süd", "Nord")
    assert tests.tool == ("piece", "disc 100")
    assert tests.spot == ("a", "")
    assert tests.first.tolist() == [0, 3, 5]
    np.testing.assert_allclose(tests.edge_angle, [math.pi / 6, 0.0], rtol=1e-15)
    assert tests.load.tolist() == [70.5, 140.5, 210.5, 70.5, 140.5]
    np.testing.assert_allclose(tests.penetration_depth, [1.25e-3, 2.5e-3, 3.75e-3, 5e-4, 1e-3], rtol=1e-15)
    assert tests.row.tolist() == [2, 3, 4, 5, 6]
    np.testing.assert_array_equal(tests.snow_density, [355.0, np.nan])
    assert np.isnan(tests.drop_cone_depth).all()
    assert tests.further == {"remark": ("first", "", "hard, wet", "", "")}
    campaign = small.read()
    shear, density, cone = campaign.shear, campaign.density, campaign.drop_cone
    assert shear is not None
    np.testing.assert_allclose(shear.edge_angle, [math.pi / 2, math.pi / 4], rtol=1e-15)
    np.testing.assert_allclose(shear.penetration_depth, [5.5e-3, 6e-3], rtol=1e-15)
    np.testing.assert_allclose(shear.lever_arm, [0.3, 0.3], rtol=1e-15)
    assert shear.moment.tolist() == [12.25, 10.0]
    np.testing.assert_allclose(shear.drop_cone_depth, [0.0145, np.nan], rtol=1e-15)
    assert shear.spot == ("a", "")
    assert present(density).site_means() == {"Süd": 410.5, "Nord": 305.0}
    assert present(cone).site_means() == pytest.approx({"Süd": 0.015})  # mean of 13 and 17 mm, not of the three repeats


def test_hashes_are_those_of_the_raw_files(small: SmallCampaign) -> None:
    small["corrections.csv"] = "file,experiment,row,column,old,new,who,when,why\n"
    folder = small.written()
    expected = {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.iterdir()}
    assert read_campaign(folder).file_hashes == expected


def plain(campaign: Campaign) -> dict[str, object]:
    """Everything a campaign holds but how its files were written."""
    checked_bytes = dataclasses.asdict(campaign)
    for left_out in ("folder", "problems", "file_hashes", "tools"):
        del checked_bytes[left_out]
    return {"tools": dict(campaign.tools), **checked_bytes}


def rewritten(text: str, separator: str, comma: bool, line_end: str, *, stray: bool) -> str:
    """Write a CSV without quotes or separators in cells as another program would."""
    lines = []
    for number, line in enumerate(text.splitlines()):
        cells = line.replace('"hard, wet"', "hard and wet").split(",")
        if comma and number:
            cells = [cell.replace(".", ",") if cell.replace(".", "").isdigit() else cell for cell in cells]
        if separator == "," and comma:
            cells = [f'"{cell}"' if "," in cell else cell for cell in cells]
        if stray:
            cells = [f"  {cell}\u00a0" for cell in cells]
        lines.append(separator.join(cells) + line_end)
    return "".join(lines)


ENCODINGS = {"utf-8": None, "utf-8-sig": None, "utf-16": "UTF-16", "cp1252": "Windows-1252"}


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_every_form_reads_the_same(small: SmallCampaign, encoding: str, separator: str) -> None:
    small.replace("penetration.csv", '"hard, wet"', "hard and wet")
    expected = plain(small.read())
    for comma, line_end, stray in (
        (False, "\r\n", True),
        (True, "\n", True),
        (True, "\r\n", False),
        (True, "\r", True),
    ):
        files = {
            name: rewritten(small[name], separator, comma, line_end, stray=stray).encode(encoding) for name in CSV_FILES
        }
        campaign = small.read(files)
        np.testing.assert_equal(plain(campaign), expected)
        stated = {(problem.code, problem.value) for problem in campaign.problems if problem.file == "penetration.csv"}
        wanted = {("encoding", ENCODINGS[encoding])} if ENCODINGS[encoding] else set()
        wanted |= {("separator", {";": "semicolon", "\t": "tab"}[separator])} if separator != "," else set()
        wanted |= {("separator", "decimal comma")} if comma else set()
        assert stated == wanted


def test_utf_16_big_endian_and_toml_in_windows_1252(small: SmallCampaign) -> None:
    toml = small["campaign.toml"].replace("\n", "\r\n").encode("cp1252")
    campaign = small.read({"campaign.toml": toml, "shear.csv": b"\xfe\xff" + small["shear.csv"].encode("utf-16-be")})
    assert campaign.place == "Kühtai"
    assert present(campaign.shear).site == ("Süd", "Nord")
    assert [(problem.code, problem.file, problem.value) for problem in campaign.problems] == [
        ("encoding", "campaign.toml", "Windows-1252"),
        ("encoding", "shear.csv", "UTF-16"),
    ]


def test_line_that_names_the_separator(small: SmallCampaign) -> None:
    small["shear.csv"] = "sep=;\r\n" + rewritten(small["shear.csv"], ";", True, "\r\n", stray=False)
    shear = present(small.read().shear)
    assert shear.row.tolist() == [3, 4]
    assert shear.moment.tolist() == [12.25, 10.0]


def test_rows_are_file_lines_over_blank_lines_and_line_breaks_in_quotes(small: SmallCampaign) -> None:
    header, *rows = small["penetration.csv"].splitlines()
    rows[0] = 'P1,Süd,piece,30,70.5,1.25,a,350,,"two\r\nlines"'  # lines 2 and 3
    text = "\n".join([header, rows[0], "", ",,,,,,,,,", " ,\t,,", rows[1], rows[2], rows[3], rows[4]])
    tests = present(small.read({"penetration.csv": text}).penetration)
    assert tests.row.tolist() == [2, 7, 8, 9, 10]
    assert tests.further["remark"][0] == "two\r\nlines"


def test_padding_of_spreadsheet_programs(small: SmallCampaign) -> None:
    lines = small["density.csv"].splitlines()
    padded = "\n".join([lines[0] + ",,", lines[1] + ",,", lines[2], lines[3] + ",,,,"])
    campaign = small.read({"density.csv": padded})
    assert campaign.problems == ()
    assert present(campaign.density).snow_density.tolist() == [410.5, 300.0, 310.0]
    assert present(campaign.density).further == {}


def test_name_falls_back_to_the_folder(small: SmallCampaign) -> None:
    toml = small["campaign.toml"]
    campaign = small.read({"campaign.toml": toml.partition("\n")[2]})
    assert campaign.name == "campaign"


def test_status_cancels_the_experiment_and_says_why(small: SmallCampaign) -> None:
    for old, new in (("2.5,a,,,", "2.5,a,,tool slipped,"), ("360,,", "360,rain,"), ("350,,", "350,tool slipped,")):
        small.replace("penetration.csv", old, new)
    small["drop_cone.csv"] = "test,site,repeat,drop_cone_depth_mm,status\nC1,S,1,12,\nC1,S,2,30,crust\nC2,S,1,17,\n"
    small["density.csv"] = "sample,site,snow_density_kg_per_m3,status\nD1,S,400,\nD1,S,100,spilt\nD1,N,300,\n"
    campaign = small.read()
    assert present(campaign.penetration).cancelled == ("tool slipped; rain", "")
    assert present(campaign.drop_cone).cancelled == ("crust", "crust", "")
    assert present(campaign.drop_cone).site_means() == pytest.approx({"S": 0.017})
    assert present(campaign.density).site_means() == {"N": 300.0}


def test_unknown_columns_are_kept_and_named(small: SmallCampaign) -> None:
    text = "sample,site,snow_density_kg_per_m3,Wetter,time\nD1,Süd,410.5,sonnig,9:30\n"
    campaign = small.read({"density.csv": text})
    assert present(campaign.density).further == {"Wetter": ("sonnig",), "time": ("9:30",)}
    (problem,) = campaign.problems
    assert (problem.severity, problem.code, problem.row, problem.column) == ("warning", "unknown_column", 1, "Wetter")


def test_nothing_is_lost_in_a_large_file(small: SmallCampaign) -> None:
    """More rows than are taken at once, with line breaks in quotes and a late bad cell: all are found again."""
    draw = random.Random(3)
    rows = [
        (f"E{index // 7}", f"{10 + index % 7}.25", f"{draw.randrange(1, 900) / 100:.2f}", "y" * (index % 3))
        for index in range(30_001)
    ]
    lines = ["experiment,site,tool,edge_angle_deg,load_N,depth_mm,note"]
    lines += [f'{name},s,piece,45,{load},{depth},"{note}\n"' for name, load, depth, note in rows]
    folder = small.written({"penetration.csv": "\n".join(lines)})
    told: list[str] = []
    tests = present(read_campaign(folder, progress=told.append).penetration)
    assert len(tests.load) == len(rows)
    assert tests.load.tolist() == [float(load) for _, load, _, _ in rows]
    np.testing.assert_allclose(tests.penetration_depth, [float(depth) / 1000 for _, _, depth, _ in rows], rtol=1e-15)
    assert tests.row.tolist() == [2 + 2 * index for index in range(len(rows))]
    assert len(tests) == 4286
    assert tests.further["note"] == tuple(note for _, _, _, note in rows)
    assert "penetration.csv: 30,001 rows" in told
    lines[29_000] = lines[29_000].replace(".25", ".2S", 1)
    (problem,) = small.errors({"penetration.csv": "\n".join(lines)})
    assert (problem.code, problem.row, problem.column) == ("not_a_number", 2 * 29_000, "load_N")


def test_all_problems_are_raised_with_the_warnings(small: SmallCampaign) -> None:
    small["penetration.csv"] = small["penetration.csv"].replace("2.5", "-2.5").replace("70.5", "x")
    small.replace("shear.csv", "spot", "Ort")
    folder = small.written()
    with pytest.raises(FieldDataError) as caught:
        read_campaign(folder)
    assert caught.value.problems == check_campaign(folder)
    assert [(each.code, each.file, each.row) for each in caught.value.problems if isinstance(each, Problem)] == [
        ("not_a_number", "penetration.csv", 2),
        ("out_of_range", "penetration.csv", 3),
        ("not_a_number", "penetration.csv", 5),
        ("unknown_column", "shear.csv", 1),
    ]


@pytest.mark.parametrize("kind", ["missing", "file"])
def test_no_folder(tmp_path: Path, kind: str) -> None:
    place = tmp_path / "x"
    if kind == "file":
        place.write_text("a")
    (problem,) = check_campaign(place)
    assert (problem.severity, problem.code, problem.file) == ("error", "unreadable_file", str(place))
    with pytest.raises(FieldDataError):
        read_campaign(place)


def test_folder_and_pipe_in_place_of_a_file(small: SmallCampaign) -> None:
    del small["density.csv"], small["shear.csv"]
    folder = small.written()
    (folder / "density.csv").mkdir()
    os.mkfifo(folder / "shear.csv")
    problems = check_campaign(folder)
    assert [(each.code, each.file) for each in problems] == [
        ("unreadable_file", "shear.csv"),
        ("unreadable_file", "density.csv"),
    ]


def assert_told_and_not_raised(folder: Path) -> None:
    problems = check_campaign(folder)
    assert {type(problem) for problem in problems} <= {Problem}
    assert all(problem.allowed and problem.action for problem in problems)
    if any(problem.severity == "error" for problem in problems):
        with pytest.raises(FieldDataError):
            read_campaign(folder)
    else:
        assert read_campaign(folder).problems == problems


SHARED_FOLDER = settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
)
BROKEN = st.one_of(
    st.binary(max_size=200),
    st.text(alphabet='experimntsol_N0123456789.,;"\r\n\t -=\ufeff\u00a0é', max_size=200).map(str.encode),
)


@SHARED_FOLDER
@given(name=st.sampled_from(("campaign.toml", "corrections.csv", *CSV_FILES)), content=BROKEN)
def test_random_files_give_problems(small: SmallCampaign, name: str, content: bytes) -> None:
    assert_told_and_not_raised(small.written({name: content}))


@SHARED_FOLDER
@given(
    name=st.sampled_from(("campaign.toml", *CSV_FILES)),
    place=st.floats(0, 1),
    length=st.integers(0, 12),
    content=BROKEN,
)
def test_damaged_files_are_rejected(small: SmallCampaign, name: str, place: float, length: int, content: bytes) -> None:
    checked_bytes = small[name].encode()
    start = int(place * len(checked_bytes))
    damaged = checked_bytes[:start] + content[:length] + checked_bytes[start + length :]
    assert_told_and_not_raised(small.written({name: damaged}))


@pytest.mark.parametrize(("content", "code"), [(None, "bad_toml"), ("", "empty_file"), (" \r\n", "empty_file")])
def test_no_campaign_toml_is_one_problem(small: SmallCampaign, content: str | None, code: str) -> None:
    """Not one more for every tool that it would have described."""
    del small["campaign.toml"]
    (problem,) = small.check({} if content is None else {"campaign.toml": content})
    assert (problem.severity, problem.code, problem.file) == ("error", code, "campaign.toml")


def test_a_table_in_capitals_is_not_passed_over(small: SmallCampaign) -> None:
    """Only where the file system tells capitals apart; elsewhere the file simply is the table."""
    small["Density.csv"] = "sample,site,snow_density_kg_per_m3\n1,A,400\n"
    small.pop("density.csv", None)
    folder = small.written()
    if (folder / "density.csv").exists():
        pytest.skip("the file system does not tell capitals apart")
    problems = small.errors()
    assert [(p.code, p.file, p.allowed) for p in problems] == [("unreadable_file", "Density.csv", "density.csv")]
