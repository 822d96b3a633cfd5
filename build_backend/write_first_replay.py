"""Write the replay of the lab's first page: python build_backend/write_first_replay.py.

A skier through the first gates of the built-in scenario slalom-20-gates. The file is at most half a megabyte.
"""

from __future__ import annotations

import gzip
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from skisnow import load_scenario, simulate
from skisnow.replay.from_run import replay_of_run
from skisnow.replay.page import replay_bytes

SCENARIO: Final = "slalom-20-gates"
GATES: Final = 4
OUTPUT_MS: Final = 40.0
MOST_BYTES: Final = 500_000
PLACE: Final = Path(__file__).parents[1] / "src" / "skisnow" / "web" / "first_replay.bin.gz"


def first_replay() -> bytes:
    """Compressed replay without words, so that it fits pages of any language."""
    course = files("skisnow.track.course").joinpath("catalogue", f"{SCENARIO}.csv").read_text(encoding="utf-8")
    with TemporaryDirectory() as folder:
        first_gates = Path(folder) / "gates.csv"
        first_gates.write_text("\n".join(course.splitlines()[: GATES + 1]) + "\n", encoding="utf-8")
        changes = {"course.file": str(first_gates), "run.output_ms": OUTPUT_MS, "solver.method": "fast"}
        run = simulate(load_scenario(SCENARIO, changes=changes))
    if run.outcome != "finished":
        raise RuntimeError(run.outcome)
    return gzip.compress(replay_bytes(replace(replay_of_run(run, title=SCENARIO), facts=())), 9, mtime=0)


if __name__ == "__main__":
    content = first_replay()
    if len(content) > MOST_BYTES:
        raise SystemExit(f"{len(content)} bytes; at most {MOST_BYTES}")
    PLACE.write_bytes(content)
    print(f"{PLACE}: {len(content)} bytes")
