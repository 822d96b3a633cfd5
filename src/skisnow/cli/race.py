"""``skisnow race``: the quickest line through a course, and the time that a change of ski or snow costs on it."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .options import (
    add_changes,
    add_workers,
    number,
    scenario_of,
    seed_number,
    whole_number,
)
from .output import (
    Progress,
    ending_is_an_interrupt,
    prepare_output,
    print_json,
    print_warnings,
    report_interrupt,
)

if TYPE_CHECKING:
    from ..racing import QuickestLine, Score, Worth
    from ..scenario import Scenario
    from ..simulation.run import Run

KEPT, KEPT_WORTH = "evaluations.partial", "worth.partial"
MOST_EVALUATIONS, MOST_GATES, MOST_SNOWS = 1_000_000, 1_000, 10_000


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow race`` to the program."""
    parser = commands.add_parser(
        "race",
        help="the quickest line through a course, and what ski and snow are worth on it in time",
        description="Search the quickest line (needs cmaes). Ctrl-C keeps what is finished; the same command goes on.",
    )
    parser.add_argument(
        "scenario", metavar="NAME|FILE", help="a built-in scenario or a TOML file, with course and skier"
    )
    add_changes(parser)
    parser.add_argument(
        "--gates", type=whole_number(2, MOST_GATES), metavar="N", help="the first of the course; default: all"
    )
    model = "a simulated run for each evaluation (default), or a point with mass on the line, in milliseconds"
    parser.add_argument("--model", choices=("skier", "point"), default="skier", help=model)
    _add_search(parser)
    _add_comparison_options(parser)
    add_workers(parser)
    parser.add_argument("--json", action="store_true", help="print race.json alone to standard output")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="write race.json, line.csv and figures")
    parser.set_defaults(run=run)


def _add_search(parser: argparse.ArgumentParser) -> None:
    """Add the options for the search, its windows and its start."""
    parser.add_argument(
        "--evaluations", type=whole_number(1, MOST_EVALUATIONS), default=300, metavar="N",
        help="after which no new batch begins, of each window; 1: only the line that it begins from; default: 300",
    )  # fmt: skip
    search = "surrogate: a Gaussian process says where to race next (left out with the skier); cma: CMA-ES alone"
    parser.add_argument("--search", choices=("surrogate", "cma"), help=search)
    parser.add_argument(
        "--settled", type=number("s", lowest=0.0, highest=100.0), default=0.0, metavar="SECONDS",
        help="end a search where all of its last batch lie within so much; default: 0, never",
    )  # fmt: skip
    parser.add_argument(
        "--window", type=whole_number(2, MOST_GATES), metavar="N",
        help="search the turns of N gates at once, then move on; default: all at once",
    )  # fmt: skip
    parser.add_argument(
        "--step", type=whole_number(1, MOST_GATES), default=1, metavar="N", help="gates that a window moves on by"
    )
    parser.add_argument(
        "--ahead", type=whole_number(0, MOST_GATES), default=2, metavar="N",
        help="gates behind a window that are raced through as well; default: 2",
    )  # fmt: skip
    parser.add_argument(
        "--room", type=number("m", lowest=0.0, highest=1.0), default=0.05, metavar="METRES",
        help="by which both skis have to pass each pole at least; default: 0.05",
    )  # fmt: skip
    parser.add_argument(
        "--line", type=Path, metavar="LINE.csv", help="the line to begin from; default: that of the skier itself"
    )
    parser.add_argument("--seed", type=seed_number, default=0, metavar="N", help="of every random number")


def _add_comparison_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that compare skis, worths and drawn snows."""
    parser.add_argument(
        "--against", action="append", default=[], metavar="SKI", help="another ski on the same line, by name or file"
    )
    worth = "time that a tenth more hardness, strength and less friction, 1 mm of waist and 5 %% of stiffness are worth"
    parser.add_argument("--worth", action="store_true", help=worth)
    parser.add_argument(
        "--snows", type=whole_number(0, MOST_SNOWS), default=0, metavar="N",
        help="compare also on N snows drawn from the intervals of H_V and S_f, the same for all; also with the line "
        "where the search began",
    )  # fmt: skip
    parser.add_argument(
        "--snow-spread", type=number("", lowest=0.0, highest=10.0, above=True), metavar="SHARE",
        help="draw them from the value over 1 + SHARE to 1 + SHARE times it (95 %%), whatever was measured",
    )  # fmt: skip


def run(options: argparse.Namespace) -> int:
    """Search the quickest line, print and write it; returns exit status 1 if no line passes all gates."""
    try:
        with ending_is_an_interrupt():
            fastest, checked, simulated, worth = _run_race(options)
    except KeyboardInterrupt as stopped:
        return report_interrupt(stopped, options.out)
    from ..report.race.folder import race_dict, race_summary, worth_summary, write_race

    place = write_race(
        fastest, options.out, checked=checked, worth=worth, run=simulated, against=tuple(options.against)
    )
    if options.json:
        print_json(race_dict(fastest, checked, worth))
    else:
        print(race_summary(fastest, checked), flush=True)
        if worth:
            print(f"\n{worth_summary(worth)}", flush=True)
    print(f"Race: {place}", file=sys.stderr)
    return 1 if fastest.score.time is None else 0


def _run_race(
    options: argparse.Namespace,
) -> tuple[QuickestLine, list[tuple[str, Score]], Run | None, tuple[Worth, ...]]:
    """Result of the search, scores and run by the scenario's method as in `_scores_by_method`, and variants' times."""
    from ..racing import compare_variants, drawn_for_race, quickest_line, read_line, worth_changes
    from ..racing.line import course_of
    from ..racing.search import require_cmaes

    if options.evaluations > 1:
        require_cmaes()
    scenario_input = scenario_of(options)
    print_warnings(scenario_input.warnings)
    scenario = scenario_input.scenario
    variants = {name: scenario.with_(ski=name) for name in options.against}
    if options.worth:
        variants |= worth_changes(scenario)
    snow = scenario.contact.snow
    snows = drawn_for_race(snow, options.snows, spread=options.snow_spread, seed=options.seed)
    begin = None
    if options.line is not None:
        begin = read_line(options.line, course_of(scenario), (scenario.start.x, scenario.start.y))
    prepare_output(options.out)
    computing: dict[str, Any] = {"workers": options.workers}
    with Progress() as progress:
        fastest = quickest_line(
            scenario.with_(method="fast"), gates=options.gates, model=options.model, start=begin,
            evaluations=options.evaluations, search=options.search, settled=options.settled,
            window=options.window, step=options.step, ahead=options.ahead, room=options.room, seed=options.seed,
            checkpoint=options.out / KEPT, progress=progress, **computing,
        )  # fmt: skip
        checked, run = _scores_by_method(fastest, scenario, progress)
        worth: tuple[Worth, ...] = ()
        start = fastest.start if options.snows and options.evaluations > 1 else None
        if variants or start:
            fast = {name: variant.with_(method="fast") for name, variant in variants.items()}
            worth = compare_variants(
                fastest.scenario, fast, fastest.line, snows, start=start,
                model=options.model, checkpoint=options.out / KEPT_WORTH, progress=progress, **computing,
            )  # fmt: skip
    return fastest, checked, run, worth


def _scores_by_method(
    fastest: QuickestLine, scenario: Scenario, progress: Progress
) -> tuple[list[tuple[str, Score]], Run | None]:
    """Scores of the quickest and the start line by the scenario's method, [] if that is "fast"; run on the quickest."""
    from ..racing.point import run_score, ski_line

    if fastest.model == "point":
        return [], None
    progress("racing again: the quickest line")
    run = ski_line(scenario, fastest.line)
    checked = [("quickest line, computed as the scenario says", run_score(run))]
    if scenario.solver.method == "fast":
        return [], run
    progress("racing again: where it began")
    return [*checked, ("where it began", run_score(ski_line(scenario, fastest.start)))], run
