"""``skisnow new``, ``reference`` and ``samples``: templates, the synthetic campaign and sample files to begin with."""

from __future__ import annotations

import argparse
from pathlib import Path

from .new_ski import add_ski
from .options import Parser, seed_number

SEED = "seed of the random numbers, 0 or more (default: 1)"


def add_new(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow new`` to the program."""
    about = "Write templates to be filled in."
    parser = commands.add_parser(
        "new", help="write the templates of a campaign, or a ski file of what was measured", description=about
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
    campaign.set_defaults(run=write_new)
    add_ski(kinds)


def write_new(options: argparse.Namespace) -> int:
    """Write the templates and print their paths."""
    from ..campaign.templates import write_new_campaign

    written = write_new_campaign(options.folder, xlsx=options.xlsx)
    print(f"Fill in: {', '.join(map(str, written))}")
    print(f"Then: skisnow check {options.folder}")
    return 0


def add_reference(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow reference`` to the program."""
    parser = commands.add_parser("reference", help="write a synthetic campaign with the design of the 2013 paper")
    parser.add_argument("folder", type=Path, help="folder to write; it must not hold a campaign yet")
    parser.add_argument("--seed", type=seed_number, default=1, help=SEED)
    parser.add_argument(
        "--turning-angles", action="store_true", help="with turning angles of the shear device, which tell u_y"
    )
    parser.add_argument(
        "--creep", action="store_true", help="with depths that were read once more after waiting, at one site"
    )
    parser.set_defaults(run=write_reference)


def write_reference(options: argparse.Namespace) -> int:
    """Write the campaign."""
    from ..campaign import reference

    reference.write_reference(
        options.folder, seed=options.seed, turning_angles=options.turning_angles, creep=options.creep
    )
    print(f"Synthetic reference campaign, seed {options.seed}: {options.folder}")
    return 0


def add_samples(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow samples`` to the program."""
    parser = commands.add_parser("samples", help="write synthetic sample files: campaign, tracks, pits, studies")
    parser.add_argument("folder", type=Path, metavar="DIR", help="new or empty folder")
    parser.add_argument("--seed", type=seed_number, default=1, help=SEED)
    parser.set_defaults(run=write_samples)


def write_samples(options: argparse.Namespace) -> int:
    """Write the sample files and print a description of each."""
    from .. import samples

    samples.write_samples(options.folder, seed=options.seed)
    print((options.folder / "README.txt").read_text(encoding="utf-8"), end="")
    return 0
