"""Which files the numbers come from, and what was said when they were read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..table import Column, Table

if TYPE_CHECKING:
    from ..report_data import ReportData


def files_table(data: ReportData) -> Table:
    """Every file that was read."""
    return Table(
        "files",
        "Files read, with the SHA-256 of their bytes.",
        (Column("file", "File", "text"), Column("sha256", "SHA-256", "text")),
        list(data.results["provenance"]["files"].items()),
    )


def corrections_table(data: ReportData) -> Table:
    """Every cell that was read otherwise than the raw file has it."""
    keys = ("file", "row", "experiment", "column", "old", "new", "who", "when", "why")
    rows = [tuple(row[key] for key in keys) for row in data.results["campaign"]["corrections"]]
    return Table(
        "corrections",
        "Corrections applied when the files were read; the raw files keep the old values.",
        tuple(Column(key, key, "count" if key == "row" else "text") for key in keys),
        rows,
    )


def warnings_table(data: ReportData) -> Table:
    """What the reader of the files warned of."""
    keys = ("severity", "code", "file", "row", "column", "experiment", "value", "allowed", "action")
    rows = [tuple(row[key] for key in keys) for row in data.results["campaign"]["warnings"]]
    return Table(
        "warnings",
        "Warnings of reading the campaign's files.",
        tuple(Column(key, key, "count" if key == "row" else "text") for key in keys),
        rows,
        rows_in_html=50,
    )
