"""``skisnow samples``: write sample files for the commands of the documentation."""

from __future__ import annotations

import argparse
from pathlib import Path

from .options import seed_number


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser("samples", help="write synthetic sample files: campaign, tracks, pits, studies")
    parser.add_argument("folder", type=Path, metavar="DIR", help="new or empty folder")
    parser.add_argument(
        "--seed", type=seed_number, default=1, help="seed of the random numbers, 0 or more (default: 1)"
    )
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Write the sample files and print what each is."""
    from ..samples import write_samples

    write_samples(options.folder, seed=options.seed)
    print((options.folder / "README.txt").read_text(encoding="utf-8"), end="")
    return 0
