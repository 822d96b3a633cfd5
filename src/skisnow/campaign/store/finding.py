"""Damage in a store, as it is reported."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Finding:
    """Damage found in the store: in which campaign and file (None: in the database as a whole), and what it is."""

    campaign: str | None
    path: str | None
    message: str

    def __str__(self) -> str:
        """Say it in one line."""
        place = ", ".join(part for part in (self.campaign, self.path) if part is not None)
        return f"{place or 'database'}: {self.message}"
