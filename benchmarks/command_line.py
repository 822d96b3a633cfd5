"""How long the command line takes to answer."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from .timing import Measurement, in_turn, timed


def measure() -> Iterator[Measurement]:
    def call(*words: str) -> None:
        subprocess.run([sys.executable, *words], check=True, capture_output=True)

    mine, bare = in_turn(lambda: call("-m", "skisnow", "--help"), lambda: call("-c", "pass"), runs=9)
    yield Measurement("skisnow --help", mine, "< 0.3 s", "bare interpreter", bare / mine)
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        call("-m", "skisnow", "reference", str(place / "campaign"), "--seed", "1")
        seconds = timed(lambda: call("-m", "skisnow", "analyse", str(place / "campaign"), "--out", str(place / "out")))
    yield Measurement("skisnow analyse of the reference campaign, with report", seconds, "< 60 s (demo)")
