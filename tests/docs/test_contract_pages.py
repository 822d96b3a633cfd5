"""The pages of the contract name everything that the program has: they cannot drift apart unseen."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import skisnow
from skisnow.campaign.problems import ALWAYS_EXCLUDE, ERROR_CODES, QUALITY_FLAGS, WARNING_CODES
from skisnow.campaign.reading.campaign_file import SHAPES
from skisnow.campaign.reading.table_forms import CORRECTIONS, TABLES
from skisnow.cli import build_parser
from skisnow.cli.shell import json_schema

from .page_text import page_text

CAMPAIGN, RESULTS, COMMANDS = (page_text(f"files/{name}") for name in ("campaign", "results", "command-line"))
PACKAGE = Path(skisnow.__file__).parent


@pytest.mark.parametrize("code", [*ERROR_CODES, *WARNING_CODES])
def test_every_code_of_a_problem_is_told(code: str) -> None:
    assert f"`{code}`" in CAMPAIGN


@pytest.mark.parametrize("flag", list(QUALITY_FLAGS.values()), ids=lambda flag: flag.code)
def test_every_flag_is_told_with_its_default(flag: Any) -> None:
    (row,) = [line for line in CAMPAIGN.splitlines() if line.startswith(f"| `{flag.code}` |")]
    told = row.split("|")[-2].strip()
    assert told == ("yes, always" if flag.code in ALWAYS_EXCLUDE else "yes" if flag.excludes_by_default else "no")


@pytest.mark.parametrize("form", [*TABLES, CORRECTIONS], ids=lambda form: form.file)
def test_every_table_and_column_is_told(form: Any) -> None:
    assert f"`{form.file}`" in CAMPAIGN
    for name in form.known:
        assert f"`{name}`" in CAMPAIGN + CAMPAIGN, name


def test_every_shape_is_told() -> None:
    assert all(f"| `{shape}` |" in CAMPAIGN for shape in SHAPES)


def keys_of(schema: Any) -> Iterator[str]:
    """All property names anywhere in a JSON Schema."""
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
        for part in schema.values():
            yield from keys_of(part)
    elif isinstance(schema, list):
        for part in schema:
            yield from keys_of(part)


def test_every_key_of_the_results_is_told() -> None:
    schema = json_schema("results")
    missing = {key for key in keys_of(schema) if key not in RESULTS + CAMPAIGN}
    assert not missing


def test_every_key_of_campaign_toml_is_told() -> None:
    schema = json_schema("campaign")
    missing = {key for key in keys_of(schema) if key not in CAMPAIGN + CAMPAIGN}
    assert not missing


def test_every_command_is_told() -> None:
    commands = next(action for action in build_parser()._actions if action.dest == "==SUPPRESS==" or action.choices)
    assert commands.choices is not None
    assert all(f"skisnow {name}" in COMMANDS for name in commands.choices)
