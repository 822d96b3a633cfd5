"""campaign.toml and the file of corrections."""

import csv
import io
import tomllib
from typing import Any

import jsonschema
import pytest
from tests.present import present

from skisnow.campaign.problems import QUALITY_FLAGS, Problem
from skisnow.campaign.reading.campaign_file import SHAPES, CampaignFile, read_campaign_file
from skisnow.cli.shell import json_schema

from ..conftest import SmallCampaign

Where = tuple[int | None, str | None, str | None, str | None]
Row = tuple[str, str, str, str, str, str]

PEN, SHEAR, DENSITY, CONE, FILE = "penetration.csv", "shear.csv", "density.csv", "drop_cone.csv", "corrections.csv"
HEADER = ("file", "experiment", "row", "column", "old", "new", "who", "when", "why")


def corrections(*rows: Row) -> str:
    stream = io.StringIO()
    writer = csv.writer(stream)
    writer.writerow(HEADER)
    writer.writerows((*row, "AM", "2013-02-01T10:00", "misread, twice") for row in rows)
    return stream.getvalue()


def where(problem: Problem) -> Where:
    assert (problem.severity, problem.file) == ("error", FILE)
    return (problem.row, problem.column, problem.experiment, problem.value)


def test_cells_are_corrected_before_they_are_read(small: SmallCampaign) -> None:
    small.replace(PEN, "140.5,2.5", "140.5,2.s")
    small[FILE] = corrections(
        (PEN, "P1", "3", "depth_mm", "2.s", "2.75"),
        (PEN, "P1", "2", "remark", "first", "sun, wind"),
        (PEN, "P1", "4", "snow_density_kg_per_m3", "360.0", ""),
        (SHEAR, "S2", "3", "experiment", "S2", "S9"),
        (SHEAR, "S9", "3", "moment_Nm", "10", "11"),
        (DENSITY, "D2", "4", "snow_density_kg_per_m3", "310", "320"),
        (CONE, "C2", "4", "drop_cone_depth_mm", "17", "18"),
    )
    campaign = small.read()
    assert campaign.penetration is not None
    assert campaign.penetration.penetration_depth[1] == pytest.approx(2.75e-3)
    assert campaign.penetration.further["remark"][0] == "sun, wind"
    assert campaign.penetration.snow_density[0] == 350.0
    assert present(campaign.shear).experiment == ("S1", "S9")
    assert present(campaign.shear).moment[1] == 11.0
    assert present(campaign.density).snow_density[2] == 320.0
    assert present(campaign.drop_cone).drop_cone_depth[2] == pytest.approx(0.018)
    assert campaign.problems == ()


def test_corrections_of_one_cell_chain_in_their_order(small: SmallCampaign) -> None:
    first = (PEN, "P1", "3", "depth_mm", "2.5", "2.6")
    second = (PEN, "P1", "3", "depth_mm", "2.6", "2.7")
    tests = present(small.read({FILE: corrections(first, second)}).penetration)
    assert tests.penetration_depth[1] == pytest.approx(2.7e-3)
    problems = small.check({FILE: corrections(second, first)})
    assert [where(problem) for problem in problems] == [(2, "old", "P1", "2.6")]


@pytest.mark.parametrize(("file", "experiment"), [(PEN, "P2"), (SHEAR, "S2"), (DENSITY, "D2"), (CONE, "C2")])
def test_status_cancels_with_and_without_such_a_column(small: SmallCampaign, file: str, experiment: str) -> None:
    row = next(number for number, line in enumerate(small[file].splitlines(), 1) if line.startswith(experiment))
    small[FILE] = corrections((file, experiment, str(row), "status", "", "ice below"))
    campaign = small.read()
    tables = {PEN: campaign.penetration, SHEAR: campaign.shear, DENSITY: campaign.density, CONE: campaign.drop_cone}
    expected: dict[str, tuple[str, ...]] = {PEN: ("", "ice below"), SHEAR: ("", "ice below")}
    expected |= {DENSITY: ("", "ice below", "ice below"), CONE: ("", "", "ice below")}
    assert getattr(tables[file], "cancelled", None) == expected[file]


def test_files_with_decimal_commas_take_either_form(small: SmallCampaign) -> None:
    small[CONE] = "test;site;repeat;drop_cone_depth_mm\nC1;S;1;12,5\nC1;S;2;13,5\nC2;S;1;17,0\n"
    small[FILE] = corrections(
        (CONE, "C1", "2", "drop_cone_depth_mm", "12.50", "12.75"),
        (CONE, "C1", "3", "drop_cone_depth_mm", "13,5", "13,75"),
        (CONE, "C2", "4", "drop_cone_depth_mm", "17", "18"),
    )
    cone = present(small.read().drop_cone)
    assert cone.drop_cone_depth.tolist() == pytest.approx([0.01275, 0.01375, 0.018])


REFUSED: list[tuple[Row, Where, str]] = [
    ((PEN, "P1", "3", "depth_mm", "2.4", "9"), (2, "old", "P1", "2.4"), "'2.5'"),
    ((PEN, "P1", "3", "depth_mm", "", "9"), (2, "old", "P1", ""), "'2.5'"),
    ((PEN, "P1", "3", "site", "süd", "9"), (2, "old", "P1", "süd"), "'Süd'"),
    ((PEN, "P2", "3", "depth_mm", "2.5", "9"), (2, "experiment", "P2", "P2"), "'P1'"),
    ((PEN, "P1", "1", "depth_mm", "2.5", "9"), (2, "row", "P1", "1"), "header"),
    ((PEN, "P1", "99", "depth_mm", "2.5", "9"), (2, "row", "P1", "99"), "the file has no rows"),
    ((PEN, "P1", "3.5", "depth_mm", "2.5", "9"), (2, "row", "P1", "3.5"), "whole"),
    ((PEN, "P1", "3", "Depth", "2.5", "9"), (2, "column", "P1", "Depth"), "depth_mm"),
    ((PEN, "P1", "3", "time", "", "9"), (2, "column", "P1", "time"), "depth_mm"),
    (("penetration", "P1", "3", "depth_mm", "2.5", "9"), (2, "file", "P1", "penetration"), PEN),
    (("campaign.toml", "P1", "3", "depth_mm", "2.5", "9"), (2, "file", "P1", "campaign.toml"), PEN),
    ((CONE, "C1", "2", "drop_cone_depth_mm", "12.5", "9"), (2, "file", "C1", CONE), "campaign"),
]


@pytest.mark.parametrize(("row", "expected", "told"), REFUSED)
def test_what_does_not_meet_is_rejected(small: SmallCampaign, row: Row, expected: Where, told: str) -> None:
    del small[CONE]
    (problem,) = small.check({FILE: corrections(row)})
    assert (problem.code, where(problem)) == ("correction_mismatch", expected)
    assert told in problem.allowed


def test_a_wrong_new_value_is_reported_of_the_table(small: SmallCampaign) -> None:
    small[FILE] = corrections((PEN, "P1", "3", "depth_mm", "2.5", "-2.5"))
    (problem,) = small.check()
    assert (problem.code, problem.file, problem.row, problem.value) == ("out_of_range", PEN, 3, "-2.5")


def test_surplus_cells_are_never_taken_for_a_status(small: SmallCampaign) -> None:
    small.replace(DENSITY, "D1,Süd,410.5", "D1,Süd,410,5")
    small[FILE] = corrections((DENSITY, "D2", "3", "status", "", "spilt"))
    (problem,) = small.check()
    assert (problem.code, problem.file, problem.row, problem.value) == ("unreadable_file", DENSITY, 2, "5")


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("", ("empty_file", None, None)),
        ("file,experiment,row,column,old,new,who,when\n", ("missing_column", 1, "why")),
        (corrections((PEN, "P1", "x", "depth_mm", "2.5", "9")), ("not_a_number", 2, "row")),
        (corrections((PEN, "P1", "0", "depth_mm", "2.5", "9")), ("out_of_range", 2, "row")),
        (corrections((PEN, "", "3", "depth_mm", "2.5", "9")), ("out_of_range", 2, "experiment")),
        (corrections(("", "P1", "3", "depth_mm", "2.5", "9")), ("out_of_range", 2, "file")),
    ],
)
def test_a_broken_file_of_corrections(small: SmallCampaign, content: str, expected: object) -> None:
    problem = small.check({FILE: content})[0]
    assert (problem.file, (problem.code, problem.row, problem.column)) == (FILE, expected)


def test_a_header_alone_is_no_correction(small: SmallCampaign) -> None:
    assert small.check({FILE: corrections()}) == ()


@pytest.mark.parametrize(("standing", "old"), [("2.s", ""), ("2.s", "abc"), ("", "unknown")])
def test_two_texts_that_are_no_numbers_are_not_equal(small: SmallCampaign, standing: str, old: str) -> None:
    small.replace(PEN, "140.5,2.5", f"140.5,{standing}")
    small[FILE] = corrections((PEN, "P1", "3", "depth_mm", old, "9"))
    problems = small.check()
    assert "correction_mismatch" in [problem.code for problem in problems]


SKI = '[[tool]]\nname = "a"\nshape = "ski"\nlength_mm = 200\nwidth_mm = 62\n'
PLATE = '[[plate]]\nname = "b"\nlength_mm = 200\n'


def read(text: str) -> tuple[CampaignFile | None, list[Problem]]:
    found: list[Problem] = []
    return read_campaign_file(text, found), found


@pytest.fixture(scope="module")
def schema() -> Any:
    return json_schema("campaign")


# text, code, column, value; and whether the schema can tell
REJECTED_TOML: list[tuple[str, str, str, str | None, bool]] = [
    ("name = 3", "bad_toml", "name", "3", True),
    ("place = []", "bad_toml", "place", "[]", True),
    ("observers = 1", "bad_toml", "observers", "1", True),
    ('observers = ["a", 1]', "bad_toml", "observers", "['a', 1]", True),
    ('gauge_resolution_mm = "0.01"', "bad_toml", "gauge_resolution_mm", "0.01", True),
    ("gauge_resolution_mm = true", "bad_toml", "gauge_resolution_mm", "True", True),
    ("gauge_resolution_mm = 0", "out_of_range", "gauge_resolution_mm", "0", True),
    ("load_uncertainty_N = -1", "out_of_range", "load_uncertainty_N", "-1", True),
    ("moment_uncertainty_Nm = inf", "out_of_range", "moment_uncertainty_Nm", "inf", False),
    ("lever_arm_uncertainty_mm = nan", "out_of_range", "lever_arm_uncertainty_mm", "nan", False),
    ("load_uncertainty_N = 1e400", "out_of_range", "load_uncertainty_N", "inf", False),
    ("load_steps_N = 70", "bad_toml", "load_steps_N", "70", True),
    ("load_steps_N = [70, 0, 80]", "out_of_range", "load_steps_N[2]", "0", True),
    ('load_steps_N = ["70"]', "bad_toml", "load_steps_N[1]", "70", True),
    ("gauge_resolution = 0.01", "bad_toml", "gauge_resolution", "gauge_resolution", False),
    ("Place = 'x'", "bad_toml", "Place", "Place", False),
    ("[tool]\nname = 'a'", "bad_toml", "tool", "{'name': 'a'}", True),
    ("tool = [1]", "bad_toml", "tool", "[1]", True),
    (SKI + SKI, "bad_toml", "tool[2].name", "a", False),
    (PLATE + PLATE, "bad_toml", "plate[2].name", "b", False),
    (SKI.replace('name = "a"\n', ""), "bad_toml", "tool[1].name", None, True),
    (SKI.replace('"a"', '" "'), "bad_toml", "tool[1].name", " ", True),
    (SKI.replace('shape = "ski"\n', ""), "bad_toml", "tool[1].shape", None, True),
    (SKI.replace('"ski"', '"Ski"'), "bad_toml", "tool[1].shape", "Ski", True),
    (SKI.replace("width_mm = 62\n", ""), "bad_toml", "tool[1].width_mm", None, True),
    (SKI.replace("width_mm = 62", 'width_mm = "62 mm"'), "bad_toml", "tool[1].width_mm", "62 mm", True),
    (SKI.replace("200", "0"), "out_of_range", "tool[1].length_mm", "0", True),
    (SKI + SKI.replace('"a"', '"c"').replace("200", "-1"), "out_of_range", "tool[2].length_mm", "-1", True),
    (SKI.replace("200", "1e-320"), "out_of_range", "tool[1].length_mm", "1e-320", False),
    (SKI + "widht_mm = 3\n", "bad_toml", "tool[1].widht_mm", "widht_mm", False),
    (PLATE.replace("200", "inf"), "out_of_range", "plate[1].length_mm", "inf", False),
    (PLATE.replace("length_mm = 200", ""), "bad_toml", "plate[1].length_mm", None, True),
    ("screening = 1", "bad_toml", "screening", "1", True),
    ("[screening]\nexclude = ['zero_deph']", "bad_toml", "screening.exclude", "zero_deph", True),
    ("[screening]\nexclude = 1", "bad_toml", "screening.exclude", "1", True),
    ("[screening]\nexclud = []", "bad_toml", "screening.exclud", "exclud", False),
]


@pytest.mark.parametrize(("text", "code", "column", "value", "in_schema"), REJECTED_TOML)
def test_rejected_input(text: str, code: str, column: str, value: str | None, in_schema: bool, schema: Any) -> None:
    _, (problem,) = read(text)
    assert (problem.severity, problem.code, problem.file) == ("error", code, "campaign.toml")
    assert (problem.column, problem.value) == (column, value)
    assert jsonschema.Draft202012Validator(schema).is_valid(tomllib.loads(text)) is not in_schema


@pytest.mark.parametrize("shape", ["disc", "cylinder"])
def test_each_shape_needs_its_lengths(shape: str, schema: Any) -> None:
    text = f'[[tool]]\nname = "x"\nshape = "{shape}"\n'
    _, found = read(text)
    assert [problem.column for problem in found] == [f"tool[1].{key}" for key in SHAPES[shape].lengths]
    assert not jsonschema.Draft202012Validator(schema).is_valid(tomllib.loads(text))


@pytest.mark.parametrize(
    ("text", "row"), [("name = \n", 1), ("name = 'a'\n\nplace = x\n", 3), ("a = 1\nb = 2\na = 2\n", 3), ("a = [", None)]
)
def test_broken_toml_names_its_line(text: str, row: int | None) -> None:
    described, (problem,) = read(text)
    assert described is None
    assert (problem.code, problem.file, problem.row) == ("bad_toml", "campaign.toml", row)


@pytest.mark.parametrize("value", ["[" * 100_000, "9" * 5000, "2013-02-31"])
def test_toml_that_python_cannot_hold(value: str) -> None:
    described, (problem,) = read(f"a = {value}")
    assert described is None
    assert problem.code == "bad_toml"


@pytest.mark.parametrize(("digits", "row"), [(20, None), (400, 1)])
def test_whole_number_beyond_those_of_toml(digits: int, row: int | None) -> None:
    _, (problem,) = read("load_uncertainty_N = 1" + "0" * digits)
    assert (problem.code, problem.row) == ("bad_toml", row)


def test_other_unknown_keys_are_warned_of_and_all_keys_are_optional(schema: Any) -> None:
    text = f"altitude = 'sunny'\n{SKI}colour = 'red'\n[screening]\nwho = 'me'\n"
    _, found = read(text)
    assert [(each.severity, each.code, each.column) for each in found] == [
        ("warning", "unknown_column", "altitude"),
        ("warning", "unknown_column", "tool[1].colour"),
        ("warning", "unknown_column", "screening.who"),
    ]
    jsonschema.validate(tomllib.loads(text), schema)
    described, found = read("")
    assert found == []
    assert described is not None
    assert (described.name, described.place, described.observers, described.gauge_resolution) == (None, "", (), None)
    assert described.excluding == {code for code, flag in QUALITY_FLAGS.items() if flag.excludes_by_default}
    jsonschema.validate({}, schema)


def test_exclusions_replace_the_default() -> None:
    described, found = read('[screening]\nexclude = ["beyond_tool", "hardness_outlier"]')
    assert found == []
    assert present(described).excluding == {"beyond_tool", "hardness_outlier", "cancelled", "zero_depth"}
    nothing, _ = read("[screening]\nexclude = []")
    assert present(nothing).excluding == {"cancelled", "zero_depth"}


def test_windows_and_old_macintosh_line_ends() -> None:
    for end in ("\r\n", "\r"):
        described, found = read((SKI + PLATE).replace("\n", end))
        assert found == []
        assert present(described).plates == {"b": 0.2}


def test_the_schema_is_one_and_takes_the_small(small: SmallCampaign, schema: Any) -> None:
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.validate(tomllib.loads(small["campaign.toml"]), schema)
    assert read(small["campaign.toml"])[1] == []


def test_the_schema_names_every_mark_and_shape(schema: Any) -> None:
    assert schema["$defs"]["mark"]["enum"] == list(QUALITY_FLAGS)
    assert schema["$defs"]["tool"]["properties"]["shape"]["enum"] == list(SHAPES)
    forms = {form["properties"]["shape"]["const"]: form["required"] for form in schema["$defs"]["tool"]["oneOf"]}
    assert forms == {name: list(shape.lengths) for name, shape in SHAPES.items()}
