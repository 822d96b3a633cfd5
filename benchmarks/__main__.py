"""Run every benchmark, print one table: what, seconds, goal, and the ratio to a peer measured in the same run."""

from __future__ import annotations

import argparse
import os
import platform

from . import campaign_size, command_line, equilibrium, model_table
from .timing import Measurement


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks")
    parser.add_argument("--rows", type=int, default=1_000_000, help="readings of the large campaign")
    options = parser.parse_args()
    print(f"Python {platform.python_version()}, {os.cpu_count()} cores, {platform.machine()}\n")
    print(Measurement.header())
    parts = (model_table.measure(), command_line.measure(), equilibrium.measure(), campaign_size.measure(options.rows))
    for measurements in parts:
        for measurement in measurements:
            print(measurement, flush=True)


if __name__ == "__main__":
    main()
