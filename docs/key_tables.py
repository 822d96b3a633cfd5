"""Tables of keys and columns from their declarations, written when the pages are built: python docs/key_tables.py."""

from __future__ import annotations

from pathlib import Path

from skisnow.campaign.reading.campaign_file import CAMPAIGN_KEYS
from skisnow.campaign.reading.table_forms import PENETRATION, SHEAR
from skisnow.campaign.smet import WeatherSettings
from skisnow.campaign.snow_micro_pen_records import SnowMicroPenSettings
from skisnow.carving.question import CARVE_KEYS
from skisnow.cli.schema import NAMES, json_schema
from skisnow.parameters import own_quantities
from skisnow.parameters.json_schema import page_table, schema_text
from skisnow.scenario.keys import FREE_KEYS, SCENARIO_KEYS
from skisnow.ski.file_keys import COLUMNS, SKI_KEYS

FOLDER = Path(__file__).resolve().parent / "_generated"
_OF_CSV = ("column", "unit", "range", "meaning")
TABLES = {
    "scenario": page_table(SCENARIO_KEYS.values()),
    "carve": page_table(CARVE_KEYS.values()),
    "ski": page_table(SKI_KEYS.values(), ("key", "meaning", "unit", "range", "usual", "left out")),
    "campaign": page_table(CAMPAIGN_KEYS.values(), ("key", "unit", "range", "meaning")),
    "snow_micro_pen": page_table(own_quantities(SnowMicroPenSettings), ("key", "unit", "range", "default", "meaning")),
    "weather": page_table(own_quantities(WeatherSettings), ("key", "unit", "range", "default", "meaning")),
    "penetration": page_table(PENETRATION.numbers, _OF_CSV),
    "shear": page_table(SHEAR.numbers[:4], _OF_CSV),
    "search": page_table(
        (SCENARIO_KEYS[name] for name in FREE_KEYS if SCENARIO_KEYS[name].search), ("key", "usual size", "bounds")
    ),
    "stations": page_table(COLUMNS.values(), ("column", "meaning", "unit", "range", "usual", "instead of")),
}


def write_tables(folder: Path = FOLDER) -> None:
    """Write each table as a Markdown file that a page includes."""
    folder.mkdir(exist_ok=True)
    for name, table in TABLES.items():
        (folder / f"{name}.md").write_text(table, encoding="utf-8")


def write_schemas(folder: Path = FOLDER / "extra" / "schemas") -> None:
    """Write each JSON Schema as a file beside the pages."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in NAMES:
        (folder / f"{name}.schema.json").write_text(schema_text(json_schema(name)), encoding="utf-8")


if __name__ == "__main__":
    write_tables()
    write_schemas()
