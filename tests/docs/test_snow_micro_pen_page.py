"""The tables of the method's page are what the program prints today."""

import importlib
from typing import Any

from benchmarks.page_tables import stale_tables

from skisnow.campaign import read_snow_micro_pen

from ..campaign.recordings import LONG, SHORT, recording


def test_tables_of_the_page() -> None:
    printed: Any = importlib.import_module("tables_of_snow_micro_pen")
    profiles = [read_snow_micro_pen(recording(name)) for name in (LONG, SHORT)]
    tables = {"relations": printed.by_relation(profiles), "settings": printed.by_setting(profiles)}
    assert stale_tables("methods/snow-micro-pen", tables) == []
