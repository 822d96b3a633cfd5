"""The schema of a scenario takes the section [identify] that the reader takes, and refuses what that refuses."""

from __future__ import annotations

import tomllib
from typing import Any

import jsonschema
import pytest

from skisnow._support.errors import ParameterError
from skisnow.cli.schema import json_schema
from skisnow.scenario import scenario_text
from skisnow.scenario.identify_section import GIVEN, SITE, given_parameters

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
def test_what_the_reader_refuses_the_schema_refuses(line: str) -> None:
    parsed = with_section(f'[identify."friction.mu_0"]\n{line}\n')
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(parsed, SCHEMA)
    with pytest.raises(ParameterError):
        given_parameters(parsed["identify"])


@pytest.mark.parametrize(
    "text",
    ["[identify]\nclock = 'stopped'", "[identify.site]\nlatitude_deg = 47", "[identify.'drag_area']\nprior_mean = 0.4"],
)
def test_words_and_halves_are_refused(text: str) -> None:
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(with_section(text), SCHEMA)
