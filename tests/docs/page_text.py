"""Text of a page of the docs with the tables of keys that it includes."""

import importlib
import re
from pathlib import Path
from typing import Any

DOCS = Path(__file__).resolve().parents[2] / "docs"
TABLES: Any = importlib.import_module("key_tables").TABLES
INCLUDED = re.compile(r"```\{include\} \.\./_generated/(\w+)\.md\n```")


def page_text(name: str) -> str:
    """A page such as ``files/carve``."""
    text = (DOCS / f"{name}.md").read_text(encoding="utf-8")
    return INCLUDED.sub(lambda found: str(TABLES[found[1]]), text)
