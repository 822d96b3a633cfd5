"""``skisnow reference``: write the synthetic reference campaign."""

from __future__ import annotations

import argparse
from pathlib import Path

from .options import seed_number


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser("reference", help="write a synthetic campaign with the design of the 2013 paper")
    parser.add_argument("folder", type=Path, help="folder to write; it must not hold a campaign yet")
    parser.add_argument(
        "--seed", type=seed_number, default=1, help="seed of the random numbers, 0 or more (default: 1)"
    )
    parser.add_argument(
        "--turning-angles", action="store_true", help="with turning angles of the shear device, which tell u_y"
    )
    parser.add_argument(
        "--creep", action="store_true", help="with depths that were read once more after waiting, at one site"
    )
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Write the campaign."""
    from ..campaign import write_reference

    write_reference(options.folder, seed=options.seed, turning_angles=options.turning_angles, creep=options.creep)
    print(f"Synthetic reference campaign, seed {options.seed}: {options.folder}")
    return 0
