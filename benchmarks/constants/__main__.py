"""python -m benchmarks.constants: vary the constants that were not varied yet.

``--only KEY ...`` varies these. Results are kept row by row in moved.csv, from which the build of the docs writes the
page; a run that was stopped continues. ``--mean KEY ...`` prints how far these constants move the mean end of many
starts: single ends scatter. It needs cmake, ninja, nanobind and a compiler.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np

from .page import REASONS, reasons_by_key
from .results import Moved, read_moved, store_moved
from .varying import FACTORS, STARTS, TunableBuild, varied_constants


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.constants")
    parser.add_argument("--only", nargs="*", metavar="KEY", help="vary these constants again")
    parser.add_argument("--mean", nargs="+", metavar="KEY", help="print by how far these move mean ends")
    parser.add_argument("--folder", type=Path, help="of the build; left out: a new one each time")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        build = TunableBuild(options.folder or Path(folder))
        if options.mean:
            build.make(varied_constants(reasons_by_key(REASONS)))
            print_means(build, options.mean)
        else:
            vary(build, options.only)


def print_means(build: TunableBuild, keys: list[str]) -> None:
    """Shift of the mean end and its standard error, and scatter of single ends along x about their trend (mm)."""
    for case in ("edge of 1°", "skid"):
        base = 1e3 * np.array(build.ends_of_starts(case))
        place = np.arange(STARTS)
        rest = base.real - np.polyval(np.polyfit(place, base.real, 1), place)
        print(f"{case}: {base.real.mean() / 1e3:.4f} m, scatter {np.sqrt(rest @ rest / (STARTS - 2)):.1f} mm")
        for key in keys:
            for factor in FACTORS:
                shifts = 1e3 * np.array(build.ends_of_starts(case, key, factor)) - base
                error = np.std(shifts, ddof=1) / np.sqrt(STARTS)
                print(f"{key} x {factor:g}: {abs(shifts.mean()):.1f} ± {error:.1f} mm", flush=True)


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
