"""``skisnow convert``: a file of another program as one of another kind."""

from __future__ import annotations

import argparse
from pathlib import Path

from .announced import announced


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser(
        "convert",
        help="a file of motion or markers as another kind",
        description="Convert a file by the endings of both names: .mot and .sto into each other, .c3d and .trc into "
        ".trc. Reading .c3d needs ezc3d.",
    )
    parser.add_argument("given", type=Path, metavar="IN", help="the file to read")
    parser.add_argument("out", type=Path, metavar="OUT", help="the file to write")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Read and write."""
    with announced("converting"):
        from ..interop.opensim import convert_motion

        written = convert_motion(options.given, options.out)
    print(written)
    return 0
