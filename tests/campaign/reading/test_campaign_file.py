"""campaign.toml: what is refused with the path of its key, and its schema."""

from __future__ import annotations

import tomllib
from typing import Any

import jsonschema
import pytest

from skisnow.campaign.problems import QUALITY_FLAGS, Problem
from skisnow.campaign.reading.campaign_file import SHAPES, CampaignFile, read_campaign_file
from skisnow.cli.schema import json_schema

SKI = '[[tool]]\nname = "a"\nshape = "ski"\nlength_mm = 200\nwidth_mm = 62\n'
PLATE = '[[plate]]\nname = "b"\nlength_mm = 200\n'


def read(text: str) -> tuple[CampaignFile | None, list[Problem]]:
    found: list[Problem] = []
    return read_campaign_file(text, found), found


@pytest.fixture(scope="module")
def schema() -> Any:
    return json_schema("campaign")


# text, code, column, value; and whether the schema can tell
REFUSED: list[tuple[str, str, str, str | None, bool]] = [
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


@pytest.mark.parametrize(("text", "code", "column", "value", "in_schema"), REFUSED)
def test_what_is_refused(text: str, code: str, column: str, value: str | None, in_schema: bool, schema: Any) -> None:
    _, (problem,) = read(text)
    assert (problem.severity, problem.code, problem.file) == ("error", code, "campaign.toml")
    assert (problem.column, problem.value) == (column, value)
    assert jsonschema.Draft202012Validator(schema).is_valid(tomllib.loads(text)) is not in_schema


@pytest.mark.parametrize("shape", ["disc", "cylinder"])
def test_each_shape_needs_its_lengths(shape: str, schema: Any) -> None:
    text = f'[[tool]]\nname = "x"\nshape = "{shape}"\n'
    _, found = read(text)
    assert [problem.column for problem in found] == [f"tool[1].{key}" for key in SHAPES[shape].argument_of_key]
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


def test_number_too_large_for_a_float() -> None:
    _, (problem,) = read("load_uncertainty_N = 1e400")
    assert (problem.code, problem.column) == ("out_of_range", "load_uncertainty_N")


def test_other_unknown_keys_are_warned_of(schema: Any) -> None:
    text = f"altitude = 'sunny'\n{SKI}colour = 'red'\n[screening]\nwho = 'me'\n"
    _, found = read(text)
    assert [(each.severity, each.code, each.column) for each in found] == [
        ("warning", "unknown_column", "altitude"),
        ("warning", "unknown_column", "tool[1].colour"),
        ("warning", "unknown_column", "screening.who"),
    ]
    jsonschema.validate(tomllib.loads(text), schema)


def test_all_keys_are_optional(schema: Any) -> None:
    described, found = read("")
    assert found == []
    assert described is not None
    assert (described.name, described.place, described.observers, described.gauge_resolution) == (None, "", (), None)
    assert described.excluding == {code for code, flag in QUALITY_FLAGS.items() if flag.excludes_by_default}
    jsonschema.validate({}, schema)


def test_exclusions_replace_the_default() -> None:
    described, found = read('[screening]\nexclude = ["beyond_tool", "hardness_outlier"]')
    assert found == []
    assert described is not None
    assert described.excluding == {"beyond_tool", "hardness_outlier", "cancelled", "zero_depth"}
    nothing, _ = read("[screening]\nexclude = []")
    assert nothing is not None
    assert nothing.excluding == {"cancelled", "zero_depth"}


def test_windows_and_old_macintosh_line_ends() -> None:
    for end in ("\r\n", "\r"):
        described, found = read((SKI + PLATE).replace("\n", end))
        assert found == []
        assert described is not None
        assert described.plates == {"b": 0.2}


def test_the_schema_is_one_and_takes_the_small_campaign(small_campaign: dict[str, str], schema: Any) -> None:
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.validate(tomllib.loads(small_campaign["campaign.toml"]), schema)
    assert read(small_campaign["campaign.toml"])[1] == []


def test_the_schema_names_every_mark_and_shape(schema: Any) -> None:
    assert schema["$defs"]["mark"]["enum"] == list(QUALITY_FLAGS)
    assert schema["$defs"]["tool"]["properties"]["shape"]["enum"] == list(SHAPES)
    forms = {form["properties"]["shape"]["const"]: form["required"] for form in schema["$defs"]["tool"]["oneOf"]}
    assert forms == {name: list(shape.argument_of_key) for name, shape in SHAPES.items()}
