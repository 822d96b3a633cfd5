"""Every declared key is in a table of the docs, and the build writes every schema."""

import importlib
from pathlib import Path
from typing import Any

from skisnow.carving.question import CARVE_KEYS
from skisnow.cli.schema import NAMES
from skisnow.scenario.keys import SCENARIO_KEYS

from .page_text import INCLUDED

DOCS = Path(__file__).resolve().parents[2] / "docs"
tables: Any = importlib.import_module("key_tables")


def test_the_build_writes_every_schema(tmp_path: Path) -> None:
    tables.write_schemas(tmp_path / "schemas")
    assert {path.name for path in (tmp_path / "schemas").iterdir()} == {f"{name}.schema.json" for name in NAMES}


def test_tables_have_a_row_for_each_key(tmp_path: Path) -> None:
    tables.write_tables(tmp_path / "tables")
    written = {path.stem: path.read_text(encoding="utf-8") for path in (tmp_path / "tables").iterdir()}
    assert all(f"`{key}`" in written["scenario"] for key in SCENARIO_KEYS)
    assert all(f"`{key}`" in written["carve"] for key in CARVE_KEYS)
    pages = "".join(path.read_text(encoding="utf-8") for path in DOCS.rglob("*.md"))
    included = INCLUDED.findall(pages)
    assert sorted(included) == sorted(written)
