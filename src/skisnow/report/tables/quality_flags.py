"""Quality flags of the screening: what each says, how often it was set, on which experiments."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...field import QUALITY_FLAGS
from ..table import Column, Table

if TYPE_CHECKING:
    from ..report_data import Json, ReportData


def quality_flags_table(data: ReportData) -> Table:
    """A row for each flag, those never set too."""
    pressed, sheared = _by_code(data.penetration), _by_code(data.shear)
    excluding = data.results["campaign"]["excluding"]
    rows = [
        (
            code,
            flag.sentence,
            code in excluding,
            len(pressed.get(code, ())),
            pressed.get(code, []),
            len(sheared.get(code, ())),
            sheared.get(code, []),
        )
        for code, flag in QUALITY_FLAGS.items()
    ]
    return Table(
        "marks",
        "Quality flags of the screening. A flag deletes nothing; one that excludes keeps its experiments out of the "
        "estimates.",
        (
            Column("code", "Code", "text"),
            Column("sentence", "What it says", "words"),
            Column("excludes", "excludes", "yes"),
            Column("penetration_n", "penetration", "count"),
            Column("penetration_experiments", "penetration experiments", "codes"),
            Column("shear_n", "shear", "count"),
            Column("shear_experiments", "shear experiments", "codes"),
        ),
        rows,
    )


def _by_code(rows: list[Json]) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for row in rows:
        for code in row["flags"]:
            found.setdefault(code, []).append(row["experiment"])
    return found
