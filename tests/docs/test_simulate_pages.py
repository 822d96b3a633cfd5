"""The page on scenarios names every key and every entry of the JSON; the files and studies of the pages can be read."""

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import pytest

from skisnow.cli.shell import json_schema
from skisnow.scenario import load_scenario, scenario_file
from skisnow.simulation.run import Outcome
from skisnow.simulation.run_tables import COLUMNS
from skisnow.studies import read_study
from skisnow.studies.subjects import RUN_RESULTS

from .page_text import page_text

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE = page_text("files/scenario")
RUNS = (DOCS / "files" / "run.md").read_text(encoding="utf-8")
HOW_TO = (DOCS / "how-to" / "simulate.md").read_text(encoding="utf-8")


def keys_of(schema: Any) -> Iterator[str]:
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
        for part in schema.values():
            yield from keys_of(part)


def test_every_key_of_the_summary_and_every_column_is_told() -> None:
    schema = json_schema("summary")
    del schema["properties"]["scenario"]["properties"]  # the table's
    keys = {key.replace("_start_J", "_J") for key in keys_of(schema)}  # the page states how the start is named
    assert {key for key in (*keys, *COLUMNS) if f"`{key}`" not in RUNS} == set()
    assert {column for column in RUN_RESULTS if f"`{column}`" not in PAGE} == set()


@pytest.mark.parametrize("outcome", get_args(Outcome))
def test_every_outcome_is_told(outcome: str) -> None:
    assert f"| `{outcome}` |" in PAGE


def test_file_of_the_page_is_the_built_in_scenario(tmp_path: Path) -> None:
    (block,) = [part.split("```")[0] for part in PAGE.split("```toml\n")[1:]]
    (tmp_path / "mine.toml").write_text(block, encoding="utf-8")
    assert scenario_file(tmp_path / "mine.toml").values == scenario_file("carved-46m").values


def test_commands_of_the_how_to_change_what_can_be_changed() -> None:
    from skisnow.scenario.keys import parse_change

    lines = [line for line in HOW_TO.splitlines() if line.startswith("skisnow simulate") and "--set" in line]
    assert len(lines) == 4
    for line in lines:
        changes = dict(parse_change(part.partition(" --")[0].strip()) for part in line.split("--set")[1:])
        load_scenario(line.split()[2], changes=changes)


def test_study_of_the_how_to_can_be_read(tmp_path: Path) -> None:
    (block,) = [part.split("```")[0] for part in HOW_TO.split("```toml\n")[1:] if "[grid]" in part]
    tomllib.loads(block)
    (tmp_path / "runs.toml").write_text(block, encoding="utf-8")
    assert len(read_study(tmp_path / "runs.toml").points) == 25
