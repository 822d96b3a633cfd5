"""``skisnow check`` and ``analyse``: problems of a campaign; its snow parameters and, with ``--out``, a report."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .options import MOST_RESAMPLES, add_language, number, seed_number, whole_number
from .output import prepare_output
from .progress import Progress

if TYPE_CHECKING:
    from ..campaign import Problem


def add_check(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow check`` to the program."""
    parser = commands.add_parser("check", help="list every problem of a campaign")
    parser.add_argument("campaign", type=Path, help="folder of the campaign, or a workbook (.xlsx)")
    parser.add_argument("--json", action="store_true", help="print the problems as JSON")
    parser.set_defaults(run=check)


def check(options: argparse.Namespace) -> int:
    """Print the problems; 1 if any is an error."""
    problems, notes = _problems(options.campaign)
    errors, warnings, flags = (_count(problems, severity) for severity in ("error", "warning", "mark"))
    if options.json:
        entries = [problem.as_dict() for problem in problems]
        print(json.dumps({"errors": errors, "warnings": warnings, "problems": entries}, ensure_ascii=False))
    else:
        from ..campaign.problems import lines_of

        for line in lines_of(problems):
            print(line)
        for note in notes:
            print(f"note: {note}")
        warnings = _count([problem for problem in problems if problem.needs_action], "warning")
        print(f"errors: {errors}, warnings: {warnings}, flags: {flags}")
    return 1 if errors else 0


def _problems(folder: Path) -> tuple[list[Problem], tuple[str, ...]]:
    from .._support.errors import FieldDataError
    from ..campaign import Problem, read_campaign
    from ..estimation import campaign_notes, quality_flags

    with Progress() as progress:
        try:
            campaign = read_campaign(folder, progress=progress)
        except FieldDataError as error:
            return [problem for problem in error.problems if isinstance(problem, Problem)], ()
        return [*campaign.problems, *quality_flags(campaign)], campaign_notes(campaign)


def _count(problems: list[Problem], severity: str) -> int:
    return sum(problem.severity == severity for problem in problems)


def add_analyse(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow analyse`` to the program."""
    parser = commands.add_parser("analyse", help="estimate snow hardness and failure shear stress of a campaign")
    parser.add_argument("campaign", type=Path, help="folder of the campaign, or a workbook (.xlsx)")
    parser.add_argument("--out", type=Path, metavar="DIR", help="write results.json, report, figures and tables here")
    parser.add_argument(
        "--geometry",
        choices=("extended", "paper"),
        default="extended",
        help="the ski piece with its continuation below the rim of its base, or the paper's plain wedge",
    )
    add_language(parser)
    parser.add_argument("--json", action="store_true", help="print results.json instead of the summary")
    parser.add_argument("--seed", type=seed_number, help="seed of the bootstrap, a whole number of 0 or more")
    parser.add_argument(
        "--resamples",
        type=whole_number(100, MOST_RESAMPLES),
        metavar="N",
        help="bootstrap resamples of whole experiments, 100 or more",
    )
    parser.add_argument(
        "--difference",
        type=number("percent", lowest=0.0, highest=1e6, above=True),
        default=20.0,
        metavar="PERCENT",
        help="difference of two sites, tools, observers or days that the campaign is to detect, for the number of "
        "tests that this takes (default: 20)",
    )
    parser.set_defaults(run=analyse)


def analyse(options: argparse.Namespace) -> int:
    """Analyse, write the results, print the summary."""
    from .. import estimation
    from .._support.environment import paused_collector
    from ..campaign import read_campaign
    from ..estimation.results import results_json

    chosen: dict[str, Any] = {}
    if options.seed is not None:
        chosen["seed"] = options.seed
    if options.resamples is not None:
        chosen["n_resamples"] = options.resamples
    with Progress() as progress, paused_collector():
        campaign = read_campaign(options.campaign, progress=progress)
        if options.out is not None:
            prepare_output(options.out)
        analysis = estimation.analyse(
            campaign,
            geometry=options.geometry,
            difference=options.difference / 100.0,
            progress=progress,
            **chosen,
        )
        if options.out is not None:
            from ..report import write_report

            write_report(analysis, options.out, language=options.language, progress=progress)
    if options.json:
        print(results_json(analysis.results).decode("utf-8"), end="")
        return 0
    from ..report.campaign.summary import summary

    print(summary(analysis.results))
    if options.out is not None:
        print(f"Report: {options.out / 'report.html'}", file=sys.stderr)
    return 0
