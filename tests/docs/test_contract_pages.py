"""The pages of the contract name everything that the program has: they cannot drift apart unseen."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import pytest

from skisnow.campaign import reading
from skisnow.campaign.problems import ALWAYS_EXCLUDE, QUALITY_FLAGS
from skisnow.campaign.reading.campaign_file import SHAPES
from skisnow.campaign.reading.table_forms import CORRECTIONS, TABLES
from skisnow.carving.question import CARVE_KEYS
from skisnow.cli import build_parser
from skisnow.cli.shell import json_schema
from skisnow.comparison.alignment import OFFSETS
from skisnow.scenario import load_scenario, scenario_file
from skisnow.scenario.keys import parse_change
from skisnow.simulation.run import Outcome
from skisnow.simulation.run_tables import COLUMNS
from skisnow.studies import read_study
from skisnow.studies.subjects import CARVE_RESULTS, RUN_RESULTS
from skisnow.track.read import TrackFormat

from .page_text import DOCS, page_text

ROOT = DOCS.parent
CAMPAIGN, RESULTS, COMMANDS, CARVE, SCENARIO, RUNS, TRACK, SIMULATE, STUDY = (
    page_text(name)
    for name in (
        "files/campaign", "files/results", "files/command-line", "files/carve", "files/scenario", "files/run",
        "files/track", "how-to/simulate", "how-to/study",
    )
)  # fmt: skip
PARSERS = next(action.choices for action in build_parser()._actions if isinstance(action.choices, dict))


def keys_of(schema: Any) -> Iterator[str]:
    """All property names anywhere in a JSON Schema."""
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
    for part in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ():
        yield from keys_of(part)


@pytest.mark.parametrize(
    ("schema", "pages", "names", "not_told"),
    [
        ("campaign", CAMPAIGN, (), set()),
        ("carve", CARVE, CARVE_RESULTS, {"skis"}),
        ("compare", COMMANDS, (), {"schema_version"}),
        ("results", RESULTS + CAMPAIGN, (), set()),
        ("track", TRACK, (), set()),
    ],
)
def test_every_key_is_told(schema: str, pages: str, names: tuple[str, ...], not_told: set[str]) -> None:
    keys = {*keys_of(json_schema(schema)), *names} - not_told
    marks = ("{0}",) if schema in ("campaign", "results") else ("`{0}`", "`{{'{0}': ")
    assert {key for key in keys if not any(mark.format(key) in pages for mark in marks)} == set()


def test_every_key_of_the_summary_and_every_column_is_told() -> None:
    schema = json_schema("summary")
    del schema["properties"]["scenario"]["properties"]  # the table's
    keys = {key.replace("_start_J", "_J") for key in keys_of(schema)}  # the page states how the start is named
    assert {key for key in (*keys, *COLUMNS) if f"`{key}`" not in RUNS} == set()
    assert {column for column in RUN_RESULTS if f"`{column}`" not in SCENARIO} == set()
    assert [outcome for outcome in get_args(Outcome) if f"| `{outcome}` |" not in SCENARIO] == []


CODE = re.compile(r'\b(?:(?:error|warning|rows\.refuse|_refusal)\(|partial\((?:error|warning), )[^"()]*"([a-z0-9_]+)"')
"""Code of a problem in the call that makes it."""


def test_every_code_shape_command_and_offset_is_told() -> None:
    sources = [file.read_text(encoding="utf-8") for file in Path(reading.__path__[0]).glob("*.py")]
    codes = {code for source in sources for code in CODE.findall(source)} | {"unknown_tool", "unknown_plate"}
    assert len(codes) > 20
    assert [code for code in codes if f"`{code}`" not in CAMPAIGN] == []
    assert [shape for shape in SHAPES if f"| `{shape}` |" not in CAMPAIGN] == []
    assert [name for name in PARSERS if f"skisnow {name}" not in COMMANDS] == []
    assert [offset for offset in OFFSETS if f"*{offset}*" not in page_text("methods/tracks")] == []


@pytest.mark.parametrize("flag", list(QUALITY_FLAGS.values()), ids=lambda flag: flag.code)
def test_every_flag_is_told_with_its_default(flag: Any) -> None:
    (row,) = [line for line in CAMPAIGN.splitlines() if line.startswith(f"| `{flag.code}` |")]
    told = row.split("|")[-2].strip()
    assert told == ("yes, always" if flag.code in ALWAYS_EXCLUDE else "yes" if flag.excludes_by_default else "no")


@pytest.mark.parametrize("form", [*TABLES, CORRECTIONS], ids=lambda form: form.file)
def test_every_table_and_column_is_told(form: Any) -> None:
    assert [name for name in (form.file, *form.known) if f"`{name}`" not in CAMPAIGN] == []


def test_every_input_of_a_carve_is_an_option_of_the_command() -> None:
    options = {action.dest: action for action in PARSERS["carve"]._actions}
    assert {name: tuple(options[name].choices or ()) for name in CARVE_KEYS} == {
        name: key.choices for name, key in CARVE_KEYS.items()
    }


@pytest.mark.parametrize(
    "place",
    [
        "docs/files/track.md",
        "src/skisnow/cli/track.py",
        "src/skisnow/cli/identify.py",
        "src/skisnow/web/pages/replay.py",
    ],
)
def test_every_format_of_a_track_is_told(place: str) -> None:
    text = (ROOT / place).read_text(encoding="utf-8")
    named = {kind: [kind.upper()] for kind in get_args(TrackFormat)} | {"rtklib": ["RTKLIB", ".pos"]}
    assert [kind for kind, words in named.items() if not any(word in text for word in words)] == []


def toml_blocks(page: str) -> list[str]:
    return [part.split("```")[0] for part in page.split("```toml\n")[1:]]


def test_file_of_the_page_is_the_built_in_scenario(tmp_path: Path) -> None:
    (block,) = toml_blocks(SCENARIO)
    (tmp_path / "mine.toml").write_text(block, encoding="utf-8")
    assert scenario_file(tmp_path / "mine.toml").values == scenario_file("carved-46m").values


def test_commands_of_the_how_to_change_what_can_be_changed() -> None:
    lines = [line for line in SIMULATE.splitlines() if line.startswith("skisnow simulate") and "--set" in line]
    assert len(lines) == 4
    for line in lines:
        changes = dict(parse_change(part.partition(" --")[0].strip()) for part in line.split("--set")[1:])
        assert load_scenario(line.split()[2], changes=changes).stop is not None


def test_studies_of_the_how_tos_can_be_read(tmp_path: Path) -> None:
    blocks = toml_blocks(STUDY.partition("## Many computers")[0])
    blocks += [block for block in toml_blocks(SIMULATE) if "[grid]" in block]
    counts = []
    for block in blocks:
        (tmp_path / "study.toml").write_text(block, encoding="utf-8")
        counts.append(len(read_study(tmp_path / "study.toml").points))
    assert counts == [156, 300, 25]
