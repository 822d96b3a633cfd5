"""``skisnow schema``: the JSON Schema of a file that users write, or of JSON that a command prints."""

from __future__ import annotations

import argparse
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from ..parameters.json_schema import Schema

INPUTS: Final = ("campaign", "scenario")
OUTPUTS: Final = {
    "carve": "carving",
    "check": "campaign",
    "compare": "track",
    "identification": "identification",
    "results": "estimation",
    "summary": "simulation",
    "track": "track",
    "turn": "report",
}
"""Package that has the schema of each output; the keys of inputs in it come from their declarations."""
MOST_BYTES: Final = 1 << 20
NAMES: Final = (*INPUTS, *OUTPUTS)


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser(
        "schema",
        help="the JSON Schema of campaign.toml, of a scenario, or of the JSON of a command",
        description="Print a JSON Schema: of a parsed campaign.toml or scenario, or of the JSON that a command writes.",
    )
    parser.add_argument("name", choices=NAMES, metavar="NAME", help=f"one of {', '.join(NAMES)}")
    parser.set_defaults(run=print_schema)


def print_schema(options: argparse.Namespace) -> int:
    """Print the schema with this name."""
    from ..parameters.json_schema import schema_text

    print(schema_text(json_schema(options.name)), end="")
    return 0


def json_schema(name: str) -> Schema:
    """The schema with one of `NAMES`."""
    from .._support.user_files import read_json
    from ..campaign.reading.campaign_schema import campaign_schema
    from ..carving.question import CARVE_KEYS
    from ..parameters.json_schema import output_schema
    from ..scenario.schema import output_scenario_schema, scenario_schema

    if name in INPUTS:
        return campaign_schema() if name == "campaign" else scenario_schema()
    place = files("skisnow") / OUTPUTS[name] / "schemas" / f"{name}.schema.json"
    schema: Schema = read_json(Path(str(place)), most_bytes=MOST_BYTES)
    if name == "summary":
        schema["properties"]["scenario"] = output_scenario_schema()
    elif name == "carve":
        schema["$defs"]["answer"]["properties"]["inputs"] |= output_schema(CARVE_KEYS.values())
    return schema
