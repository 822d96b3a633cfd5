"""Helpers that the tests of this folder share."""

from pathlib import Path

import numpy as np

from skisnow.ski import Ski, ski_named
from skisnow.ski.editing import edit_stations
from skisnow.web.lab_skis import LabSkis

from ..desk import Desk, Sheet

CARVER, SLALOM = ski_named("carver"), ski_named("slalom")
TEXT = LabSkis(Path("nowhere")).texts("carver")[0]
COLUMNS = {
    "width_mm": ("width", 1e-3),
    "base_height_mm": ("base_height", 1e-3),
    "EI_N_m2": ("bending_stiffness", 1.0),
    "GJ_N_m2": ("torsional_stiffness", 1.0),
}
CALLED = ("Width (mm)", "Base height (mm)", "EI (N m²)", "GJ (N m²)")
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


def cells_of(ski: Ski) -> list[str]:
    """The editor's table of a ski, line by line."""
    lines = ["Position (m)", *CALLED]
    for station in edit_stations(ski):
        lines.append(f"{station:.3f}".replace("-", "−"))
        for words, (attribute, factor) in zip(CALLED, COLUMNS.values(), strict=True):
            value = float(np.interp(-station, -ski.station, getattr(ski, attribute))) / factor
            text = f"{round(value, 6) + 0.0:.4g}".replace("-", "−")
            lines.append(f"field {words} at {station:.3f} m = {text!r} numeric")
    return lines


def source_words(ski: Ski) -> str:
    return " ".join(ski.source.split())


def files(**texts: str) -> list[tuple[str, tuple[str, bytes]]]:
    return [("files", (name.replace("_", "."), text.encode())) for name, text in texts.items()]
