"""The pages name everything that skisnow compare prints."""

from pathlib import Path
from typing import Any

from skisnow.cli.shell import json_schema
from skisnow.comparison.alignment import OFFSETS

DOCS = Path(__file__).resolve().parents[2] / "docs"


def keys_of(schema: Any) -> set[str]:
    parts = schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ()
    named = set(schema.get("properties", ())) if isinstance(schema, dict) else set()
    return named.union(*(keys_of(part) for part in parts))


def test_every_key_and_every_offset_is_told() -> None:
    commands = (DOCS / "files" / "command-line.md").read_text(encoding="utf-8")
    keys = keys_of(json_schema("compare")) - {"schema_version"}
    assert {key for key in keys if f"`{key}`" not in commands} == set()
    page = (DOCS / "methods" / "tracks.md").read_text(encoding="utf-8")
    assert all(f"*{offset}*" in page for offset in OFFSETS)
