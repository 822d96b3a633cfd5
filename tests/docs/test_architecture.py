"""The page on the house names files that are there, and its picture shows the rooms as they stand."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")


def test_the_picture_is_of_this_house() -> None:
    drawn = runpy.run_path(str(ROOT / "docs" / "figure_of_house.py"))
    assert drawn["PICTURE"].read_text(encoding="utf-8") == drawn["picture"]()
    rooms = {room for floor in drawn["floors"]() for room in floor}
    assert set(drawn["INSIDE"]) | set(drawn["READING"]) | set(drawn["TURN"]) <= rooms


def test_every_file_is_there() -> None:
    """A name without a folder is of the folder that was named before it, or of one that its step has named."""
    named = re.findall(r"`([\w/*]+\.(?:py|cpp|hpp))`", PAGE)
    assert len(named) > 50
    source = {path.relative_to(ROOT / "src" / "skisnow").as_posix() for path in (ROOT / "src/skisnow").rglob("*.py")}
    core = {path.name for path in (ROOT / "src" / "core").iterdir()}
    missing = [
        name
        for name in named
        if not (
            any(each == name or each.endswith(f"/{name}") for each in source)
            or any(Path(each).match(name) for each in core)
        )
    ]
    assert missing == []


def test_every_number_of_the_picture_is_told() -> None:
    """As many numbered steps as the picture has, for each of the two ways, and each room is named in its step."""
    drawn = runpy.run_path(str(ROOT / "docs" / "figure_of_house.py"))
    ways = [part.split("\n## ")[0] for part in re.split(r"\n## The way of a \w+\n", PAGE)[1:]]
    for way, rooms in zip(ways, (drawn["READING"], drawn["TURN"]), strict=True):
        steps = re.findall(r"(?m)^\d+\. (.*(?:\n   .*)*)", way)
        assert len(steps) == len(rooms)
        for step, room in zip(steps, rooms, strict=True):
            assert re.search(rf"`{room}\b", step) or room == "compiled", (room, step)
