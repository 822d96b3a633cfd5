"""Compute pairs: nice python -m benchmarks.contrast --out contrast; Ctrl-C keeps what is finished, again goes on."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from skisnow.study import Study, run_study

from .pairs import SCENARIOS, Pairs
from .unknowns import BLOCKS, GROUPS, UNKNOWNS, design

BLOCKS_OF_A_PART = 4
"""Of the design in one table: 112 pairs, two minutes of one core."""


def part(number: int, folder: Path) -> Study:
    """Some blocks of the design as a study of its own; each point with both skis."""
    size = BLOCKS_OF_A_PART * (len(GROUPS) + 2)
    points = design()[number * size : (number + 1) * size]
    both = [{"scenario": name, **point} for point in points for name in SCENARIOS]
    out = folder / f"pairs-{number:02d}.csv"
    return Study(Path(__file__), out, Pairs(), tuple(each.name for each in UNKNOWNS), both)


def main() -> None:
    """Compute what is missing, part after part."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of the tables")
    parser.add_argument("--blocks", type=int, default=BLOCKS, help="of the design, %(default)s at most")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    asked = parser.parse_args()
    begin = time.monotonic()
    for number in range(asked.blocks // BLOCKS_OF_A_PART):

        def tell(done: int, count: int, number: int = number) -> None:
            if done % 20 == 0:
                print(f"part {number}: {done} of {count} pairs, {time.monotonic() - begin:.0f} s", file=sys.stderr)

        run_study(part(number, asked.out), workers=asked.workers, progress=tell)


if __name__ == "__main__":
    main()
