"""Schemas and tables of keys, from what the dataclasses declare: python docs/write_inputs.py [--check].

In a page a table stands between the lines ``<!-- keys of NAME -->`` and ``<!-- end of keys -->``, which no reader sees.
Without ``--check`` schemas and pages are written anew, and git shows what has changed.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections.abc import Sequence
from functools import reduce
from pathlib import Path

import skisnow
from skisnow.campaign.reading import campaign_schema
from skisnow.campaign.reading.campaign_file import CAMPAIGN_KEYS
from skisnow.campaign.reading.table_forms import PENETRATION, SHEAR
from skisnow.campaign.smet import WeatherSettings
from skisnow.campaign.snow_micro_pen_records import SnowMicroPenSettings
from skisnow.carving.keys import CARVE_KEYS
from skisnow.parameters import own_quantities
from skisnow.parameters.json_schema import Schema, output_schema, page_table, schema_text
from skisnow.scenario import schema as scenario
from skisnow.scenario.keys import FREE_KEYS, SCENARIO_KEYS
from skisnow.ski.file_keys import COLUMNS, SKI_KEYS

DOCS = Path(__file__).resolve().parent
PACKAGE = Path(skisnow.__file__).resolve().parent
SUMMARY, CARVE = "simulation/schemas/summary.schema.json", "carving/schemas/carve.schema.json"


def with_inputs(file: str, place: Sequence[str], told: Schema) -> Schema:
    """A schema of what the program writes, with what it says of its inputs as the code declares them."""
    whole: Schema = json.loads((PACKAGE / file).read_text(encoding="utf-8"))
    reduce(dict.__getitem__, place, whole)["properties"] |= told
    return whole


def summary_schema() -> Schema:
    """Of summary.json."""
    return with_inputs(SUMMARY, (), {"scenario": scenario.output_scenario_schema()})


def carve_schema() -> Schema:
    """Of the JSON of ``skisnow carve``."""
    inputs = {"description": "Every input with the value in force; null where it plays no part."}
    return with_inputs(CARVE, ("$defs", "answer"), {"inputs": {**inputs, **output_schema(CARVE_KEYS.values())}})


SCHEMAS = {
    scenario.FILE: scenario.scenario_schema,
    campaign_schema.FILE: campaign_schema.campaign_schema,
    SUMMARY: summary_schema,
    CARVE: carve_schema,
}
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
TABLE = re.compile(r"(?P<mark><!-- keys of (?P<name>[\w -]+) -->\n)(?P<rows>.*?)(?=<!-- end of keys -->)", re.DOTALL)


def anew() -> dict[Path, str]:
    """The text of every schema and of every page with such a table."""
    found = {PACKAGE / name: schema_text(schema()) for name, schema in SCHEMAS.items()}
    for page in sorted((DOCS / "files").glob("*.md")):
        text = page.read_text(encoding="utf-8")
        if TABLE.search(text):
            found[page] = TABLE.sub(lambda mark: mark["mark"] + TABLES[mark["name"]], text)
    return found


def stale() -> dict[Path, str]:
    """Those that say something else today."""
    return {path: text for path, text in anew().items() if path.read_text(encoding="utf-8") != text}


def main() -> int:
    """Number of files that said something else."""
    parser = argparse.ArgumentParser(description="Schemas and tables of keys, from what the dataclasses declare.")
    parser.add_argument("--check", action="store_true", help="write nothing; the exit status tells how many differ")
    options = parser.parse_args()
    found = stale()
    for path, text in found.items():
        print(path)
        if not options.check:
            path.write_text(text, encoding="utf-8")
    return len(found) if options.check else 0


if __name__ == "__main__":
    sys.exit(main())
