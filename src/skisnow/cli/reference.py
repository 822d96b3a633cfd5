"""``skisnow reference``: write the synthetic reference campaign."""

from __future__ import annotations

import argparse
from pathlib import Path

from .words import seed_number


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser("reference", help="write a synthetic campaign with the design of the 2013 paper")
    parser.add_argument("folder", type=Path, help="folder to write; it must not hold a campaign yet")
    parser.add_argument(
        "--seed", type=seed_number, required=True, help="seed of the random numbers, a whole number from 0 on"
    )
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Write the campaign."""
    from ..field import write_reference

    write_reference(options.folder, seed=options.seed)
    print(f"Synthetic reference campaign, seed {options.seed}: {options.folder}")
    return 0
