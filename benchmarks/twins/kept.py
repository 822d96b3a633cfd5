"""Finished twins in a CSV file, a row for each, written again in one piece as each is finished."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

from skisnow._support.staging import write_file
from skisnow.identification import Identified

Key: TypeAlias = tuple[str, int]
Row: TypeAlias = Mapping[str, str]


@dataclass(slots=True)
class KeptTwins:
    """Rows by question and seed."""

    path: Path
    rows: dict[Key, dict[str, str]] = field(default_factory=dict)

    @classmethod
    def opened(cls, path: Path) -> KeptTwins:
        """What is there already; nothing without a file."""
        kept = cls(path)
        if path.is_file():
            with path.open(encoding="utf-8", newline="") as file:
                for row in csv.DictReader(file):
                    kept.rows[row["case"], int(row["seed"])] = row
        return kept

    def add(self, case: str, seed: int, row: Row) -> None:
        """Keep one, in the order of cases and seeds: the file does not depend on who was finished first."""
        self.rows[case, seed] = {"case": case, "seed": str(seed), **row}
        names = list(dict.fromkeys(name for each in self.rows.values() for name in each))
        text = io.StringIO()
        writer = csv.DictWriter(text, names, lineterminator="\n", restval="")
        writer.writeheader()
        writer.writerows(self.rows[key] for key in sorted(self.rows))
        write_file(self.path, text.getvalue())

    def of(self, case: str) -> list[dict[str, str]]:
        """The rows of one case, by seed."""
        return [self.rows[key] for key in sorted(self.rows) if key[0] == case]


def number(value: float | None) -> str:
    """Nine digits; empty for what does not exist."""
    return "" if value is None else f"{value:.9g}"


def interval_row(each: Identified, truth: float) -> dict[str, str]:
    """Truth, best value, ends of the 95 % interval, in the key's unit."""
    low, high = each.interval or (None, None)
    key = each.parameter.key
    values = {"true": truth, "found": each.value, "low": low, "high": high}
    return {f"{key} {name}": number(value) for name, value in values.items()}
