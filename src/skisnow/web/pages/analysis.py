"""Stub."""

from ..settings import Lab


def add_page(lab: Lab) -> None:
    """Add."""
