"""python -m benchmarks.constants: vary the constants that were not varied yet.

``--only KEY ...`` varies these. Results are kept row by row in moved.csv, from which the build of the docs writes the
page; a run that was stopped continues. It needs cmake, ninja, nanobind and a compiler.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from .page import REASONS, reasons_by_key
from .results import Moved, read_moved, store_moved
from .varying import FACTORS, TunableBuild, varied_constants


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.constants")
    parser.add_argument("--only", nargs="*", metavar="KEY", help="vary these constants again")
    parser.add_argument("--folder", type=Path, help="of the build; left out: a new one each time")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        vary(TunableBuild(options.folder or Path(folder)), options.only)


def vary(build: TunableBuild, only: list[str] | None) -> None:
    """Vary what is asked for, or what was not varied yet or had another value."""
    varied = varied_constants(reasons_by_key(REASONS))
    known = {(each.key, each.factor): each.value for each in read_moved()}
    build.make(varied)
    base = build.ends()
    for each in varied:
        for factor in FACTORS:
            again = each.key in only if only else known.get((each.key, factor)) != each.value
            if again:
                store_moved(Moved.of(each, factor, base, build.ends(each.key, factor)))


if __name__ == "__main__":
    main()
