"""``python -m tests.fuzzing``: many cases of each reader, in rows that a later call continues, and single cases."""

import argparse
from pathlib import Path

from .batch import run_batches
from .case import reproduced
from .registry import BY_NAME, READERS


def main() -> int:
    """Run the cases that no row lists yet; 3 if the time was too short for all of them."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzzing", description=__doc__)
    parser.add_argument("--first", type=int, default=0, help="number of the first case (default: 0)")
    parser.add_argument("--count", type=int, default=500, help="number of cases of each reader (default: 500)")
    parser.add_argument("--out", type=Path, default=Path("fuzzing.jsonl"), help="rows of batches and faults, continued")
    parser.add_argument("--minutes", type=float, default=10.0, help="time after which no batch begins (default: 10)")
    parser.add_argument("--reader", default="", help="part of the readers' names; with --case a whole name")
    parser.add_argument("--case", type=int, help="print the traceback of one case")
    parser.add_argument("--save", type=Path, help="write the case's files into this folder instead")
    options = parser.parse_args()
    if options.case is not None:
        reader = BY_NAME[options.reader]
        if options.save:
            reader.lay(options.save, reader.mutated(options.case))
        else:
            print(reproduced(reader, options.case))
        return 0
    readers = [each for each in READERS if options.reader in each.name and each.is_ready]
    numbers = range(options.first, options.first + options.count)
    return 0 if run_batches(readers, numbers, options.out, minutes=options.minutes) else 3


if __name__ == "__main__":
    raise SystemExit(main())
