"""``skisnow convert`` and ``export``: formats of snow and of motion, and models for other programs."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from .options import Parser, add_changes, scenario_of, whole_number


def add_convert(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow convert`` to the program."""
    parser = commands.add_parser(
        "convert",
        help="files between formats: CAAML, NetCDF, SnowMicroPen, OpenSim",
        description="Read IN, a campaign (folder or .xlsx), a snow pit in CAAML (.caaml, .xml) or a recording of a "
        "SnowMicroPen (.pnt), and write OUT as CAAML 6.0.3 (.caaml, .xml). A campaign also becomes NetCDF (.nc) "
        "with its readings, a recording layers of a run (.csv). .mot and .sto become each other, markers (.trc, .c3d) "
        "become .trc.",
    )
    parser.add_argument("source", type=Path, metavar="IN", help="what is read")
    parser.add_argument("target", type=Path, metavar="OUT", help="what is written")
    parser.add_argument("--site", metavar="S", help="the site of a campaign, where it has several")
    parser.add_argument(
        "--time", metavar="TIME", help="day or time such as 2026-11-23T09:10, if IN has no time: CAAML requires one"
    )
    parser.add_argument(
        "--layers-to-mm",
        type=whole_number(1, 98),
        metavar="MM",
        help="write layers of 1 mm for snow.layers_file down to this depth below the surface, from a .pnt file",
    )
    parser.set_defaults(run=convert_file, parser=parser)


def convert_file(options: argparse.Namespace) -> int:
    """Convert a file into another format, and print the path of the written file."""
    from .._support.units import MM
    from ..interop.convert import ConvertOptions, convert

    depth = options.layers_to_mm
    convert_options = ConvertOptions(
        site=options.site,
        time=options.time,
        layers_to=None if depth is None else depth * MM,
        report=lambda text: print(f"note: {text}", file=sys.stderr),
    )
    convert(options.source, options.target, convert_options)
    print(options.target)
    return 0


def add_export(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow export`` to the program."""
    parser = commands.add_parser(
        "export",
        help="models for other programs: FMUs, MJCF",
        description="Write a model for one.",
    )
    kinds = parser.add_subparsers(dest="kind", required=True, metavar="KIND", parser_class=Parser)
    fmu = kinds.add_parser(
        "fmu",
        help="a functional mock-up unit for co-simulation",
        description="Write the sledge of a scenario, or with --contact only its skis in its snow, as an FMU for "
        "co-simulation. It holds a library for Linux on x86-64, and no Python.",
    )
    fmu.add_argument("scenario", metavar="SCENARIO", help="a built-in one by its name, or a TOML file")
    fmu.add_argument("--out", type=Path, metavar="FILE", required=True, help="the file to write, ending in .fmu")
    fmu.add_argument(
        "--fmi", type=int, choices=(2, 3), default=2, help="version of the standard, 2.0 or 3.0; default: 2"
    )
    fmu.add_argument(
        "--contact", action="store_true", help="the contact of rigid skis: poses in, forces and moments out"
    )
    fmu.add_argument("--skis", type=int, choices=(1, 2), help="with --contact: one ski, or a pair; default: 2")
    add_changes(fmu)
    fmu.set_defaults(run=_write_fmu, parser=fmu)
    mjcf = kinds.add_parser(
        "mjcf",
        help="a ski for MuJoCo",
        description="Write a ski as MJCF: rigid segments on hinges with its compliance in bending and torsion.",
    )
    mjcf.add_argument("ski", metavar="SKI", help="a ski of the catalogue by its name, or a ski file")
    mjcf.add_argument("--out", type=Path, metavar="FILE", required=True, help="the file to write, ending in .xml")
    mjcf.add_argument(
        "--segments", type=whole_number(4, 400), default=20, metavar="N", help="segments of a ski; default: 20"
    )
    mjcf.set_defaults(run=_write_mjcf)


def _write_fmu(options: argparse.Namespace) -> int:
    """Write the FMU of a scenario, or of its contact alone, and print its path; returns 0."""
    if options.skis is not None and not options.contact:
        options.parser.error("--skis goes with --contact: a sledge has two")
    from ..interop import write_contact_fmu, write_sledge_fmu

    scenario = scenario_of(options).scenario
    if options.contact:
        written = write_contact_fmu(scenario, options.out, fmi=options.fmi, skis=options.skis or 2)
    else:
        written = write_sledge_fmu(scenario, options.out, fmi=options.fmi)
    print(written)
    return 0


def _write_mjcf(options: argparse.Namespace) -> int:
    """Write a ski as MJCF and print its path; returns 0."""
    from ..interop.mujoco import write_ski_mjcf
    from ..ski import read_ski

    print(write_ski_mjcf(read_ski(options.ski), options.out, segments=options.segments))
    return 0
