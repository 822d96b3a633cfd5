"""``skisnow new``, ``reference`` and ``samples``: templates, ski files, the synthetic campaign and sample files."""

from __future__ import annotations

import argparse
from pathlib import Path

from .._support.errors import ParameterError
from .options import Parser, number, seed_number

SEED = "seed of the random numbers, 0 or more (default: 1)"


def add_new(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow new`` to the program."""
    about = "Write templates to be filled in."
    parser = commands.add_parser(
        "new", help="write the templates of a campaign, or a ski file from measurements", description=about
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
    """Write a synthetic campaign and print its seed and folder; returns the exit status."""
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


def add_ski(kinds: argparse._SubParsersAction[Parser]) -> None:
    """Add ``skisnow new ski``, which writes a ski file from measurements, to the program."""
    ski = kinds.add_parser(
        "ski",
        help="a ski file of tables, bend and torsion tests, or of three widths alone",
        description="Write a ski file from measurements: tables of widths and stiffness in any layout, three-point "
        "bend tests, torsion tests, or three widths and a length. What is not measured is taken from another ski and "
        "named.",
    )
    ski.add_argument("ski", type=Path, metavar="SKI.toml", help="ski file to write, with a table beside it")
    ski.add_argument("--table", type=Path, action="append", default=[], metavar="FILE", help="CSV or XLSX (repeatable)")
    ski.add_argument("--stations-from", choices=("tip", "tail", "boot"), help="where the stations of tables count from")
    for name, unit, about in (
        ("boot", "mm", "distance of the boot from the tail (default: middle of the sidecut length)"),
        ("length", "mm", "length from tip to tail (default: reach of the widths)"),
        ("running-length", "mm", "between the contact points of the base"),
        ("sidecut-length", "mm", "between the widest places"),
        ("radius", "m", "sidecut radius, beside --widths-mm"),
        ("mass", "kg", "mass of one ski without binding"),
        ("dial", "mm", "step of the gauge of bend tests (default: 0.01)"),
        ("angle-step", "deg", "step of the angle of torsion tests (default: 0.1)"),
    ):
        ski.add_argument(f"--{name}-{unit}", type=number(unit, lowest=0), metavar=unit.upper(), help=about)
    ski.add_argument(
        "--widths-mm", type=number("mm", lowest=0), nargs=3, metavar=("TIP", "WAIST", "TAIL"), help="three widths"
    )
    ski.add_argument(
        "--like", default="carver", metavar="SKI", help="ski that the rest is taken from (default: carver)"
    )
    for name in ("column", "unit"):
        ski.add_argument(
            f"--{name}", action="append", default=[], metavar="HEADING=NAME", help=f"{name} of a heading (repeatable)"
        )
    ski.set_defaults(run=run_ski)


def run_ski(options: argparse.Namespace) -> int:
    """Write the ski file and print its sources and assumptions."""
    from .._support.units import DEGREE, MM
    from ..design.measured_ski import Measured, measured_ski
    from ..design.ski_tables import Mapped
    from ..ski import write_ski

    def in_si(value: float | None, unit: float = MM) -> float | None:
        return None if value is None else value * unit

    options_by_name = {
        "boot": in_si(options.boot_mm),
        "length": in_si(options.length_mm),
        "running_length": in_si(options.running_length_mm),
        "sidecut_length": in_si(options.sidecut_length_mm),
        "dial_step": in_si(options.dial_mm),
        "angle_step": in_si(options.angle_step_deg, DEGREE),
        "radius": options.radius_m,
        "mass": options.mass_kg,
        "widths": options.widths_mm and tuple(width * MM for width in options.widths_mm),
    }
    made = measured_ski(
        Measured(
            name=options.ski.stem,
            tables=tuple(options.table),
            mapped=Mapped(_pairs("--column", options.column), _pairs("--unit", options.unit)),
            stations_from=options.stations_from,
            like=options.like,
            **{name: value for name, value in options_by_name.items() if value is not None},
        )
    )
    write_ski(made.ski, options.ski)
    for name, stiffness in (("EI", made.bending), ("GJ", made.torsion)):
        if stiffness is not None:
            print(f"{'station mm':>10}  {name + ' N m²':>10}  {'error':>8}")
            for station, value, error in zip(stiffness.station, stiffness.value, stiffness.error, strict=True):
                print(f"{station / MM:10.0f}  {value:10.4g}  {f'{error:8.2g}' if error >= 0.0 else ''}".rstrip())
    for assumption in made.assumed:
        print(f"Assumed: {assumption}")
    snow = "--published race-piste --unloading-ratio 10"
    print(f"Then: skisnow carve --ski {options.ski} --edge-angle-deg 45 --load-N 800 {snow}")
    return 0


def _pairs(option: str, texts: list[str]) -> dict[str, str]:
    """Column names or units by heading, from the texts HEADING=NAME of a repeatable option."""
    for text in texts:
        if "=" not in text:
            raise ParameterError("{option} {text}: an equals sign is missing. Write HEADING=NAME.").tag(
                "not_a_pair", option=option, text=text
            )
    return dict(text.rsplit("=", 1) for text in texts)
