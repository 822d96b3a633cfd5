"""Pages stay short, their pictures exist and say in words what they show."""

from __future__ import annotations

import importlib
import re
from pathlib import Path
from typing import Any

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGES = sorted(path.relative_to(DOCS).as_posix() for path in DOCS.rglob("*.md") if "_build" not in path.parts)
MOST_WORDS = 1500
PICTURE = re.compile(r"!\[([^\]]*)\]\(([^)\s]+)\)")


def text_of(page: str) -> str:
    return (DOCS / page).read_text(encoding="utf-8")


@pytest.mark.parametrize("page", PAGES)
def test_no_more_words_than_one_reads_at_a_time(page: str) -> None:
    """Tables, code, equations and marks are looked up, not read."""
    text = text_of(page)
    for block in (r"```.*?```", r"<!--.*?-->", r"\$\$.*?\$\$"):
        text = re.sub(block, "", text, flags=re.DOTALL)
    assert len(re.sub(r"^\|.*$", "", text, flags=re.MULTILINE).split()) <= MOST_WORDS


@pytest.mark.parametrize("page", [page for page in PAGES if PICTURE.search(text_of(page))])
def test_pictures_exist_and_have_words(page: str) -> None:
    for words, place in PICTURE.findall(text_of(page)):
        if place.startswith("http"):
            continue
        assert (DOCS / page).parent.joinpath(place).exists(), place
        assert words or page == "gallery/index.md", place  # there the title is beside it


def test_chart_of_the_benchmarks_has_every_row_with_a_goal() -> None:
    """A table by hand: 20 ms of 10 ms is twice the goal, 50 times real time of 100 as well."""
    chart: Any = importlib.import_module("figure_of_benchmarks")
    head = "| what | time | goal |\n| --- | --- | --- |\n"
    head += "| slow | 20 ms | 10 ms |\n| quick | 0.5 s | 1 s |\n| free | 3 s | |\n"
    speed = "\n| run | times real time | to reach |\n| --- | --- | --- |\n| default | 50 | 100 on 2 cores |\n"
    named = "\n| 64 runs | default | fast | to reach (fast) |\n| --- | --- | --- | --- |\n"
    named += "| simulated seconds per second | 10 | 40 | 80 |\n"
    found = {row.what: row.share for row in chart.rows(head + speed + named)}
    shares = {"slow": 2.0, "quick": 0.5, "turn: default": 2.0, "simulated seconds per second": 2.0}
    assert found == pytest.approx(shares)
    assert len(list(chart.rows(text_of("benchmarks.md")))) > 40
