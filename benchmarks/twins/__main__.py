"""``python -m benchmarks.twins``: compute twins, and write the tables of docs/validation/identification.md.

Twins of photo cells take minutes, those of turns hours: all that are finished are in docs/validation/twins,
and the same command goes on with those that are missing.
"""

import argparse
import math
import sys
from pathlib import Path
from typing import Final

from benchmarks.page_tables import write_tables

from . import glides, shears, tables
from .kept import KeptTwins
from .pool import run_twins
from .truth import SCENARIOS, SEEDS
from .turns import NOISELESS, one_noiseless, one_turn

DOCS: Final = Path(__file__).parents[2] / "docs"
PAGE: Final = "validation/identification"
KINDS: Final = ("glides", "noiseless", "turns", "shears")


def main(words: list[str] | None = None, *, docs: Path = DOCS) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.twins", description=__doc__)
    parser.add_argument("kinds", nargs="*", default=[], help=f"of {', '.join(KINDS)}; none: the tables alone")
    parser.add_argument("--seeds", type=int, default=len(SEEDS), help="from 0 up to this many")
    parser.add_argument("--minutes", type=float, default=math.inf, help="after which a kind ends with its next twin")
    parser.add_argument("--workers", type=int, default=2)
    options = parser.parse_args(words)
    if unknown := set(options.kinds) - set(KINDS):
        parser.error(f"there is no kind {', '.join(sorted(unknown))}; there are {', '.join(KINDS)}")
    folder = docs / "validation" / "twins"
    seeds = SEEDS[: options.seeds]
    asked = {
        "glides": (glides.one_glide, [(case, seed) for case in glides.CASES for seed in seeds]),
        "noiseless": (one_noiseless, [(scenario + NOISELESS, 0) for scenario in SCENARIOS]),
        "shears": (shears.one_shear, [(shears.CASE, seed) for seed in seeds]),
        "turns": (one_turn, [(scenario, seed) for seed in seeds for scenario in SCENARIOS]),
    }
    try:
        for kind in options.kinds:
            twin, cases = asked[kind]
            kept = KeptTwins.opened(folder / f"{kind}.csv")
            run_twins(twin, cases, kept, workers=options.workers, seconds=60.0 * options.minutes)
    except KeyboardInterrupt:
        print(f"interrupted; finished twins are kept in {folder}, the tables are as they were", file=sys.stderr)
        raise SystemExit(130) from None
    rows = {kind: KeptTwins.opened(folder / f"{kind}.csv") for kind in KINDS}
    write_tables(PAGE, tables.page_tables(rows), docs)


if __name__ == "__main__":
    main()
