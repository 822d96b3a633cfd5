"""``skisnow simulate`` and ``turn``: one run of a scenario, and turns on the snow of a campaign's site."""

from __future__ import annotations

import argparse
import sys
import time
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._support.errors import ModelLimitWarning
from .options import add_changes, add_language, add_workers, changes_of, number, scenario_of, seed_number, whole_number
from .output import Progress, ending_is_an_interrupt, prepare_output, print_json, print_warnings

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..scenario import Scenario, ScenarioFile
    from ..simulation.run import Run
    from ..simulation.verification import Refinement


def add_simulate(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow simulate`` to the program."""
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
    parser.set_defaults(run=simulate_scenario, parser=parser)


def simulate_scenario(options: argparse.Namespace) -> int:
    """Simulate a scenario, print and write the run; returns exit status 0 with every outcome but an interrupted one."""
    if options.list:
        from ..scenario import scenario_names, scenario_text

        print("\n".join(scenario_names()) if options.scenario is None else scenario_text(options.scenario).rstrip())
        return 0
    if options.scenario is None:
        options.parser.error("name a scenario: a built-in one (--list names them) or a TOML file")
    if options.replay and options.out is None:
        options.parser.error("--replay writes into the folder of --out: name one")
    scenario_input = scenario_of(options)
    if options.boots_out is not None:
        from .._support.staging import require_ending
        from ..simulation.run_tables import ENDINGS

        require_ending(options.boots_out, *ENDINGS)
    prepare_output(options.out)
    print_warnings(scenario_input.warnings)
    with ending_is_an_interrupt() as ending:
        result, refinements = _simulate(scenario_input, verify=options.verify)
        with ending.finishing():
            _write_and_print(options, scenario_input, result, refinements)
    return ending.status() if ending.requested or ending.pressed or result.outcome == "interrupted" else 0


def _simulate(scenario_input: ScenarioFile, *, verify: bool) -> tuple[Run, tuple[Refinement, ...] | None]:
    """Run of a scenario, and its refinements if `verify`; None without them or if the run was interrupted."""
    from ..simulation import verification
    from ..simulation.simulated_run import simulate

    with Progress() as progress, warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelLimitWarning)  # printed among those of the scenario
        result = simulate(scenario_input.scenario, progress=_show_pace(progress))
        if not verify or result.outcome == "interrupted":
            return result, None
        keys = iter(verification.repetitions(result))

        def finer(scenario: Scenario) -> Run:
            return simulate(scenario, progress=_show_pace(progress, f"again, {next(keys)}: "))

        return result, verification.verify(result, finer)


def _write_and_print(
    options: argparse.Namespace, scenario_input: ScenarioFile, result: Run, refinements: tuple[Refinement, ...] | None
) -> None:
    """Print the summary or JSON of a run and its warnings, and write boots and report as the options say."""
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

        print(simulate_summary(result, title=scenario_input.title, verification=verification), flush=True)
    print_warnings((*near, *run_warnings(result)))
    if options.boots_out is not None:
        from ..simulation.run_tables import write_boots

        write_boots(result, options.boots_out)
        print(f"Boots: {options.boots_out}", file=sys.stderr)
        if result.scenario.skier is not None and options.boots_out.suffix.lower() != ".csv":
            _write_joints(result, options.boots_out)
    if options.out is not None:
        _write_run(options, result, summary, replay_title=scenario_input.title if options.replay else None)


def _write_joints(run: Run, boots: Path) -> None:
    """Write the joint angles of a run's skier next to a table of its boots, as NAME_joints.mot."""
    from ..interop.opensim import MotionTable, write_motion
    from ..replay import joint_columns, replay_of_run

    joints = boots.with_name(f"{boots.stem}_joints.mot")
    replay = replay_of_run(run)
    write_motion(MotionTable(replay.time, joint_columns(replay), in_degrees=True, name=joints.stem), joints)
    print(f"Joints: {joints}", file=sys.stderr)


def _write_run(options: argparse.Namespace, result: Run, summary: dict[str, Any], *, replay_title: str | None) -> None:
    """Write a run's folder and, if a title is given, its replay; print their paths on standard error."""
    from ..report.run.page import REPLAY, write_run

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


def _show_pace(progress: Progress, prefix: str = "") -> Callable[[float, float], None]:
    """Callback of a simulation that prints simulated time (s), share, and the speed relative to real time."""
    begun: list[float] = []

    def show(simulated_s: float, share: float) -> None:
        time_s = time.monotonic()
        begun[:] = begun or [time_s, simulated_s]
        rate = (simulated_s - begun[1]) / max(time_s - begun[0], 1e-9)
        progress(f"{prefix}{simulated_s:.2f} s simulated, {100.0 * share:.0f} %, {rate:.3g} times real time")

    return show


MOST_RUNS = 10_000


def add_turn(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow turn`` to the program."""
    parser = commands.add_parser(
        "turn",
        help="from a campaign to a turn: analysis, the snow of a site, a simulated turn, a band over what is not known",
        description="Analyse a campaign and simulate a turn on the snow of a site, with hypoplastic and with "
        "elastic contact, and over what is not known of snow, friction and ski.",
    )
    parser.add_argument("campaign", type=Path, metavar="CAMPAIGN", help="folder of the campaign, or a workbook (.xlsx)")
    parser.add_argument("--site", metavar="SITE", help='whose snow it is, "C" or "site C"; default: all sites')
    parser.add_argument(
        "--scenario",
        default="carved-46m",
        metavar="NAME|FILE",
        help="the turn on that snow; default: carved-46m",
    )
    add_changes(
        parser, "; the campaign's H_V and S_f count, a given unloading_ratio or shear_displacement_mm comes before it"
    )
    _add_ensemble(parser)
    parser.add_argument("--json", action="store_true", help="print turn.json alone to standard output")
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="write report.html, turn.json and figures of the whole chain here"
    )
    add_language(parser)
    parser.set_defaults(run=simulate_turn)


def _add_ensemble(parser: argparse.ArgumentParser) -> None:
    """Add the options for the ensemble: unloading ratio, runs, ranges, seed and processes."""
    parser.add_argument(
        "--unloading-ratio",
        type=number("", lowest=1.0, highest=1000.0, above=True),
        metavar="RATIO",
        help="k_u/H_V of the hypoplastic contact; default: the site's unloading, otherwise 10",
    )
    parser.add_argument(
        "--runs", type=whole_number(3, MOST_RUNS), metavar="N", help="runs of the ensemble, 3 or more; default: 64"
    )
    parser.add_argument(
        "--prior",
        action="append",
        default=[],
        dest="priors",
        metavar="key=low:high",
        help="range of a key of the scenario that the ensemble is drawn over, instead of a default one or in "
        "addition to the defaults, several times for several; equal ends: it is known",
    )
    parser.add_argument("--seed", type=seed_number, help="seed of the ensemble, a whole number of 0 or more")
    add_workers(parser)


def simulate_turn(options: argparse.Namespace) -> int:
    """Analyse a campaign and simulate a turn on its snow; print sentences or JSON, and write the report."""
    from ..pipeline import turn
    from ..scenario.identify_section import prior_of

    priors = [prior_of(word) for word in options.priors]
    scenario_input = scenario_of(options)
    print_warnings(scenario_input.warnings)
    prepare_output(options.out)
    names = ("unloading_ratio", "runs", "seed", "workers")
    contact, changes = scenario_input.scenario.contact, changes_of(options)
    numbers: dict[str, Any] = {}  # which override the values of the campaign
    if "snow.unloading_ratio" in changes:
        numbers["unloading_ratio"] = contact.unloading_ratio
    if "snow.shear_displacement_mm" in changes:
        numbers["shear_displacement"] = contact.shear_displacement
    chosen = numbers | {name: getattr(options, name) for name in names if getattr(options, name) is not None}
    with Progress() as progress:
        chain = turn(
            options.campaign, options.site, scenario_input.scenario, priors=priors, progress=progress, **chosen
        )
        page = None if options.out is None else chain.report(options.out, language=options.language)
    if options.json:
        from ..report.turn.chain import turn_dict

        print_json(turn_dict(chain))
    else:
        print(f"snow: {chain.snow.in_words}", *chain.sentences, sep="\n")
    print_warnings(chain.warnings)
    if page is not None:
        print(f"The whole chain: {page}", file=sys.stderr)
    return 0
