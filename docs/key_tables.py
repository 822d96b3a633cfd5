"""Tables of keys and columns from their declarations, written when the pages are built: python docs/key_tables.py."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator
from pathlib import Path

from quantity_tables import page_table

from skisnow.campaign.reading.campaign_file import CAMPAIGN_KEYS
from skisnow.campaign.reading.table_forms import PENETRATION, SHEAR
from skisnow.campaign.smet import WeatherSettings
from skisnow.campaign.snow_micro_pen import SnowMicroPenSettings
from skisnow.carving.question import CARVE_KEYS
from skisnow.cli import build_parser
from skisnow.cli.shell import NAMES, json_schema
from skisnow.forces import parameter_checks
from skisnow.parameters import own_quantities
from skisnow.parameters.json_schema import schema_text
from skisnow.report.run.file import RUN_VARIABLES, SKIER_VARIABLES, RunVariable
from skisnow.scenario.keys import FREE_KEYS, SCENARIO_KEYS
from skisnow.ski.file_keys import COLUMNS, SKI_KEYS
from skisnow.snow.from_results import published_names, published_snow
from skisnow.snow.measured_range import MeasuredRange

FOLDER = Path(__file__).resolve().parent / "_generated"
_OF_CSV = ("column", "unit", "range", "meaning")


def variable_table(variables: Iterable[RunVariable]) -> str:
    """Markdown table of variables of run.nc."""
    rows = (f"| `{each.name}` | {', '.join(each.dimensions)} | {each.units} | {each.meaning} |" for each in variables)
    return "\n".join(("| variable | dimensions | unit | meaning |", "| --- | --- | --- | --- |", *rows, ""))


def range_table() -> str:
    """Markdown table of the measured ranges of the force laws."""
    ranges = (each for each in vars(parameter_checks).values() if isinstance(each, MeasuredRange))
    ends = ((each, each.lowest / each.unit_factor, each.highest / each.unit_factor) for each in ranges)
    rows = (f"| {each.quantity} | {low:.4g} to {high:.4g} {each.unit} | {each.source} |" for each, low, high in ends)
    return "\n".join(("| quantity | range | measured by |", "| --- | --- | --- |", *rows, ""))


def snow_table() -> str:
    """Markdown table of the published snows, in N/mm³ and N/mm²."""
    snows = {name: published_snow(name) for name in published_names()}
    numbers = {name: (s.snow_hardness / 1e9, (s.failure_shear_stress or 0.0) / 1e6) for name, s in snows.items()}
    rows = (f"| `{name}` | {h:.2g} | {s:.2g} | {snows[name].source} |" for name, (h, s) in numbers.items())
    head = ("| name | H_V (N/mm³) | S_f (N/mm²) | source |", "| --- | --- | --- | --- |")
    return "\n".join((*head, *rows, ""))


def command_sections(parser: argparse.ArgumentParser, words: tuple[str, ...] = ("skisnow",)) -> Iterator[str]:
    """A section for each command: its description, and a table of its arguments and options."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            helps = {choice.dest: choice.help or "" for choice in action._choices_actions}
            for name, command in action.choices.items():
                text = str(command.description or helps.get(name, ""))
                yield f"## {' '.join((*words, name))}\n\n{text[:1].upper()}{text[1:]}\n"
                yield from command_sections(command, (*words, name))
            return
    yield "| argument | meaning |\n| --- | --- |"
    for action in parser._actions:
        if action.help != argparse.SUPPRESS and action.dest != "help":
            yield f"| {argument_name(action)} | {cell(str(action.help or ''))} |"
    yield ""


def argument_name(action: argparse.Action) -> str:
    """An option with the word for its value, or the word for an argument, as code."""
    choices = "|".join(map(str, action.choices or ()))
    value = action.metavar if isinstance(action.metavar, str) else choices or action.dest.upper()
    if not action.option_strings:
        return f"`{cell(value)}`"
    option = max(action.option_strings, key=len)
    return f"`{option}`" if action.nargs == 0 else f"`{option} {cell(value)}`"


def cell(text: str) -> str:
    """Text inside a table cell."""
    return text.replace("|", "\\|").replace("%%", "%").replace("<", "\\<")


TABLES = {
    "scenario": page_table(SCENARIO_KEYS.values()),
    "carve": page_table(CARVE_KEYS.values()),
    "ski": page_table(SKI_KEYS.values(), ("key", "meaning", "unit", "range", "usual", "default")),
    "campaign": page_table(CAMPAIGN_KEYS.values(), ("key", "unit", "range", "meaning")),
    "snow_micro_pen": page_table(own_quantities(SnowMicroPenSettings), ("key", "unit", "range", "default", "meaning")),
    "weather": page_table(own_quantities(WeatherSettings), ("key", "unit", "range", "default", "meaning")),
    "penetration": page_table(PENETRATION.numbers, _OF_CSV),
    "shear": page_table(SHEAR.numbers[:4], _OF_CSV),
    "search": page_table(
        (SCENARIO_KEYS[name] for name in FREE_KEYS if SCENARIO_KEYS[name].search), ("key", "usual size", "bounds")
    ),
    "run_variables": variable_table(RUN_VARIABLES),
    "skier_variables": variable_table(SKIER_VARIABLES),
    "measured_ranges": range_table(),
    "published_snows": snow_table(),
    "command_line": "\n".join(command_sections(build_parser())),
    "stations": page_table(COLUMNS.values(), ("column", "meaning", "unit", "range", "usual", "instead of")),
}


def write_schemas(folder: Path = FOLDER / "extra" / "schemas") -> None:
    """Write each JSON Schema as a file beside the pages."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in NAMES:
        (folder / f"{name}.schema.json").write_text(schema_text(json_schema(name)), encoding="utf-8")


def write_tables(folder: Path = FOLDER) -> None:
    """Write each table as a Markdown file that a page includes."""
    folder.mkdir(exist_ok=True)
    for name, table in TABLES.items():
        (folder / f"{name}.md").write_text(table, encoding="utf-8")


if __name__ == "__main__":
    write_tables()
    write_schemas()
