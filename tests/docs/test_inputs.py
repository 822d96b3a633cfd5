"""Schemas and tables of keys say what the dataclasses declare."""

import importlib
from pathlib import Path
from typing import Any

DOCS = Path(__file__).resolve().parents[2] / "docs"
write_inputs: Any = importlib.import_module("write_inputs")


def test_schemas_and_tables_are_what_the_code_declares() -> None:
    assert write_inputs.stale() == {}, "run docs/write_inputs.py"


def test_there_are_schemas_and_tables() -> None:
    names = {path.name for path in write_inputs.anew()}
    assert {"scenario.schema.json", "scenario.md", "carve.md"} <= names
