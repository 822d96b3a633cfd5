"""What is wrong, in words."""

from __future__ import annotations


class OpenbenchError(Exception):
    """Something that the user can put right; its text says what."""
