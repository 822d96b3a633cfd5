"""The table of identifications, as Markdown."""

from __future__ import annotations

import platform
import sys
import time
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime

import numpy as np

from skisnow._support.processes.batch import available_cores
from skisnow.identification import identify
from skisnow.track.track import Track

from .plain import plainly_identified
from .twin import SCENARIO, SIX, THREE, Case, twin

CASES = (THREE, SIX)


def tables(cases: Sequence[Case] = CASES, *, duration_s: float = 5.0) -> Iterator[str]:
    """Lines of Markdown, as they are found; both programs in one run, compiled code loaded before."""
    yield (
        f"{SCENARIO}, one track of {duration_s:g} s; {datetime.now(UTC):%Y-%m-%d}, Python {platform.python_version()}, "
        f"{available_cores()} cores, {platform.machine()}"
    )
    yield ""
    yield _row(
        "", "s", "to reach (s)", "runs", "outcome", "rms residual", "plain least_squares (s)", "runs", "rms", "ratio"
    )
    yield _row("---", *("---:" for _ in range(9)))
    for case in cases:
        yield _compared(case, duration_s)


def _compared(case: Case, duration_s: float) -> str:
    _told(f"{case.name}: the twin")
    track = twin(case, duration_s=duration_s)
    _told(f"{case.name}: skisnow identify")
    begin = time.perf_counter()
    ours = identify(SCENARIO, track, case.keys)
    seconds = time.perf_counter() - begin
    residual = np.concatenate([(fit.residual[:, :2] / fit.sd[:, :2]).ravel() for fit in ours.fits])
    _told(f"{case.name}: plain least_squares")
    theirs_s, theirs = _plain(case, track)
    return _row(
        case.name,
        f"{seconds:.1f}",
        f"{case.goal_s:g}",
        str(ours.effort.simulations),
        ours.outcome.replace("_", " "),
        f"{np.sqrt(np.mean(residual**2)):.3f}",
        f"{theirs_s:.1f}",
        str(theirs[0]),
        f"{theirs[1]:.3f}",
        f"{theirs_s / seconds:.1f}",
    )


def _plain(case: Case, track: Track) -> tuple[float, tuple[int, float]]:
    begin = time.perf_counter()
    found = plainly_identified(case, track)
    return time.perf_counter() - begin, (found.runs, found.rms)


def print_tables(duration_s: float) -> None:
    """Measure and print."""
    for line in tables(duration_s=duration_s):
        print(line, flush=True)


def _told(doing: str) -> None:
    print(f"  {doing}", file=sys.stderr, flush=True)


def _row(*cells: str) -> str:
    return f"| {' | '.join(cells)} |"
