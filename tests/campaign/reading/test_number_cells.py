"""Cells to numbers: what Python would take for a number and people do not."""

import math
from collections.abc import Callable
from decimal import Decimal
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.key_names import DROP_CONE_DEPTH, SNOW_DENSITY

from skisnow import analyse, results_dict, write_reference
from skisnow._support.messages import Message
from skisnow._support.spreadsheet_text import is_number, number
from skisnow.campaign import Problem, check_campaign, read_campaign
from skisnow.campaign.problems import error
from skisnow.campaign.reading.columns import iso_moment, numbers
from skisnow.campaign.reading.row_checks import LIKELY
from skisnow.parameters.quantity import LARGEST, SMALLEST

from ..conftest import SmallCampaign

GOOD = {"1": 1.0, "-2.5": -2.5, "+.5": 0.5, "3.": 3.0, "1e3": 1000.0, "2.5E-1": 0.25, " 7.5\u00a0": 7.5, "007": 7.0}
BAD = ["", "nan", "inf", "1_000", "1 000", "١", "1.2.3", "0x10", "1e999", "."]


@pytest.mark.parametrize("with_bad", [False, True])
def test_points(with_bad: bool) -> None:
    """The whole column at once and cell by cell give the same."""
    for cell, value in GOOD.items():
        found = numbers([cell, "abc" if with_bad else "1"], ".")
        assert found[0] == value == number(cell, ".")


@pytest.mark.parametrize("cell", BAD)
def test_no_numbers(cell: str) -> None:
    for others in (["1.5"], ["1.5", ""], ["x"]):
        found = numbers([cell, *others], ".")
        assert math.isnan(found[0])
    assert numbers(["1.5", cell], ".")[0] == 1.5
    assert math.isnan(number(cell, "."))


def test_decimal_commas_take_no_points() -> None:
    np.testing.assert_array_equal(numbers(["1,5", "2", "-,25", "1e2"], ","), [1.5, 2.0, -0.25, 100.0])
    np.testing.assert_array_equal(numbers(["1,5", "1.5", "1,2,3", ""], ","), [1.5, np.nan, np.nan, np.nan])


@settings(max_examples=40)
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1), st.sampled_from(".,"))
def test_every_float_comes_back(values: list[float], mark: str) -> None:
    cells = [repr(value).replace(".", mark) for value in values]
    assert numbers(cells, mark).tolist() == values


def test_a_long_cell_is_rejected_after_one_pass() -> None:
    for cell in ("1" * 1_000_000 + "x", "1" * 1_000_000, "." * 1_000_000, "1e" + "1" * 1_000_000 + "e"):
        assert not is_number(cell, ".")  # with backtracking this would take hours
        assert math.isnan(number(cell))


def test_every_number_in_double_precision_can_be_written_in_full() -> None:
    longest = format(Decimal(-math.nextafter(2.0**-1022, 0.0)), "f")
    assert len(longest) == 1077
    assert number(longest) == -math.nextafter(2.0**-1022, 0.0)


@pytest.mark.parametrize("length", [200, 201, 30_000])
def test_a_long_cell_is_kept_and_its_sentence_is_short(length: int) -> None:
    cell = "9" * length
    problem = error(
        "not_a_number",
        "shear.csv",
        row=3,
        column="depth_mm",
        value=cell,
        allowed=Message("a number"),
        action=Message(""),
    )
    assert problem.value == cell
    assert str(problem).count("9") == 200
    assert ("…" in str(problem)) is (length > 200)


# Days that are read, and days that are reported


@pytest.mark.parametrize(
    ("cell", "written"),
    [
        ("23.11.2026", "2026-11-23"),
        ("3. 4. 26 7:05", "2026-04-03T07:05:00"),
        ("23.11.2026 um 14:30 Uhr", "2026-11-23T14:30:00"),
        ("23/11/2026 14:30:15", "2026-11-23T14:30:15"),
        ("4/4/2026", "2026-04-04"),
        ("2026-11-23T09:10:00Z", "2026-11-23T09:10:00Z"),
        ("9:05", "9:05"),
        ("9:05:07", "9:05:07"),
        ("12/12/2026", "2026-12-12"),
        ("13/12/2026", "2026-12-13"),
        ("12/13/2026", "2026-12-13"),
        ("1.2.99", "2099-02-01"),
        ("1.2.0100", "0100-02-01"),
    ],
)
def test_days_that_are_read(cell: str, written: str) -> None:
    assert iso_moment(cell) == written


@pytest.mark.parametrize(
    "cell", ["3/4/2026", "32.1.2026", "23.13.2026", "23.11.2026 25:00", "2026", "25:10", "12/11/2026", "11/12/2026"]
)
def test_days_that_are_none_or_could_be_two(cell: str) -> None:
    assert iso_moment(cell) is None


def test_a_day_that_cannot_be_read_is_one_warning_and_stays(small: SmallCampaign) -> None:
    table = "sample,site,snow_density_kg_per_m3,time\nD1,Süd,410,1.2.2026\nD2,Süd,400,gestern\nD3,Nord,390,3/4/2026\n"
    folder = small.written({"density.csv": table})
    (problem,) = check_campaign(folder)
    found = (problem.severity, problem.code, problem.row, problem.column, problem.experiment)
    assert problem.value == "gestern, and 1 more like it"
    assert found == ("warning", "unreadable_date", 3, "time", "D2")
    density = read_campaign(folder).density
    assert density is not None
    assert density.further["time"] == ("2026-02-01", "gestern", "3/4/2026")
    (problem,) = check_campaign(small.written({"density.csv": table.replace("3/4/2026", "")}))
    assert problem.value == "gestern"


# Campaigns in a wrong unit are warned of, those of the paper's sizes are not; a row pasted twice is reported


TABLES = ("penetration.csv", "shear.csv", "density.csv", "drop_cone.csv")


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("units") / "reference"
    write_reference(folder, seed=1)
    return folder


def changed(reference: Path, target: Path, file: str, change: Callable[[dict[str, str], int], None]) -> Path:
    """A copy of the reference campaign with each row of one file changed in place; rows count from 0."""
    target.mkdir()
    for name in ("campaign.toml", *TABLES):
        lines = (reference / name).read_text(encoding="utf-8").splitlines()
        if name == file:
            head = lines[0].split(",")
            for index, line in enumerate(lines[1:]):
                cells = dict(zip(head, line.split(","), strict=True))
                change(cells, index)
                lines[index + 1] = ",".join(cells.values())
        (target / name).write_text("\n".join(lines) + "\n", encoding="utf-8")
    return target


def times(column: str, factor: float, only: int | None = None) -> Callable[[dict[str, str], int], None]:
    def change(cells: dict[str, str], index: int) -> None:
        if only is None or index == only:
            cells[column] = f"{float(cells[column]) * factor:.10g}"

    return change


def warned(folder: Path) -> list[Problem]:
    return [problem for problem in check_campaign(folder) if problem.code in ("unlikely_unit", "repeated_row")]


def test_the_reference_campaign_is_not_warned_of(reference: Path) -> None:
    assert check_campaign(reference) == ()


@pytest.mark.parametrize(
    ("file", "column", "factor", "unit"),
    [
        ("penetration.csv", "load_N", 1e-3, "kN"),
        ("penetration.csv", "load_N", 1e3, "mN"),
        ("penetration.csv", "depth_mm", 1e-3, "m"),
        ("penetration.csv", "depth_mm", 1e3, "µm"),
        ("shear.csv", "lever_arm_mm", 1e-3, "m"),
        ("shear.csv", "lever_arm_mm", 0.1, "cm"),
        ("shear.csv", "moment_Nm", 1e3, "N mm"),
        ("shear.csv", "moment_Nm", 1e-3, "kN m"),
        ("shear.csv", "depth_mm", 1e-3, "m"),
        ("density.csv", SNOW_DENSITY, 1e-3, "g/cm³"),
        ("drop_cone.csv", DROP_CONE_DEPTH, 1e-3, "m"),
    ],
)
def test_a_file_in_other_units(
    reference: Path, tmp_path: Path, file: str, column: str, factor: float, unit: str
) -> None:
    (found,) = warned(changed(reference, tmp_path / "c", file, times(column, factor)))
    assert (found.severity, found.code, found.file, found.column) == ("warning", "unlikely_unit", file, column)
    assert unit in found.action


@pytest.mark.parametrize(
    ("file", "column", "factor"),
    [
        ("penetration.csv", "load_N", 1e-3),
        ("shear.csv", "lever_arm_mm", 1e-3),
        ("shear.csv", "moment_Nm", 1e3),
        ("density.csv", SNOW_DENSITY, 1e-3),
    ],
)
def test_one_row_in_another_unit(reference: Path, tmp_path: Path, file: str, column: str, factor: float) -> None:
    (found,) = warned(changed(reference, tmp_path / "c", file, times(column, factor, only=3)))
    assert (found.code, found.file, found.row, found.column) == ("unlikely_unit", file, 5, column)


@pytest.mark.parametrize("factor", [1e300, 1e-300])
@pytest.mark.parametrize(
    ("file", "column"),
    [("penetration.csv", "load_N"), ("shear.csv", "moment_Nm"), ("shear.csv", "lever_arm_mm"),
     ("density.csv", SNOW_DENSITY), ("drop_cone.csv", DROP_CONE_DEPTH)],
)  # fmt: skip
def test_absurd_numbers_are_rejected(reference: Path, tmp_path: Path, file: str, column: str, factor: float) -> None:
    found = check_campaign(changed(reference, tmp_path / "c", file, times(column, factor)))
    errors = [problem for problem in found if problem.severity == "error"]
    assert {(problem.code, problem.file, problem.column) for problem in errors} == {("out_of_range", file, column)}


def test_lengths_of_campaign_toml_in_metres(reference: Path, tmp_path: Path) -> None:
    folder = changed(reference, tmp_path / "c", "", times("", 1.0))
    text = (folder / "campaign.toml").read_text(encoding="utf-8")
    metres = text.replace("width_mm = 62", "width_mm = 0.062").replace(
        "gauge_resolution_mm = 0.01", "gauge_resolution_mm = 1e-5"
    )
    assert metres != text
    (folder / "campaign.toml").write_text(metres, encoding="utf-8")
    assert {problem.column for problem in warned(folder)} == {"gauge_resolution_mm", "tool[1].width_mm"}


def test_a_warning_of_units_is_in_the_results(reference: Path, tmp_path: Path) -> None:
    folder = changed(reference, tmp_path / "c", "shear.csv", times("lever_arm_mm", 1e-3))
    (folder / "penetration.csv").unlink()
    (told,) = results_dict(analyse(read_campaign(folder), n_resamples=100))["campaign"]["warnings"]
    assert told["code"] == "unlikely_unit"


@pytest.mark.parametrize("file", ["density.csv", "drop_cone.csv"])
def test_a_row_pasted_twice(reference: Path, tmp_path: Path, file: str) -> None:
    folder = changed(reference, tmp_path / "c", "", times("", 1.0))
    lines = (folder / file).read_text(encoding="utf-8").splitlines()
    (folder / file).write_text("\n".join([*lines, lines[2], lines[2]]) + "\n", encoding="utf-8")
    found = warned(folder)
    assert [(each.code, each.file, each.row, str(each.value)[-5:]) for each in found] == [
        ("repeated_row", file, len(lines) + 1, "row 3"),
        ("repeated_row", file, len(lines) + 2, "row 3"),
    ]


@pytest.mark.parametrize(
    ("column", "low", "high", "if_low", "if_high"),
    [
        ("load_N", 2, 20_000, "kN", "mN or g"),
        ("depth_mm", 0.02, 500, "m", "µm"),
        ("lever_arm_mm", 40, 5000, "m or cm", "µm"),
        ("moment_Nm", 0.1, 1000, "kN m", "N mm or N cm"),
        (SNOW_DENSITY, 20, 917, "g/cm³", "g/m³"),
        (DROP_CONE_DEPTH, 0.5, 300, "m", "µm"),
    ],
)
def test_limits_of_likely_medians(column: str, low: float, high: float, if_low: str, if_high: str) -> None:
    likely = LIKELY[column]
    medians = (math.nextafter(low, 0.0), low, high, math.nextafter(high, math.inf))
    assert [likely.other_unit(median) for median in medians] == [if_low, "", "", if_high]
    assert likely.each_row is (column != "depth_mm")


@pytest.mark.parametrize(
    ("cells", "row", "value", "other"),
    [
        (["5000"], None, "", ""),
        (["5001"], 6, "5001", "µm"),
        (["0.02"], None, "", ""),
        (["0.0199"], 6, "0.0199", "m"),
        (["0", "0.0199", "5001"], 7, "0.0199, and 1 more like it", "m"),
    ],
)
def test_a_number_500_times_the_median_is_reported(
    small: SmallCampaign, cells: list[str], row: int | None, value: str, other: str
) -> None:
    """The median without zeros is 10 mm."""
    tests = "".join(f"C{index},Süd,1,{cell}\n" for index, cell in enumerate(["10", "10", "10", "10", *cells]))
    found = small.check({"drop_cone.csv": f"test,site,repeat,drop_cone_depth_mm\n{tests}"})
    places = [(each.code, each.row, each.column, each.value) for each in found]
    assert places == ([("unlikely_unit", row, DROP_CONE_DEPTH, value)] if row else [])
    assert all(f"this is {other} or" in each.action and "factor 500 " in each.allowed for each in found)


def test_an_unlikely_median_and_an_absurd_number_are_quoted(small: SmallCampaign) -> None:
    small["drop_cone.csv"] = "test,site,repeat,drop_cone_depth_mm\nC1,A,1,301\nC1,A,2,401\nC1,A,3,0\n"
    (problem,) = small.check()
    assert (problem.value, problem.row, problem.experiment) == ("a median of 351", None, None)
    assert "0.5 to 300 " in problem.allowed
    (problem,) = small.errors({"drop_cone.csv": "test,site,repeat,drop_cone_depth_mm\nC1,A,1, 1e300\n"})
    assert (problem.row, problem.value) == (2, "1e300")
    assert f"{SMALLEST:g} to {LARGEST:g}" in problem.allowed
