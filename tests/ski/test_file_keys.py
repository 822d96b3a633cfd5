from __future__ import annotations

import re
from pathlib import Path

from skisnow.ski.file_keys import COLUMNS, KEYS, LIST_KEYS, NUMBER_KEYS, NumberKey

PAGE = Path(__file__).parents[2] / "docs" / "files" / "ski.md"


def rows(heading: str) -> dict[str, list[str]]:
    """Cells of the first table below a heading of the page, by the name in their first cell."""
    below = PAGE.read_text(encoding="utf-8").split(f"\n## {heading}\n")[1].split("\n## ")[0]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in below.splitlines() if line[:2] == "| "]
    return {found[1]: row[1:] for row in cells if (found := re.match(r"`(\w+)`$", row[0]))}


def number(text: str) -> float:
    return 1e8 if text == "10⁸" else float(text.replace("−", "-"))


def interval(text: str) -> tuple[float, float]:
    low, high = text.split("–")
    return number(low), number(high)


def require_ranges(table: dict[str, list[str]], keys: dict[str, NumberKey]) -> None:
    for name, key in keys.items():
        assert interval(table[name][1]) == (key.lowest, key.highest), name
        assert interval(table[name][2]) == key.usual, name


def test_the_page_lists_every_key_with_its_ranges() -> None:
    table = rows("Keys")
    assert set(table) == set(KEYS)
    require_ranges(table, {**NUMBER_KEYS, **LIST_KEYS})


def test_the_page_lists_every_column_with_its_ranges() -> None:
    table = rows("The table")
    assert set(table) == set(COLUMNS)
    require_ranges(table, COLUMNS)


def test_what_is_usual_is_allowed() -> None:
    for name, key in {**NUMBER_KEYS, **LIST_KEYS, **COLUMNS}.items():
        assert key.lowest <= key.usual[0] < key.usual[1] <= key.highest, name
