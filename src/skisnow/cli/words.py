"""Arguments that need more than a type."""

from __future__ import annotations

import argparse


def seed_number(word: str) -> int:
    """A seed: a whole number from 0 to 2⁶³ - 1, so that it can stand in every file."""
    try:
        seed = int(word)
    except ValueError:
        seed = -1
    if not 0 <= seed < 2**63:
        raise argparse.ArgumentTypeError(f"{word!r} is no seed; a whole number from 0 to 9223372036854775807 is")
    return seed
