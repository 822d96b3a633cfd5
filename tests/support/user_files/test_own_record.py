"""Files of the program's own that are damaged: an error that names file and key."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import pytest

from skisnow._support.user_files import GivenError, read_record


@dataclass(frozen=True)
class Record:
    name: str
    changes: Mapping[str, str]
    state: Literal["waiting", "done"] = "waiting"
    took_s: float = 0.0
    points: int = 0
    azimuth: float | None = None


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return tmp_path / "record.json"


def test_a_sound_record(place: Path) -> None:
    place.write_text('{"name": "a", "changes": {"x": "1"}, "state": "done", "took_s": 3, "azimuth": null}')
    assert read_record(place, Record) == Record("a", {"x": "1"}, "done", 3, 0, None)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ('{"name": "a"}', "changes"),
        ('{"name": 5, "changes": {}}', "name"),
        ('{"name": "a", "changes": {"x": 1}}', "changes"),
        ('{"name": "a", "changes": [], "points": 1}', "changes"),
        ('{"name": "a", "changes": {}, "state": "gone"}', "state"),
        ('{"name": "a", "changes": {}, "state": []}', "state"),
        ('{"name": "a", "changes": {}, "points": 1.5}', "points"),
        ('{"name": "a", "changes": {}, "took_s": true}', "took_s"),
        ('{"name": "a", "changes": {}, "azimuth": "south"}', "azimuth"),
        ('{"name": "a", "changes": {}, "more": 1}', "more"),
        ("[1]", "record.json"),
        ("{", "record.json"),
    ],
)
def test_a_damaged_record_names_file_and_key(place: Path, text: str, named: str) -> None:
    place.write_text(text)
    with pytest.raises(GivenError) as caught:
        read_record(place, Record)
    assert place.name in str(caught.value)
    assert named in str(caught.value)


def test_other_keys_can_be_left_out(place: Path) -> None:
    place.write_text('{"name": "a", "changes": {}, "more": 1}')
    assert read_record(place, Record, only_known=False) == Record("a", {})
