"""``skisnow simulate``: a sledge on two flexible skis from start to end."""

from __future__ import annotations

import argparse
import sys
import time
import warnings
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._support.errors import ModelLimitWarning
from .ending import Ending, ending_is_an_interrupt
from .options import add_changes, add_language, scenario_of
from .output import prepare_output, print_json, print_warnings
from .progress import Progress, announced

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..scenario import Scenario, ScenarioFile
    from ..simulation.run import Run
    from ..simulation.verification import Refinement

LOADING = "loading"


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser(
        "simulate",
        help="a simulated run of a sledge on two flexible skis",
        description="Simulate a scenario: a built-in one by its name, or a TOML file. Ctrl-C ends a run and keeps it.",
    )
    parser.add_argument("scenario", nargs="?", metavar="NAME|FILE", help="left out with --list")
    add_changes(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write summary.json, track.csv, run.nc and a report")
    replay = "with --out: also write replay.html, the run in three dimensions, which opens without network"
    add_language(parser)
    parser.add_argument("--replay", action="store_true", help=replay)
    boots = "write poses of the boots, and force and moment on each, as .csv, .mot or .sto"
    parser.add_argument("--boots-out", type=Path, metavar="FILE", help=boots)
    finer = (
        "repeat the run, finer and with 0.1 %% more and less of its inputs, one at a time; say how far its end moves"
    )
    parser.add_argument("--verify", action="store_true", help=finer)
    parser.add_argument("--json", action="store_true", help="print summary.json alone to standard output")
    parser.add_argument("--list", action="store_true", help="name the built-in scenarios; with NAME print that one")
    parser.set_defaults(run=run, parser=parser)


def run(options: argparse.Namespace) -> int:
    """Simulate, print, write; 0 with every outcome but an interrupted one, which is kept all the same."""
    if options.list:
        return _list(options.scenario)
    if options.scenario is None:
        options.parser.error("name a scenario: a built-in one (--list names them) or a TOML file")
    if options.replay and options.out is None:
        options.parser.error("--replay writes into the folder of --out: name one")
    with announced(LOADING):
        scenario_input = scenario_of(options)
    _prepare(options, scenario_input)
    with ending_is_an_interrupt() as ending:
        result, refinements = _computed(scenario_input, verify=options.verify)
        with ending.finishing():
            _tell(options, scenario_input, result, refinements)
    return _status(result, ending)


def _status(result: Run, ending: Ending) -> int:
    return ending.status() if ending.requested or ending.pressed or result.outcome == "interrupted" else 0


def _list(name: str | None) -> int:
    from ..scenario import scenario_names, scenario_text

    print("\n".join(scenario_names()) if name is None else scenario_text(name).rstrip())
    return 0


def _prepare(options: argparse.Namespace, scenario_input: ScenarioFile) -> None:
    """Reject wrong options before the work."""
    if options.boots_out is not None:
        from ..simulation.run_tables import require_ending

        require_ending(options.boots_out)
    if options.out is not None:
        prepare_output(options.out)
    print_warnings(scenario_input.warnings)


def _computed(scenario_input: ScenarioFile, *, verify: bool) -> tuple[Run, tuple[Refinement, ...] | None]:
    with ExitStack() as loading, Progress() as progress, warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelLimitWarning)  # printed among those of the scenario
        loading.enter_context(announced(LOADING))
        from ..simulation.simulated_run import simulate

        result = simulate(scenario_input.scenario, progress=_Pace(progress, begun=loading.close))
        loading.close()
        if not verify or result.outcome == "interrupted":
            return result, None
        return result, _verified(result, progress)


def _verified(result: Run, progress: Progress) -> tuple[Refinement, ...]:
    from ..simulation.simulated_run import simulate
    from ..simulation.verification import repetitions, verify

    keys = iter(repetitions(result))

    def finer(scenario: Scenario) -> Run:
        return simulate(scenario, progress=_Pace(progress, f"again, {next(keys)}: "))

    return verify(result, finer)


def _tell(
    options: argparse.Namespace, scenario_input: ScenarioFile, result: Run, refinements: tuple[Refinement, ...] | None
) -> None:
    from ..simulation.run_summary import run_warnings, summary_dict
    from ..simulation.verification import limit_warnings, verification_dict

    verification = None if refinements is None else verification_dict(refinements)
    near = limit_warnings(result, refinements or ())
    warned = (*scenario_input.warnings, *near)
    summary = summary_dict(
        result, scenario_input.values, files=scenario_input.files, warnings=warned, verification=verification
    )
    if options.json:
        print_json(summary)
    else:
        from ..report.summaries import simulate_summary

        print(simulate_summary(summary, title=scenario_input.title), flush=True)
    print_warnings((*near, *run_warnings(result)))
    if options.boots_out is not None:
        from ..simulation.run_tables import write_boots

        write_boots(result, options.boots_out)
        print(f"Boots: {options.boots_out}", file=sys.stderr)
    if options.out is not None:
        _write(options, result, summary, replay_title=scenario_input.title if options.replay else None)


def _write(options: argparse.Namespace, result: Run, summary: dict[str, Any], *, replay_title: str | None) -> None:
    from ..report.run.folder import write_run
    from ..report.run.page import REPLAY

    folder: Path = options.out

    def replay(place: Path) -> None:
        if replay_title is not None:
            from ..replay import write_replay

            write_replay(result, place / REPLAY, title=replay_title, language=options.language)

    with Progress() as progress:
        page = write_run(
            result,
            folder,
            summary=summary,
            write_more=replay,
            language=options.language,
            progress=lambda doing: progress(f"writing {doing}"),
        )
    print(f"Report: {page}", file=sys.stderr)
    if replay_title is not None:
        print(f"Replay: {folder / REPLAY}", file=sys.stderr)


class _Pace:
    """Simulated time, share, and how that compares with real time, from the first call on."""

    def __init__(self, progress: Progress, prefix: str = "", *, begun: Callable[[], object] = lambda: None) -> None:
        self._progress = progress
        self._prefix = prefix
        self._tell_begun = begun
        self._begun: tuple[float, float] | None = None

    def __call__(self, simulated_s: float, share: float) -> None:
        time_s = time.monotonic()
        if self._begun is None:
            self._tell_begun()
            self._begun = (time_s, simulated_s)
        start, before = self._begun
        rate = (simulated_s - before) / max(time_s - start, 1e-9)
        self._progress(
            f"{self._prefix}{simulated_s:.2f} s simulated, {100.0 * share:.0f} %, {rate:.3g} times real time"
        )
