"""A problem in a file with a track: where, what, what is allowed, what to do."""

from __future__ import annotations

from dataclasses import dataclass

from ..._support.errors import FieldDataError


@dataclass(frozen=True, slots=True)
class TrackProblem:
    """One problem, printable as one sentence.

    ``place`` names where in the file: ``"row 3"`` of a text file (header: 1), ``"point 12"``, ``"byte 4711"``.
    """

    code: str
    file: str
    place: str | None
    column: str | None
    value: str | None
    allowed: str
    action: str

    def __str__(self) -> str:
        """Say it in one line."""
        where = ", ".join(filter(None, (self.file, self.place, self.column and f"column {self.column}")))
        found = "" if self.value is None else f" found {self.value!r};"
        return f"error {self.code}: {where}:{found} allowed: {self.allowed}. {self.action}"


def refusal(
    code: str,
    file: str,
    *,
    allowed: str,
    action: str,
    place: str | None = None,
    column: str | None = None,
    value: str | None = None,
) -> FieldDataError:
    """The error that refuses a file."""
    shown = value if value is None or len(value) <= 60 else f"{value[:57]}…"
    return FieldDataError([TrackProblem(code, file, place, column, shown, allowed, action)])
