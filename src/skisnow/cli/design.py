"""``skisnow design``: the ski that makes the wanted turn, with its ski file and a table before and after."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from .output import print_json
from .progress import Progress, announced

if TYPE_CHECKING:
    from ..design import Design


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser(
        "design",
        help="the ski that makes a wanted turn: variables, conditions and goals in, a ski file out",
        description="Find the ski that comes nearest to the goals of DESIGN.toml, by exact derivatives of the carve "
        "and from several starts. Writes ski.toml, ski-rounded.toml, table.csv and design.json.",
    )
    parser.add_argument("design", type=Path, metavar="DESIGN.toml", help="ski, variables, conditions, goals")
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER", help="folder for the files (default: that of DESIGN.toml)"
    )
    parser.add_argument("--json", action="store_true", help="print JSON alone to standard output")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Search, write, print; 1 where a goal is not reached."""
    with announced("loading"):
        from ..design import design_ski, read_design

        task = read_design(options.design)
    with Progress() as progress:
        design = design_ski(task, progress=lambda done, count: progress(f"{done} of {count} starts"))
    paths = design.write(options.out or options.design.parent)
    if options.json:
        print_json(design.as_dict())
    else:
        print(_summary(design))
        print("\n".join(f"written: {path}" for path in paths))
    return 0 if design.reached else 1


def _summary(design: Design) -> str:
    lines = [f"{'variable':24} {'design':>12}"]
    lines += [f"{name:24} {value:12.6g}" for name, value in design.values.items()]
    lines += ["", f"{'condition':>9}  {'output':26} {'before':>11} {'design':>11} {'change %':>9} {'rounded':>11}"]
    for row in design.rows:
        numbers = (_number(row.before), _number(row.after), _number(row.change_percent, "9.3g"), _number(row.rounded))
        lines.append("{:9}  {:26} {} {} {} {}".format(row.condition, row.output, *numbers))
    lines += ["", "local optima, with the share of starts that reached them:"]
    lines += [f"  {optimum.share:5.0%}  objective {optimum.result:.6g}" for optimum in design.optima]
    lines += ["", *map(str, design.remarks), f"equilibria: {design.equilibria}"]
    return "\n".join(lines)


def _number(value: float | None, form: str = "11.6g") -> str:
    return " " * int(form.partition(".")[0]) if value is None else f"{value:{form}}"
