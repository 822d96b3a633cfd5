"""JSON schemas from what the dataclasses declare: python docs/write_inputs.py [--check]."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from functools import reduce
from pathlib import Path

import skisnow
from skisnow.campaign.reading import campaign_schema
from skisnow.carving.question import CARVE_KEYS
from skisnow.parameters.json_schema import Schema, output_schema, schema_text
from skisnow.scenario import schema as scenario

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


def anew() -> dict[Path, str]:
    """The text of every schema."""
    return {PACKAGE / name: schema_text(schema()) for name, schema in SCHEMAS.items()}


def stale() -> dict[Path, str]:
    """Those that say something else today."""
    return {path: text for path, text in anew().items() if path.read_text(encoding="utf-8") != text}


def main() -> int:
    """Number of files that said something else."""
    parser = argparse.ArgumentParser(description="JSON schemas from what the dataclasses declare.")
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
