"""Units of tables: stated ones are believed and converted; numbers that look like another unit than a silent heading's
column are errors with the result for both readings.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest
from tests.key_names import SNOW_DENSITY
from tests.present import present

from skisnow import write_reference
from skisnow.campaign import Campaign, Problem, check_campaign, read_campaign
from skisnow.campaign.problems import QUALITY_FLAGS
from skisnow.campaign.reading.campaign_files import FilesInMemory, RawFiles
from skisnow.campaign.reading.headings import conversion
from skisnow.campaign.snow_pit import LayerDensity, SnowLayer, SnowPit

from ..conftest import SmallCampaign, require_sentences

WriteCampaign = Callable[[Mapping[str, str | bytes]], Path]
SHARED = Path(__file__).parents[3].parent / "shared"
CASE = SHARED / "cases" / "campaign" / "one-sheet-a-site.xlsx"
SAND = SHARED / "data" / "plates-in-sand" / "plates_large_box_7level.csv"
COLUMNS = {
    "Versuch": "experiment", "Ort": "site", "Werkzeug": "tool", "Blatt": "plate", "Kantwinkel": "edge_angle_deg",
    "Last": "load_N", "Tiefe": "depth_mm", "Hebelarm": "lever_arm_mm", "Drehmoment": "moment_Nm",
    "Probe": "sample", "Dichte": "snow_density_kg_per_m3",
}  # fmt: skip
TOOLS = """
tool = [
  {name = "ski", shape = "ski", length_mm = 200, width_mm = 62},
  {name = "disc", shape = "disc", diameter_mm = 100},
]
plate = [{name = "blade", length_mm = 100}]
"""
LOADS = "1,A,ski,30,10,0.63\n1,A,ski,30,30,1.11\n1,A,ski,30,50,1.41\n"
SHEAR = "S1,A,blade,90,5.8,250,23.1\nS2,A,blade,60,4.4,250,20.1\n"


def campaign(
    loads: str = LOADS,
    shear: str = SHEAR,
    *,
    load: str = "Last",
    arm: str = "Hebelarm",
    toml: str = "",
    mapped: Mapping[str, str] | None = None,
    **further: str,
) -> dict[str, str]:
    """Tables with other headings, which state no unit but that of `load` and `arm`."""
    columns = COLUMNS | {load: "load_N", arm: "lever_arm_mm"} | dict(mapped or {})
    lines = [f'columns."{heading}" = "{column}"' for heading, column in columns.items() if heading != column]
    files = {
        "campaign.toml": "\n".join([*lines, toml, TOOLS]),
        "penetration.csv": f"Versuch,Ort,Werkzeug,Kantwinkel,{load},Tiefe\n{loads}",
        "shear.csv": f"Versuch,Ort,Blatt,Kantwinkel,Tiefe,{arm},Drehmoment\n{shear}",
    }
    return files | {f"{name}.csv": text for name, text in further.items()}


def problems(folder: Path) -> list[Problem]:
    return [each for each in check_campaign(folder) if each.needs_action]


def loads_of(read: Campaign) -> list[float]:
    return [float(each) for each in present(read.penetration).load]


def test_loads_that_look_like_kg_are_rejected(write_campaign: WriteCampaign) -> None:
    (problem,) = problems(write_campaign(campaign()))
    place = (problem.severity, problem.code, problem.file, problem.row, problem.column, problem.experiment)
    assert place == ("error", "unit_missing", "penetration.csv", 2, "load_N", "1")
    assert 'units."Last" = "kg"' in problem.action
    unknown = problems(write_campaign(campaign(LOADS.replace("ski", "other"))))
    assert {each.code for each in unknown} == {"unit_missing", "unknown_tool"}
    assert "Last [kg]" in problem.action


@pytest.mark.parametrize("heading", ["Last [kg]", "Last (kg)", "Last / kg", "Last in kg", "Last kg", "Last_kg"])
def test_a_heading_in_kg_is_believed(write_campaign: WriteCampaign, heading: str) -> None:
    folder = write_campaign(campaign(load=heading))
    assert loads_of(read_campaign(folder)) == pytest.approx([98.0665, 294.1995, 490.3325])
    (note,) = check_campaign(folder)
    assert (note.code, note.column, note.value) == ("converted_unit", "load_N", f"{heading} converted from kg")
    assert not note.needs_action


@pytest.mark.parametrize("heading", ["Last [N]", "Last (N)", "Last / N", "Last N", "Last_N", "load_N"])
def test_a_heading_in_newtons_is_believed(write_campaign: WriteCampaign, heading: str) -> None:
    folder = write_campaign(campaign(load=heading))
    assert loads_of(read_campaign(folder)) == [10.0, 30.0, 50.0]
    assert check_campaign(folder) == ()


@pytest.mark.parametrize(
    ("line", "factor"),
    [
        ('units."Last" = "kg"', 9.80665),
        ("units.last = 'KG'", 9.80665),
        ('units.penetration.Last = "kg"', 9.80665),
        ('units.Last = "N"', 1.0),
        ('units.Last = "N"\nunits.penetration.Last = "daN"', 10.0),
    ],
)
def test_a_unit_in_campaign_toml_is_believed(write_campaign: WriteCampaign, line: str, factor: float) -> None:
    folder = write_campaign(campaign(toml=line))
    assert loads_of(read_campaign(folder)) == pytest.approx([10.0 * factor, 30.0 * factor, 50.0 * factor])


def test_depths_that_look_like_cm_are_rejected(write_campaign: WriteCampaign) -> None:
    """No snow has 142 N/mm³; the same 490 N at 1.41 mm are 1.42 N/mm³."""
    loads = "1,A,ski,30,98.1,0.063\n1,A,ski,30,294.2,0.111\n1,A,ski,30,490.3,0.141\n"
    (problem,) = problems(write_campaign(campaign(loads)))
    assert (problem.code, problem.row, problem.column) == ("unit_missing", 2, "depth_mm")
    assert problems(write_campaign(campaign(loads, toml='units.Tiefe = "cm"'))) == []


@pytest.mark.parametrize(("largest", "refused"), [(0.141, True), (1.41, False)])
def test_depth_under_the_largest_load_of_the_loading_decides(
    write_campaign: WriteCampaign, largest: float, refused: bool
) -> None:
    """The depths under smaller loads and of the unloading would decide the opposite."""
    other = 1.41 if refused else 0.141
    rows = f"1,A,ski,30,98.1,{other},\n1,A,ski,30,490.3,{largest},\n1,A,ski,30,294.2,{other},\n"
    files = campaign(f"{rows}1,A,ski,30,490.3,{other},unloading\n1,A,ski,30,98.1,{other},unloading\n")
    files["penetration.csv"] = files["penetration.csv"].replace("Tiefe\n", "Tiefe,branch\n")
    found = [each.column for each in problems(write_campaign(files)) if each.code == "unit_missing"]
    assert found == (["depth_mm"] if refused else [])


@pytest.mark.parametrize(
    ("loads", "refused"),
    [
        ([10, 30, 50], True),
        ([10.5, 30, 79.5], True),
        ([10, 30, 80], False),
        ([10, 30.25, 50], False),
        ([12, 92, 492], False),
        ([98.07, 196.13], False),
    ],
)
def test_loads_that_are_rejected(write_campaign: WriteCampaign, loads: list[float], refused: bool) -> None:
    rows = "".join(f"1,A,ski,30,{load},{0.1 * i + 0.5}\n" for i, load in enumerate(loads))
    assert bool(problems(write_campaign(campaign(rows)))) is refused


def test_each_tool_is_judged_separately(write_campaign: WriteCampaign) -> None:
    """The disc's loads are small; those of the ski are not, and unloading and an empty table change nothing."""
    rows = "1,A,ski,30,100,0.63\n1,A,ski,30,300,1.11\n2,A,disc,0,20,0.5\n2,A,disc,0,40,1.0\n"
    (problem,) = problems(write_campaign(campaign(rows)))
    assert (problem.row, problem.experiment) == (4, "2")


def test_lever_arms_in_cm_are_rejected(write_campaign: WriteCampaign) -> None:
    (problem,) = problems(write_campaign(campaign(shear="S1,A,blade,90,5.8,25,23.1\n", load="Last [N]")))
    assert (problem.code, problem.row, problem.column) == ("unit_missing", 2, "lever_arm_mm")
    assert "Hebelarm [cm]" in problem.action


@pytest.mark.parametrize(
    ("arm", "cell", "millimetres"),
    [
        ("Hebelarm [cm]", 25, 250.0),
        ("Hebelarm [m]", 0.25, 250.0),
        ("Hebelarm_m", 6, 6000.0),
        ("Hebelarm [mm]", 25, 25.0),
        ("lever_arm_mm", 6000, 6000.0),
    ],
)
def test_stated_lever_arms_are_used(write_campaign: WriteCampaign, arm: str, cell: float, millimetres: float) -> None:
    folder = write_campaign(campaign(shear=f"S1,A,blade,90,5.8,{cell},23.1\n", arm=arm, load="Last [N]"))
    assert not [each for each in problems(folder) if each.severity == "error"]
    shear = present(read_campaign(folder).shear)
    assert float(shear.lever_arm[0]) == pytest.approx(1e-3 * millimetres)


@pytest.mark.parametrize(
    ("arm", "unit"), [(0.25, "m"), (4.9, "m"), (5, "cm"), (99.9, "cm"), (5001, "µm"), (250000, "µm")]
)
def test_lever_arms_that_are_rejected(write_campaign: WriteCampaign, arm: float, unit: str) -> None:
    (problem,) = problems(write_campaign(campaign(shear=f"S1,A,blade,90,5.8,{arm},23.1\n", load="Last [N]")))
    assert (problem.code, problem.severity) == ("unit_missing", "error")
    assert f'units."Hebelarm" = "{unit}"' in problem.action


@pytest.mark.parametrize("arm", [100, 5000])
def test_lever_arms_that_are_just_allowed(write_campaign: WriteCampaign, arm: float) -> None:
    assert problems(write_campaign(campaign(shear=f"S1,A,blade,90,5.8,{arm},23.1\n", load="Last [N]"))) == []


def test_values_of_a_column_without_unit_are_quoted_with_the_first_row(write_campaign: WriteCampaign) -> None:
    """A cell that is not a number is no value."""
    files = campaign("1,A,ski,30,x,0.63\n1,A,ski,30,10,0.7\n1,A,ski,30,50,1.41\n")
    (problem,) = [each for each in check_campaign(write_campaign(files)) if each.code == "unit_missing"]
    assert (problem.row, problem.value) == (3, "Last: 10 to 50 with tool ski")
    files = campaign(shear="S1,A,blade,90,5.8,x,23.1\nS2,A,blade,90,5.8,30,1\nS3,A,blade,90,5.8,25,1\n", load="load_N")
    (problem,) = [each for each in check_campaign(write_campaign(files)) if each.code == "unit_missing"]
    assert (problem.row, problem.value) == (3, "Hebelarm: 25 to 30")
    (problem,) = problems(write_campaign(campaign(load="load_N", density="Probe,Ort,Dichte\nD1,A,0.3\nD2,A,0.4\n")))
    assert (problem.row, problem.value) == (2, "Dichte: with a median of 0.35")


@pytest.mark.parametrize(
    ("depths", "row"),
    [([0.177], 2), ([0.1774], None), ([0.141, 1.41], None), ([1.41, 0.141], None), ([1.41, 0.141, 0.141], 2)],
)
def test_half_of_the_experiments_harder_than_any_snow(
    write_campaign: WriteCampaign, depths: list[float], row: int | None
) -> None:
    """At 30° and 490.3 N, 0.177 mm are 90.2 N/mm³ and 0.1774 mm are 89.8 N/mm³."""
    loads = "".join(f"{name},A,ski,30,490.3,{depth}\n" for name, depth in enumerate(depths))
    found = [(each.row, each.value) for each in problems(write_campaign(campaign(loads)))]
    assert found == ([(row, f"Tiefe: {min(depths)} to {max(depths)} with tool ski")] if row else [])


def test_one_lever_arm_above_five_metres_is_enough(write_campaign: WriteCampaign) -> None:
    rows = SHEAR + "S3,A,blade,90,5.8,5000.5,23.1\n"
    (problem,) = [each for each in problems(write_campaign(campaign(shear=rows, load="Last [N]"))) if each.row]
    assert problem.code == "unit_missing"


@pytest.mark.parametrize(
    ("heading", "column", "cells", "unit"),
    [
        ("Dichte", SNOW_DENSITY, "0.41", "g/cm³"),
        ("Drehmoment", "moment_Nm", "2310", "N mm"),
        ("Tiefe", "depth_mm", "0.0058", "m"),
    ],
)
def test_unitless_headings(write_campaign: WriteCampaign, heading: str, column: str, cells: str, unit: str) -> None:
    row = {"Tiefe": "5.8", "Drehmoment": "23.1"} | {heading: cells}
    files = campaign(shear=f"S1,A,blade,90,{row['Tiefe']},250,{row['Drehmoment']}\n", load="Last [N]")
    if heading == "Dichte":
        files["density.csv"] = f"Probe,Ort,Dichte\nD1,A,{cells}\n"
    (problem,) = problems(write_campaign(files))
    assert (problem.severity, problem.code, problem.column) == ("error", "unit_missing", column)
    assert unit in problem.action


@pytest.mark.parametrize(
    ("heading", "column", "cell", "value"),
    [
        ("Dichte [g/cm³]", SNOW_DENSITY, 0.41, 410.0),
        ("Dichte g/cm3", SNOW_DENSITY, 0.41, 410.0),
        ("Dichte [kg/l]", SNOW_DENSITY, 0.41, 410.0),
        ("Dichte [g/l]", SNOW_DENSITY, 410.0, 410.0),
    ],
)
def test_density_units(write_campaign: WriteCampaign, heading: str, column: str, cell: float, value: float) -> None:
    files = campaign(load="Last [N]", mapped={heading: column}, density=f"Probe,Ort,{heading}\nD1,A,{cell}\n")
    density = present(read_campaign(write_campaign(files)).density)
    assert density.snow_density.tolist() == pytest.approx([value])


@pytest.mark.parametrize(
    ("heading", "cell", "degrees"),
    [("Winkel [rad]", 0.5, 28.64788975654116), ("Winkel [°]", 30, 30.0), ("Winkel [Grad]", 30, 30.0)],
)
def test_angles_are_converted(write_campaign: WriteCampaign, heading: str, cell: float, degrees: float) -> None:
    files = campaign(load="Last [N]", mapped={heading: "edge_angle_deg"})
    files["penetration.csv"] = f"Versuch,Ort,Werkzeug,{heading},Last [N],Tiefe\n1,A,ski,{cell},100.5,1.2\n"
    tests = present(read_campaign(write_campaign(files)).penetration)
    assert np.degrees(tests.edge_angle).tolist() == pytest.approx([degrees])


def test_ranges_and_corrections_are_those_of_the_file(write_campaign: WriteCampaign) -> None:
    """500 cm are within the range of 5 m; a correction names the cell as it is written."""
    corrections = (
        "file,experiment,row,column,old,new,who,when,why\npenetration.csv,1,3,load_N,30,31,A,2026-01-01,misread\n"
    )
    folder = write_campaign(campaign(load="Last [kg]", corrections=corrections))
    assert loads_of(read_campaign(folder))[1] == pytest.approx(31.0 * 9.80665)
    files = campaign(
        load="Last [N]",
        mapped={"Dichte [g/cm³]": "snow_density_kg_per_m3"},
        density="Probe,Ort,Dichte [g/cm³]\nD1,A,0.95\n",
    )
    (problem,) = problems(write_campaign(files))
    assert (problem.code, problem.value) == ("out_of_range", "0.95 g/cm³")


@pytest.mark.parametrize(
    ("changes", "code", "file", "column"),
    [
        ({"toml": 'units.Last = "kgg"'}, "bad_toml", "campaign.toml", "units.Last"),
        ({"toml": "units.Last = 3"}, "bad_toml", "campaign.toml", "units.Last"),
        ({"toml": 'units.Lasst = "kg"', "load": "Last [N]"}, "bad_toml", "campaign.toml", "units.lasst"),
        ({"toml": 'units.shear.Last = "kg"', "load": "Last [N]"}, "bad_toml", "campaign.toml", "units.shear.last"),
        ({"toml": 'units.Last = "mm"'}, "other_unit", "penetration.csv", "load_N"),
        ({"toml": 'units."Last [N]" = "kg"', "load": "Last [N]"}, "other_unit", "penetration.csv", "load_N"),
        ({"toml": 'units.load_N = "kg"', "load": "load_N"}, "other_unit", "penetration.csv", "load_N"),
        ({"load": "Last [MN]"}, "other_unit", "penetration.csv", "load_N"),
    ],
)
def test_units_that_cannot_be_are_rejected(
    write_campaign: WriteCampaign, changes: dict[str, Any], code: str, file: str, column: str
) -> None:
    found = [each for each in problems(write_campaign(campaign(**changes))) if each.severity == "error"]
    assert (code, file, column) in [(each.code, each.file, each.column) for each in found]


@pytest.mark.parametrize("units", ["Nr.,,,°,kg,mm", ",,,[°],[kg],[mm]", "-,-,-,,kg,mm"])
def test_a_row_of_units_below_the_headings_is_believed(write_campaign: WriteCampaign, units: str) -> None:
    folder = write_campaign(campaign(f"{units}\n{LOADS}"))
    read = read_campaign(folder)
    assert loads_of(read) == pytest.approx([98.0665, 294.1995, 490.3325])
    assert present(read.penetration).row.tolist() == [3, 4, 5]
    assert not problems(folder)


def test_a_row_of_units_that_contradicts_is_rejected(write_campaign: WriteCampaign) -> None:
    for changes in ({"load": "Last [N]"}, {"load": "load_N"}, {"toml": 'units.Last = "N"'}):
        (problem,) = problems(write_campaign(campaign(f",,,°,kg,mm\n{LOADS}", **changes)))  # type: ignore[arg-type]
        assert (problem.code, problem.column) == ("other_unit", "load_N")


def test_a_row_with_numbers_is_not_one_of_units(write_campaign: WriteCampaign) -> None:
    found = problems(write_campaign(campaign(f"1,A,ski,30,kg,mm\n{LOADS}", load="Last [kg]")))
    assert [(each.code, each.row) for each in found] == [("not_a_number", 2), ("not_a_number", 2)]


def test_the_same_unit_twice_is_no_contradiction(write_campaign: WriteCampaign) -> None:
    folder = write_campaign(campaign(load="Last [kg]", toml='units."Last [kg]" = "kgf"'))
    assert loads_of(read_campaign(folder))[0] == pytest.approx(98.0665)


def test_columns_that_are_kept_as_text_are_not_converted(write_campaign: WriteCampaign) -> None:
    files = campaign(load="Last [N]", mapped={"Luft [°F]": "air_temperature_C"})
    files["penetration.csv"] = "Versuch,Ort,Werkzeug,Kantwinkel,Last [N],Tiefe,Luft [°F]\n1,A,ski,30,100,1.2,14\n"
    (problem,) = problems(write_campaign(files))
    assert (problem.code, problem.row, problem.column) == ("other_unit", 1, "air_temperature_C")
    assert (problem.value, problem.allowed) == ("Luft [°F]", "numbers in °C")


def test_a_row_with_one_unit_is_not_one_of_units(write_campaign: WriteCampaign) -> None:
    found = problems(write_campaign(campaign(f",,,,kg,\n{LOADS}")))
    assert {(each.code, each.row) for each in found if each.severity == "error"} >= {("not_a_number", 2)}


def silent(folder: Path) -> Path:
    """A campaign with headings that state no unit, instead of the standard names."""
    names = {column: heading for heading, column in COLUMNS.items()} | {"drop_cone_depth_mm": "Kegel"}
    lines = []
    for table in folder.glob("*.csv"):
        head, rest = table.read_text(encoding="utf-8").split("\n", 1)
        headings = [names.get(column, column) for column in head.split(",")]
        pairs = zip(headings, head.split(","), strict=True)
        lines += [f'columns.{table.stem}."{heading}" = "{column}"' for heading, column in pairs if heading != column]
        table.write_text("\n".join((",".join(headings), rest)), encoding="utf-8")
    toml = folder / "campaign.toml"
    toml.write_text("\n".join((*lines, toml.read_text(encoding="utf-8"))), encoding="utf-8")
    return folder


@pytest.mark.parametrize("seeds", [range(3), pytest.param(range(3, 200), marks=pytest.mark.slow)])
def test_no_reference_campaign_is_rejected(tmp_path: Path, seeds: range) -> None:
    for seed in seeds:
        folder = tmp_path / str(seed)
        write_reference(folder, seed=seed)
        assert problems(silent(folder)) == []


@pytest.mark.skipif(not SAND.is_file(), reason="no ../shared")
def test_no_shared_data_are_rejected(write_campaign: WriteCampaign) -> None:
    """Plates in sand, a disc each; their loads go up to 460 N and have three decimals."""
    rows = [line.split(",") for line in SAND.read_text(encoding="utf-8").splitlines()[1:]]
    table = "".join(f"{trial},A,disc,0,{load},{depth}\n" for trial, _, _, depth, load in rows)
    found = [each.code for each in problems(write_campaign(campaign(table)))]
    assert "unit_missing" not in found


@pytest.mark.skipif(not CASE.is_file(), reason="no ../shared")
def test_shared_case_reshaped_by_hand(write_campaign: WriteCampaign) -> None:
    """H_V of series 2 of the upper and of series 6 of the lower slope, and S_f of S1, as the cases' README has them."""
    import openpyxl

    from skisnow import analyse, results_dict

    loads, shear = "", ""
    for sheet in openpyxl.load_workbook(CASE).worksheets[:2]:
        cells = sheet.iter_rows(values_only=True)
        rows = [["" if each is None else str(each).replace(",", ".") for each in row] for row in cells]
        series = angle = ""
        for name, tilt, load, depth, *_ in rows[6:36]:
            series, angle = name or series, tilt or angle
            loads += f"{sheet.title} {series},{sheet.title},ski,{angle},{load},{depth}\n"
        for name, tilt, depth, arm, moment, *_ in rows[40:45]:
            shear += f"{sheet.title} {name},{sheet.title},blade,{tilt},{depth},{arm},{moment}\n"
    assert {each.column for each in problems(write_campaign(campaign(loads, shear)))} == {"load_N", "lever_arm_mm"}
    folder = write_campaign(campaign(loads, shear, toml='units.Last = "kg"\nunits.Hebelarm = "cm"'))
    results = results_dict(analyse(read_campaign(folder), n_resamples=100))
    hardness = {each["experiment"]: each["H_V_N_per_mm3"] for each in results["penetration"]["experiments"]}
    assert [hardness["Hang oben 2"], hardness["Hang unten 6"]] == pytest.approx([1.424, 0.896], rel=1e-3)
    stress = {each["experiment"]: each["S_f_N_per_mm2"] for each in results["shear"]["experiments"]}
    assert stress["Hang oben S1"] == pytest.approx(0.159, abs=5e-4)


SIZES = [
    ("edge_angle_deg", "deg 1 0, ° 1 0, rad 57.29577951308232 0"),
    ("load_N", "n 1 0, kg 9.80665 0, kp 9.80665 0, g 0.00980665 0, kn 1000 0, dan 10 0"),
    ("depth_mm", "mm 1 0, cm 10 0, m 1000 0, dm 100 0, µm 0.001 0, um 0.001 0, in 25.4 0, inch 25.4 0"),
    ("moment_Nm", "nm 1 0, ncm 0.01 0, nmm 0.001 0, knm 1000 0"),
    (SNOW_DENSITY, "kg/m³ 1 0, g/l 1 0, g/cm³ 1000 0, kg/l 1000 0, t/m3 1000 0"),
    ("snow_temperature_C", "°c 1 0, k 1 -273.15, °f 0.5555555555555556 -17.77777777777778"),
]
"""Factor and shift of each unit, by column."""


@pytest.mark.parametrize(("column", "sizes"), SIZES)
def test_sizes_of_all_units(column: str, sizes: str) -> None:
    for size in sizes.split(", "):
        unit, factor, shift = size.split()
        found = present(conversion(unit.casefold(), column))
        assert found.convert(np.array([2.0, 0.0])) == pytest.approx([2.0 * float(factor) + float(shift), float(shift)])
        assert found.revert(2.0 * float(factor) + float(shift)) == pytest.approx(2.0)


WEATHER = "SMET 1.1 ASCII\nstation_id = A\nnodata = -999\nfields = timestamp TA\n[DATA]\n2026-02-03T08:00 {}\n"


@pytest.mark.parametrize(
    ("name", "file", "place"),
    [
        ("s.SMET", WEATHER.format(270), None),
        ("s.csv", "", ("campaign.toml", "weather.file", "s.csv")),
        ("../s.smet", "", ("campaign.toml", "weather.file", "../s.smet")),
        ("t.smet", WEATHER.format(270), ("campaign.toml", "weather.file", "t.smet")),
        ("s.SMET", WEATHER.format("cold"), ("s.SMET", "TA", "cold")),
    ],
)
def test_weather_files(small: SmallCampaign, name: str, file: str, place: tuple[str, ...] | None) -> None:
    small["campaign.toml"] += f'[weather]\nfile = "{name}"\n'
    errors = small.errors({"s.SMET": file})
    assert [(each.file, each.column, each.value) for each in errors] == ([] if place is None else [place])
    assert {each.code for each in errors} <= {"unreadable_file"}
    if place is None:
        assert present(small.read({"s.SMET": file}).weather).series.fields["TA"].tolist() == [270.0]


@pytest.mark.parametrize(("failure", "value"), [((5, "told"), "told"), (("untold",), "untold"), ((), None)])
def test_a_file_that_cannot_be_read(
    failure: tuple[Any, ...], value: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    result = {"side_effect": OSError(*failure)} if failure else {"return_value": None}
    monkeypatch.setattr(FilesInMemory, "read", Mock(**result))
    files = RawFiles(FilesInMemory({}))
    assert (files.read("shear.csv"), files.hashes, files.absent) == (None, {}, set())
    (problem,) = require_sentences(files.problems)
    assert (problem.code, problem.file) == ("unreadable_file", "shear.csv")
    assert value in (None, problem.value)


def test_representations_and_the_uncertainty_of_depths(small: SmallCampaign) -> None:
    read = small.read()
    assert read.depth_uncertainty == pytest.approx(1e-5 / 12**0.5)
    assert replace(read, gauge_resolution=None).depth_uncertainty is None
    numbers = {
        "2 5 2 3 300 410.5 3 12.5 17 0.01 0": read,
        "2 5 100 0 30 70.5 210.5 0.5 3.75": read.penetration,
        "2 45 90 5.5 6 300 300 10 12.25": read.shear,
        "3 300 410.5": read.density,
        "3 12.5 17": read.drop_cone,
        "1 2 0 150": SnowPit("", snow_height=1.5, layers=(SnowLayer(0),), densities=(LayerDensity(0, 1),) * 2),
    }
    assert [" ".join(re.findall(r"\d+\.?\d*", repr(table))) for table in numbers.values()] == list(numbers)
    assert QUALITY_FLAGS["too_few_loads"].name == "too few loads"
