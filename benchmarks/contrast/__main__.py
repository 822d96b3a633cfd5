"""Compute pairs: nice python -m benchmarks.contrast --out contrast; Ctrl-C keeps what is finished, again goes on."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from skisnow.studies import Study, run_study

from .pairs import SCENARIOS, Pairs
from .unknowns import POINTS, UNKNOWNS, design

POINTS_OF_A_PART = 16
"""In one table: 32 pairs, half a minute of one core."""


def part(number: int, folder: Path) -> Study:
    """Some points of the design as a study of its own, each with both skis."""
    points = design()[number * POINTS_OF_A_PART : (number + 1) * POINTS_OF_A_PART]
    both = [{"scenario": name, **point} for point in points for name in SCENARIOS]
    out = folder / f"pairs-{number:02d}.csv"
    return Study(Path(__file__), out, Pairs(), tuple(each.name for each in UNKNOWNS), both)


def main() -> None:
    """Compute what is missing, part after part."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of the tables")
    parser.add_argument("--points", type=int, default=POINTS, help="of the design, %(default)s at most")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    asked = parser.parse_args()
    begin = time.monotonic()
    for number in range(asked.points // POINTS_OF_A_PART):
        run_study(part(number, asked.out), workers=asked.workers)
        print(f"part {number}, {time.monotonic() - begin:.0f} s", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
