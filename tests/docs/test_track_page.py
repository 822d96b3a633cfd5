"""The page on tracks names every key of track.json."""

import json
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path
from typing import Any

import skisnow.track

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "how-to" / "track.md").read_text(encoding="utf-8")


def keys_of(schema: Any) -> Iterator[str]:
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
        for part in schema.values():
            yield from keys_of(part)
    elif isinstance(schema, list):
        for part in schema:
            yield from keys_of(part)


def test_every_key_is_told() -> None:
    schema = json.loads((files(skisnow.track) / "schemas" / "track.schema.json").read_text(encoding="utf-8"))
    assert [key for key in keys_of(schema) if f"`{key}`" not in PAGE] == []
