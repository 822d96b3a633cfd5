"""What is said of a table when it is done: counted while its rows go by."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

FAILED = "error"
"""The outcome of a point that could not be asked."""


@dataclass(slots=True)
class Tally:
    """Counts of rows.

    Attributes
    ----------
    outcomes
        How many rows have each.
    warned
        How many carry warnings.
    first_failed, first_warned
        Place, from 1 on, and text of the first row that could not be asked, and of the first with warnings.
    studies
        The fingerprints that stand in the rows.
    """

    outcomes: Counter[str] = field(default_factory=Counter)
    warned: int = 0
    first_failed: tuple[int, str] | None = None
    first_warned: tuple[int, str] | None = None
    studies: set[Any] = field(default_factory=set)

    @classmethod
    def of(cls, rows: Iterable[Mapping[str, Any]]) -> Tally:
        """Of rows by names."""
        found = cls()
        for row in rows:
            found.take(row["outcome"], row.get("warnings"), row.get("reason"), row.get("study"))
        return found

    @property
    def rows(self) -> int:
        """How many were counted."""
        return self.outcomes.total()

    @property
    def failed(self) -> int:
        """How many could not be asked."""
        return self.outcomes[FAILED]

    def counts(self) -> dict[str, int]:
        """How many rows have each outcome, the most frequent first."""
        return dict(sorted(self.outcomes.items(), key=lambda pair: (-pair[1], pair)))

    def take(self, outcome: Any, warnings: Any, reason: Any, study: Any) -> None:
        """Count a row."""
        self.outcomes[str(outcome)] += 1
        if outcome == FAILED and self.first_failed is None:
            self.first_failed = (self.rows, reason)
        if warnings:
            self.warned += 1
            if self.first_warned is None:
                self.first_warned = (self.rows, warnings)
        self.studies.add(study)

    def counting(self, columns: Sequence[str], rows: Iterable[list[Any]]) -> Iterator[list[Any]]:
        """Rows as lists of the values of the columns, counted as they go by."""
        places = [columns.index(name) if name in columns else None for name in ("warnings", "reason", "study")]
        outcome = columns.index("outcome")
        for row in rows:
            self.take(row[outcome], *(None if place is None else row[place] for place in places))
            yield row
