"""The tables of the method's page are what the program prints today."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

from skisnow.campaign import read_snow_micro_pen

from ..campaign.recordings import LONG, SHORT, recording

DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_tables_of_the_page() -> None:
    printed: Any = importlib.import_module("tables_of_snow_micro_pen")
    profiles = [read_snow_micro_pen(recording(name)) for name in (LONG, SHORT)]
    page = (DOCS / "methods" / "snow-micro-pen.md").read_text(encoding="utf-8")
    for table in (printed.by_relation(profiles), printed.by_setting(profiles)):
        assert "\n".join(table) in page
