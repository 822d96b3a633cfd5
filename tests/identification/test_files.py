"""Files and scenario keys of an identification."""

import tomllib
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from skisnow._support.errors import ParameterError
from skisnow.cli.shell import json_schema
from skisnow.identification import identify
from skisnow.identification.data import data_description, read_data
from skisnow.identification.data_tables import PhotoCells
from skisnow.scenario import scenario_text
from skisnow.scenario.identify_section import GIVEN, SITE, given_parameters
from skisnow.simulation.run_tables import COLUMNS
from skisnow.track.track import Track
from tests.coded import raises

CELLS = "run,station_m,time_s\nfirst,20,3.34\nfirst,40,5.1\nfirst,60,6.5\n"


def file_in(folder: Path, text: str, name: str = "cells.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("text", "row"),
    [
        (CELLS.replace("3.34", "3,34"), 2),
        (CELLS.replace("5.1", "5,1"), 3),
    ],
)
def test_decimal_commas_between_commas_are_not_cut_off(text: str, row: int, tmp_path: Path) -> None:
    path = file_in(tmp_path, text)
    with raises(ParameterError, "too_many_cells", path=path, row=row):
        read_data(path)


@pytest.mark.parametrize(
    ("text", "column", "meant"),
    [
        (CELLS.replace("time_s\n", "time_s,time_sd\n"), "time_sd", "time_sd_s"),
        (CELLS.replace("time_s\n", "time\n"), "time", "time_s"),
    ],
)
def test_misspelled_columns_are_rejected(text: str, column: str, meant: str, tmp_path: Path) -> None:
    with raises(ParameterError, "misspelled_column") as caught:
        read_data(file_in(tmp_path, text))
    assert f": unknown column {column}." in str(caught.value)
    assert f" {meant}?" in str(caught.value)


def test_another_column_is_nobody_s_concern(tmp_path: Path) -> None:
    found = read_data(file_in(tmp_path, CELLS.replace("time_s\n", "time_s,weather\n")))
    assert isinstance(found, PhotoCells)
    assert found.runs[0].time.tolist() == [3.34, 5.1, 6.5]


def test_what_was_measured_once_counts_once(tmp_path: Path) -> None:
    one, copy = file_in(tmp_path, CELLS), file_in(tmp_path, CELLS, "copy.csv")
    with raises(ParameterError, "same_file"):
        identify("carved-46m", [one, copy], "mu_0")


def test_the_track_of_a_run_is_a_track(tmp_path: Path) -> None:
    """Every column that `skisnow simulate` writes is there."""
    row = dict.fromkeys(COLUMNS, "1") | {"turn_radius_m": ""}
    rows = [",".join((row | {"time_s": f"{k}", "x_m": f"{3 * k}"}).values()) for k in range(3)]
    found = read_data(file_in(tmp_path, "\n".join([",".join(row), *rows]), "track.csv"))
    assert isinstance(found, Track)
    assert found.time.tolist() == [0.0, 1.0, 2.0]
    assert data_description(found) == "a track (points: 3)"


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("time_s,x_m,y_m,depth_mm\n0,0,0,3\n1,5,0,3\n", "a track (points: 2)"),
        ("time,lat,lon,turn_radius_m\n0,47,11,3\n1,47.0001,11,3\n", "a track (points: 2)"),
        ("time_s,x_m,y_m,station_m\n0,0,0,0\n1,5,0,5\n", "a track (points: 2)"),
        ("run,station_m,time_s,x_m,y_m\na,5,1,5,0\na,9,2,9,0\nb,5,1,5,0\n", "photo-cell times (runs: 2)"),
    ],
)
def test_what_a_table_is_taken_for(text: str, kind: str, tmp_path: Path) -> None:
    assert data_description(read_data(file_in(tmp_path, text))) == kind


SCHEMA: dict[str, Any] = json_schema("scenario")
SECTION = """
[identify]
clock = "free"
[identify."friction.mu_0"]
start = 0.04
prior_mean = 0.05
prior_sd = 0.01
[identify.runs."run-2.gpx"]
speed_m_per_s = 8.1
[identify.site]
fall_line_azimuth_deg = 135
"""


def with_section(text: str) -> dict[str, Any]:
    return tomllib.loads(scenario_text("carved-46m") + text)


def test_the_section_of_the_documentation_is_valid() -> None:
    parsed = with_section(SECTION)
    assert list(jsonschema.Draft202012Validator(SCHEMA).iter_errors(parsed)) == []
    assert given_parameters(parsed["identify"]) == {
        "friction.mu_0": {"start": 0.04, "prior_mean": 0.05, "prior_sd": 0.01}
    }


def test_names_are_those_of_the_reader() -> None:
    identify = SCHEMA["properties"]["identify"]
    assert tuple(identify["additionalProperties"]["properties"]) == GIVEN
    assert tuple(identify["properties"]["site"]["properties"]) == SITE


@pytest.mark.parametrize("line", ["begin = 0.04", 'start = "0.04"'])
def test_what_the_reader_rejects_the_schema_rejects(line: str) -> None:
    parsed = with_section(f'[identify."friction.mu_0"]\n{line}\n')
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(parsed, SCHEMA)
    with pytest.raises(ParameterError):
        given_parameters(parsed["identify"])


@pytest.mark.parametrize(
    "text",
    ["[identify]\nclock = 'stopped'", "[identify.site]\nlatitude_deg = 47", "[identify.'drag_area']\nprior_mean = 0.4"],
)
def test_words_and_halves_are_rejected(text: str) -> None:
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(with_section(text), SCHEMA)
