"""Helpers that the tests of this folder share."""

from pathlib import Path

from skisnow.ski import Ski, ski_named
from skisnow.web.lab_skis import LabSkis

from ..desk import Desk, Sheet

CARVER, SLALOM = ski_named("carver"), ski_named("slalom")
TEXT = LabSkis(Path("nowhere")).texts("carver")[0]
HEAVY = TEXT.replace("mass_kg = 2.246", "mass_kg = 20")
"""Beyond what is usual: it is warned of."""
FILE, TABLE_FIELD = "File of the edited ski", "Table of the edited ski"
SAVE, BOTH = "Save in the lab", "Carve both side by side"


def saved_place(desk: Desk, name: str) -> Path:
    return desk.lab.runs / "skis" / name / "ski.toml"


def opened(desk: Desk, path: str = "/skis", name: str = "carver") -> Sheet:
    """The page, when the ski is drawn."""
    page = desk.open(path)
    page.shows(f" ({name})")
    return page


def source_words(ski: Ski) -> str:
    return " ".join(ski.source.split())


def files(**texts: str) -> list[tuple[str, tuple[str, bytes]]]:
    return [("files", (name.replace("_", "."), text.encode())) for name, text in texts.items()]
