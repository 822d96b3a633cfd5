"""Schemas say what the dataclasses declare, and every declared key is in a table of the docs."""

import importlib
from pathlib import Path
from typing import Any

from skisnow.carving.question import CARVE_KEYS
from skisnow.scenario.keys import SCENARIO_KEYS

from .page_text import INCLUDED

DOCS = Path(__file__).resolve().parents[2] / "docs"
write_inputs: Any = importlib.import_module("write_inputs")
tables: Any = importlib.import_module("key_tables")


def test_schemas_and_tables_are_what_the_code_declares() -> None:
    assert write_inputs.stale() == {}, "write_inputs.py"


def test_tables_have_a_row_for_each_key(tmp_path: Path) -> None:
    tables.write_tables(tmp_path / "tables")
    written = {path.stem: path.read_text(encoding="utf-8") for path in (tmp_path / "tables").iterdir()}
    assert all(f"`{key}`" in written["scenario"] for key in SCENARIO_KEYS)
    assert all(f"`{key}`" in written["carve"] for key in CARVE_KEYS)
    pages = "".join(path.read_text(encoding="utf-8") for path in DOCS.rglob("*.md"))
    included = INCLUDED.findall(pages)
    assert sorted(included) == sorted(written)
