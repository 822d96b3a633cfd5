"""Tables of the pages as CSV files: programs write ``tables/PAGE-NAME.csv`` beside a page, which shows it.

``python -m benchmarks turns | python -m benchmarks.page_tables benchmarks`` writes the printed tables of that page.
"""

from __future__ import annotations

import csv
import io
import re
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Final

DOCS: Final = Path(__file__).resolve().parents[1] / "docs"


def csv_text(table: str) -> str:
    """CSV of a Markdown table.

    >>> csv_text("| a | b |\\n| --- | ---: |\\n| x, y | 1 |").splitlines()
    ['a,b', '"x, y",1']
    """
    rows = [
        [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip())[1:-1]] for line in table.strip().splitlines()
    ]
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([rows[0], *rows[2:]])
    return text.getvalue()


def table_path(page: str, name: str, docs: Path = DOCS) -> Path:
    """File of a page's table; `page` is such as ``validation/measured``."""
    path = docs / page
    return path.parent / "tables" / f"{path.name}-{name.replace(' ', '-')}.csv"


def stale_tables(page: str, tables: Mapping[str, str | Iterable[str]]) -> list[str]:
    """Names of the tables whose files differ."""
    return [name for name, table in tables.items() if table_path(page, name).read_text("utf-8") != _text(table)]


def write_tables(page: str, tables: Mapping[str, str | Iterable[str]], docs: Path = DOCS) -> None:
    """Write Markdown tables, each a text or its lines, as the CSV files of a page."""
    for name, table in tables.items():
        path = table_path(page, name, docs)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(_text(table), encoding="utf-8")


def write_printed(page: str, text: str, docs: Path = DOCS) -> None:
    """Write each Markdown table of a text into the file of the page that has the same headings after the first."""
    folder, name = (docs / page).parent / "tables", Path(page).name
    files = {_headings(path.read_text("utf-8")): path for path in sorted(folder.glob(f"{name}-*.csv"))}
    for table in re.findall(r"(?:^\|.*\n?)+", text, re.MULTILINE):
        files[_headings(csv_text(table))].write_text(csv_text(table), encoding="utf-8")


def _headings(text: str) -> tuple[str, ...]:
    return tuple(next(csv.reader(io.StringIO(text)))[1:])


def _text(table: str | Iterable[str]) -> str:
    return csv_text(table if isinstance(table, str) else "\n".join(table))


if __name__ == "__main__":
    write_printed(sys.argv[1], sys.stdin.read())
