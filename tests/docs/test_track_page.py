"""The pages on tracks name every key of track.json, and every format."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import pytest

from skisnow.cli.shell import json_schema
from skisnow.track.read import TrackFormat

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "files" / "track.md").read_text(encoding="utf-8")


def keys_of(schema: Any) -> Iterator[str]:
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
        for part in schema.values():
            yield from keys_of(part)
    elif isinstance(schema, list):
        for part in schema:
            yield from keys_of(part)


def test_every_key_is_told() -> None:
    schema = json_schema("track")
    assert [key for key in keys_of(schema) if f"`{key}`" not in PAGE] == []


@pytest.mark.parametrize(
    "place",
    [
        "docs/files/track.md",
        "src/skisnow/cli/track.py",
        "src/skisnow/cli/identify.py",
        "src/skisnow/web/pages/replay.py",
    ],
)
def test_every_format_is_told(place: str) -> None:
    text = (ROOT / place).read_text(encoding="utf-8")
    named = {kind: [kind.upper()] for kind in get_args(TrackFormat)} | {"rtklib": ["RTKLIB", ".pos"]}
    assert [kind for kind, words in named.items() if not any(word in text for word in words)] == []
