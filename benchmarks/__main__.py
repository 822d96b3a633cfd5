"""Run every benchmark, print one table: what, seconds, goal, and the ratio to a peer measured in the same run.

``python -m benchmarks turns`` runs those of simulated turns alone and prints them as Markdown, ``identify`` those of
identifications, ``web`` those of the web lab in a browser, ``contact`` those of the contact in the compiled core.
``identified`` compares identifications of many simulated tracks with those of a former commit.
``scenarios`` runs random scenarios and counts how they end, ``frontier`` sets error against cost of a turn, ``former``
builds a former commit and compares the processor time of turns with it, ``ends`` the ends of the built-in scenarios.
``counted`` counts what a step executes, with Valgrind.
``cases`` reads the inputs of ../shared/cases and prints their results next to the right answers.
"""

from __future__ import annotations

import argparse
import os
import platform
import subprocess
import sys
from pathlib import Path

TURNS, IDENTIFY, WEB, CONTACT = "turns", "identify", "web", "contact"
SCENARIOS, FRONTIER, FORMER, ENDS, CASES = "scenarios", "frontier", "former", "ends", "cases"
COUNTED = "counted"
IDENTIFIED = "identified"
PARTS = (TURNS, IDENTIFY, WEB, CONTACT)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks")
    parser.add_argument(
        "part",
        nargs="?",
        choices=[*PARTS, SCENARIOS, FRONTIER, FORMER, ENDS, CASES, IDENTIFIED, COUNTED],
        help="these alone; left out: everything",
    )
    parser.add_argument("--rows", type=int, default=1_000_000, help="readings of the large campaign")
    parser.add_argument("--duration", type=float, default=5.0, help="simulated seconds of a turn")
    parser.add_argument("--repeats", type=int, default=5, help="of each turn; the shortest time counts")
    parser.add_argument("--runs", type=int, default=64, help="turns at a time on all cores")
    parser.add_argument("--readings", type=int, default=10_000, help="in the store of the web lab")
    parser.add_argument("--tries", type=int, default=5, help="to open each page of the web lab")
    parser.add_argument("--seed", type=int, default=0, help="of the first random scenario")
    parser.add_argument("--count", type=int, default=200, help="random scenarios, or tracks of identified")
    parser.add_argument(
        "--clock", type=float, default=3.7, help="of the processor (GHz), for the counted minimum of former"
    )
    parser.add_argument("--any-values", action="store_true", help="scenarios with any values that the keys allow")
    parser.add_argument(
        "--out", type=Path, help="of scenarios, frontier or identified: what it holds is not computed again"
    )
    options = parser.parse_args()
    if options.part == TURNS:
        _turns(options)
    elif options.part == IDENTIFY:
        _identify(options)
    elif options.part == IDENTIFIED:
        from .identify import simulated

        simulated.print_table(options.out or Path("identified"), options.count)
    elif options.part == WEB:
        _web(options)
    elif options.part == CONTACT:
        from .contact.speed import print_table

        print_table(options.repeats)
    elif options.part == CASES:
        from .cases import print_table as print_cases

        print_cases()
    elif options.part == SCENARIOS:
        from .turns import scenarios

        scenarios.print_table(options.seed, options.count, options.out, any_values=options.any_values)
    elif options.part == FRONTIER:
        from .turns import frontier

        frontier.print_table(options.out or Path("frontier.csv"), repeats=options.repeats)
    elif options.part in {FORMER, ENDS, COUNTED}:
        _core(options)
    else:
        _everything_else(options.rows)
        print(flush=True)
        for part in PARTS:
            subprocess.run([sys.executable, "-m", "benchmarks", part, *_said(options)], check=True)


def _core(options: argparse.Namespace) -> None:
    from .turns import counted, former

    folder = options.out or Path(options.part)
    if options.part == FORMER:
        former.print_table(folder, options.repeats, options.clock)
    elif options.part == ENDS:
        former.print_ends(folder)
    else:
        counted.print_table(folder, options.duration)


def _turns(options: argparse.Namespace) -> None:
    from .turns.table import Effort, print_tables

    print_tables(Effort(options.duration, options.repeats, options.runs))


def _identify(options: argparse.Namespace) -> None:
    from .identify.table import print_tables

    print_tables(options.duration)


def _web(options: argparse.Namespace) -> None:
    from .web.table import print_tables

    print_tables(options.readings, options.tries)


def _said(options: argparse.Namespace) -> list[str]:
    names = ("duration", "repeats", "runs", "readings", "tries")
    return [word for name in names for word in (f"--{name}", str(getattr(options, name)))]


def _everything_else(rows: int) -> None:
    from . import campaign_size, command_line, equilibrium, model_table
    from .timing import Measurement

    print(f"Python {platform.python_version()}, {os.cpu_count()} cores, {platform.machine()}\n")
    print(Measurement.header())
    parts = (model_table.measure(), command_line.measure(), equilibrium.measure(), campaign_size.measure(rows))
    for measurements in parts:
        for measurement in measurements:
            print(measurement, flush=True)


if __name__ == "__main__":
    main()
