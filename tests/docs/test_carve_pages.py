"""The page on carved skis names every input with its default and every key of the JSON."""

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from skisnow.carving.question import CARVE_KEYS
from skisnow.cli import build_parser
from skisnow.cli.shell import json_schema
from skisnow.studies import read_study
from skisnow.studies.subjects import CARVE_RESULTS

from .page_text import page_text

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE = page_text("files/carve")


def keys_of(schema: Any) -> Iterator[str]:
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
        for part in schema.values():
            yield from keys_of(part)


def test_every_key_of_the_json_and_every_column_is_told() -> None:
    keys = {*keys_of(json_schema("carve")), *CARVE_RESULTS}
    assert {key for key in keys if f"`{key}`" not in PAGE and f"`{{{key!r}: " not in PAGE} <= {"skis"}


def test_every_input_is_an_option_of_the_command() -> None:
    (commands,) = (action.choices for action in build_parser()._actions if isinstance(action.choices, dict))
    options = {action.dest: action for action in commands["carve"]._actions}
    assert set(CARVE_KEYS) <= set(options)
    for name, key in CARVE_KEYS.items():
        assert tuple(options[name].choices or ()) == key.choices, name


def test_studies_of_the_how_to_can_be_read(tmp_path: Path) -> None:
    page = (DOCS / "how-to" / "study.md").read_text(encoding="utf-8").partition("## Many computers")[0]
    blocks = [part.split("```")[0] for part in page.split("```toml\n")[1:]]
    assert len(blocks) == 2
    counts = []
    for block in blocks:
        tomllib.loads(block)
        (tmp_path / "study.toml").write_text(block, encoding="utf-8")
        counts.append(len(read_study(tmp_path / "study.toml").points))
    assert counts == [156, 300]
