"""``skisnow new``: templates to begin with."""

from __future__ import annotations

import argparse
from pathlib import Path

from .options import Parser


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    about = "Write templates to be filled in."
    parser = commands.add_parser(
        "new", help="write the templates of a campaign, as files or one workbook", description=about
    )
    kinds = parser.add_subparsers(dest="kind", required=True, metavar="KIND", parser_class=Parser)
    campaign = kinds.add_parser(
        "campaign",
        help="tables with headers, units and a row as an example",
        description="Write campaign.toml and four tables with headers, units and a row as an example; the examples are "
        "in no estimate. In a folder that has tables already, campaign.toml alone is written.",
    )
    campaign.add_argument(
        "folder", type=Path, metavar="DIR", help="folder to write; it must not hold a campaign.toml yet"
    )
    campaign.add_argument(
        "--xlsx", action="store_true", help="one workbook (.xlsx) with a sheet for each table instead"
    )
    campaign.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Write the templates and say where."""
    from ..campaign.templates import write_new_campaign

    written = write_new_campaign(options.folder, xlsx=options.xlsx)
    print(f"Fill in: {', '.join(map(str, written))}")
    print(f"Then: skisnow check {options.folder}")
    return 0
