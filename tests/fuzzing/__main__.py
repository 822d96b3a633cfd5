"""``python -m tests.fuzzing``: many cases of each reader, and single ones."""

import argparse
import json
import sys
from pathlib import Path

from .batch import run_batch
from .case import reproduced
from .registry import BY_NAME, READERS


def main() -> int:
    """Print a line for each fault and each reader."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzzing", description=__doc__)
    parser.add_argument("--first", type=int, default=0, help="number of the first case (default: 0)")
    parser.add_argument("--count", type=int, default=500, help="number of cases of each reader (default: 500)")
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
    for reader in READERS:
        if options.reader in reader.name and reader.is_ready:
            for row in run_batch(reader, range(options.first, options.first + options.count)):
                print(json.dumps(row), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
