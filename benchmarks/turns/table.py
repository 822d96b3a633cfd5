"""The tables of the simulated turns, as Markdown."""

from __future__ import annotations

import platform
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from skisnow._support.errors import SkisnowError
from skisnow._support.processes.batch import available_cores

from . import peers, processes, speed
from .cases import DEFAULT, FAST, HARD_SNOW, SCENARIO, Runs
from .speed import Speed, told


@dataclass(frozen=True, slots=True)
class Effort:
    """How much is run: simulated seconds of a turn, repeats of each, runs of the batch."""

    duration_s: float = 5.0
    repeats: int = 5
    batch: int = 64


def tables(effort: Effort) -> Iterator[str]:
    """Lines of Markdown, as they are found."""
    yield (
        f"{SCENARIO}, {effort.duration_s:g} s; {datetime.now(UTC):%Y-%m-%d}, Python {platform.python_version()}, "
        f"{available_cores()} cores, {platform.machine()}; shortest of {effort.repeats} runs"
    )
    runs = Runs(effort.duration_s)
    found = speed.speeds(runs, repeats=effort.repeats)
    yield from speed_table(found)
    yield from finer_tables(runs)
    batches = []
    for case in (DEFAULT, FAST):
        told(f"{effort.batch} runs, {case.name}")
        batches.append(processes.many(effort.duration_s, case, count=effort.batch))
    yield from batch_table(batches)
    told("starts")
    yield from start_table(effort)
    told("peers")
    base = next(each for each in found if each.case is DEFAULT)
    yield from peer_table(list(peers.peers(duration_s=effort.duration_s / 5.0, repeats=effort.repeats)), base)


def speed_table(found: Sequence[Speed]) -> Iterator[str]:
    """Speed, steps, and the error beside it."""
    base = next((each for each in found if each.case is DEFAULT), found[0])
    yield from _head(
        "run",
        "times real time",
        "to reach",
        "µs per step",
        "steps",
        "rejected",
        "end off (mm)",
        "time, default = 1",
    )
    for each in found:
        if each.trouble:  # no number that could be taken for a speed
            yield _row(each.case.name, each.trouble, each.case.goal, "", "", "", "", "")
            continue
        counts = (f"{each.steps:,}", f"{each.rejected_steps:,}")
        speed_words = (f"{each.times_real_time:.1f}", each.case.goal, f"{each.us_per_step:.1f}")
        yield _row(
            each.case.name, *speed_words, *counts, f"{1e3 * each.end_off_m:.2f}", f"{each.seconds / base.seconds:.2f}"
        )


def finer_tables(runs: Runs) -> Iterator[str]:
    """What finer choices in space cost, and what they move."""
    yield from _head("made finer by two", "snow", "time over before", "end moves (mm)")
    snows = (("H_V = 0.2 N/mm³", DEFAULT.changes), ("H_V = 90 N/mm³", HARD_SNOW))
    for name, changes in snows:
        try:
            for each in speed.finer(runs, changes):
                key = each.key.removeprefix("solver.")
                yield _row(key, name, f"{each.times_as_long:.2f}", f"{1e3 * each.end_moves_m:.2f}")
        except SkisnowError as error:
            yield _row("", name, f"not run: {error}", "")


def batch_table(batches: Sequence[processes.Batch]) -> Iterator[str]:
    """Many runs on all cores, of several cases."""
    first = batches[0]
    goal = f"to reach ({FAST.name})"
    yield from _head(f"{first.runs} runs, {first.workers} processes", *(each.case.name for each in batches), goal)

    def row(name: str, value: Callable[[processes.Batch], str], goal: str = "") -> str:
        return _row(name, *(value(each) for each in batches), goal)

    yield row("simulated seconds per second, once they run", lambda b: f"{b.per_s_running:.1f}", "150 on 2 cores")
    yield row("simulated seconds per second, start of the processes included", lambda b: f"{b.per_s:.1f}")
    yield row("the same over one run alone", lambda b: f"{b.per_s_running / b.alone_per_s:.2f}")
    yield row("end off, the worse of first and last run (mm)", lambda b: f"{1e3 * b.end_off_m:.2f}")
    yield row("last digit as in one process", lambda b: "the same" if b.same_bits else "**another**", "the same")
    yield row("largest process (MB)", lambda b: f"{b.worker_MB:.0f}")


def start_table(effort: Effort) -> Iterator[str]:
    """Starts and memory."""
    found = processes.in_one_process(effort.duration_s)
    start, bare = (of(repeats=effort.repeats) for of in (processes.start_s, processes.bare_start_s))
    yield from _head("start and memory", "measured", "to reach")
    yield _row("first run of a process until it moves (s)", f"{found['ready_s']:.2f}", "1")
    yield _row("`skisnow simulate` of 0.01 s (s)", f"{start:.2f}", "1")
    yield _row("of that: Python with NumPy (s)", f"{bare:.2f}", "")
    yield _row("memory of one run (MB)", f"{found['one_run_MB']:.0f}", "150")
    yield _row("arrays of one run at their most (MB)", f"{found['arrays_of_a_run_MB']:.1f}", "")
    yield _row("growth of the process with each further run (MB)", f"{found['growth_per_run_MB']:.2f}", "5")


def peer_table(found: Sequence[peers.Peer], base: Speed) -> Iterator[str]:
    """What flexible skis cost without snow, beside our default step, which has snow."""
    yield from _head(
        "no snow", "times real time", "µs per step", "tip off (mm)", "frequencies over ours", "our turn, with snow"
    )
    for each in found:
        if each.absent:
            yield _row(each.what, each.absent, "", "", "", "")
            continue
        ratios = ", ".join(f"{ratio:.3f}" for ratio in each.frequencies)
        ours = f"{base.times_real_time / each.times_real_time:.1f} x as fast"
        numbers = (f"{each.times_real_time:.2f}", f"{each.us_per_step:.1f}", f"{1e3 * each.tip_off_m:.3f}")
        yield _row(each.what, *numbers, ratios, ours)


def print_tables(effort: Effort) -> None:
    """Measure and print."""
    for line in tables(effort):
        print(line, flush=True)


def _head(first: str, *others: str) -> Iterator[str]:
    yield ""
    yield _row(first, *others)
    yield _row("---", *("---:" for _ in others))


def _row(*cells: str) -> str:
    return f"| {' | '.join(cells)} |"
