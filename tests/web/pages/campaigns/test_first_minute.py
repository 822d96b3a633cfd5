"""The first page shows a replay of at most half a megabyte, and three ways to begin."""

from __future__ import annotations

import json

import pytest

from skisnow.replay.page import MODULES
from skisnow.web.replay_addresses import FILES, FIRST, FIRST_FILE

from ..desk import Desk


@pytest.mark.parametrize("language", ["en", "de"])
def test_cards_lead_to_the_three_ways_to_begin(desk: Desk, language: str) -> None:
    page = desk.open("/", language)
    ways = [each.props["href"] for each in page.tagged("a") if "way" in each.classes]
    assert ways == ["/describe", "/carve", "/simulate"]
    assert all(desk.get(way).status_code == 200 for way in ways)


def test_the_replay_is_small_and_is_a_run_of_several_seconds_with_its_gates(desk: Desk) -> None:
    assert FIRST_FILE.stat().st_size <= 500_000
    answer = desk.get(FIRST)
    assert answer.headers["content-encoding"] == "gzip"
    content = answer.content  # unpacked by the client
    assert content[:4] == b"SKRP"
    header = json.loads(content[8 : 8 + int.from_bytes(content[4:8], "little")])
    assert header["arrays"]["time"]["shape"][0] * 0.04 > 5.0
    assert header["arrays"]["gate_place"]["shape"][0] >= 4
    assert all(desk.get(f"{FILES}/{name}").status_code == 200 for name in MODULES)
