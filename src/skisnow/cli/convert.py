"""``skisnow convert``: other people's formats of snow and of motion, by the endings of the files."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from .options import number
from .progress import announced


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser(
        "convert",
        help="files between formats: CAAML, NetCDF, SnowMicroPen, SMET, SnowEx, OpenSim",
        description="Read IN, a campaign (folder or .xlsx), a snow pit in CAAML (.caaml, .xml) or a recording of a "
        "SnowMicroPen (.pnt), and write OUT in the format that its ending tells: CAAML 6.0.3 (.caaml, .xml) or CSV "
        "with the column names of SnowEx (.csv). A campaign also becomes NetCDF (.nc) with its readings. Weather in "
        "SMET (.smet) becomes SMET 1.1 in SI, or CSV; .mot and .sto each other, markers (.trc, .c3d) each other.",
    )
    parser.add_argument("source", type=Path, metavar="IN", help="what is read")
    parser.add_argument("target", type=Path, metavar="OUT", help="what is written; SnowEx's tables add to the name")
    parser.add_argument("--site", metavar="S", help="the site of a campaign, where it has several")
    parser.add_argument(
        "--snow-height-cm",
        type=number("cm", lowest=0, highest=100_000),
        metavar="CM",
        help="height of the snow on the ground, where IN does not say it: SnowEx counts from there",
    )
    parser.add_argument(
        "--time", metavar="TIME", help="day or time such as 2026-11-23T09:10, if IN has no time: CAAML requires one"
    )
    parser.add_argument(
        "--forces", type=Path, metavar="FILE", help="a .mot or .sto whose columns go into a .c3d beside the markers"
    )
    parser.set_defaults(run=run, parser=parser)


def run(options: argparse.Namespace) -> int:
    """Convert, and print the files that were written."""
    from .._support.units import CM

    with announced(f"reading {options.source}"):
        from ..interop.convert import ConvertOptions, convert

        height = options.snow_height_cm
        convert_options = ConvertOptions(
            site=options.site,
            time=options.time,
            snow_height=None if height is None else height * CM,
            forces=options.forces,
            report=lambda text: print(f"note: {text}", file=sys.stderr),
        )
        written = convert(options.source, options.target, convert_options)
    for path in written:
        print(path)
    return 0
