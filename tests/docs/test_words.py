"""Words that people search for stand on the page of the method that does it."""

from __future__ import annotations

from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
SEARCHED = (
    ("history", "methods/contact.md"),
    ("internal variable", "methods/contact.md"),
    ("internal variable", "methods/simulated-turn.md"),
    ("internal variable", "methods/rate.md"),
    ("internal variable", "decisions.md"),
    ("return mapping", "methods/contact.md"),
    ("return mapping", "methods/dynamics.md"),
    ("return mapping", "methods/shear-displacement.md"),
    ("stick-slip", "methods/contact.md"),
    ("stick-slip", "methods/simulated-turn.md"),
    ("stick-slip", "methods/shear-displacement.md"),
    ("regularised Coulomb friction", "methods/contact.md"),
    ("regularised Coulomb friction", "methods/simulated-turn.md"),
    ("Kelvin–Voigt", "methods/rate.md"),
    ("penalty stiffness", "methods/contact.md"),
    ("Kelvin–Voigt", "methods/dynamics.md"),
    ("Schur complement", "methods/dynamics.md"),
    ("Savitzky-Golay", "methods/tracks.md"),
    ("Rosenbrock method", "decisions.md"),
    ("event sourcing", "decisions.md"),
)


@pytest.mark.parametrize(("words", "page"), SEARCHED)
def test_what_is_searched_for_is_found(words: str, page: str) -> None:
    assert words in " ".join((DOCS / page).read_text(encoding="utf-8").split())
