"""``skisnow check``, ``analyse``, ``import``: a campaign's problems, its snow parameters, and files in any layout."""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from .._support.errors import FieldDataError, ParameterError
from .options import MOST_RESAMPLES, add_language, number, seed_number, whole_number
from .output import Progress, prepare_output

if TYPE_CHECKING:
    from ..campaign import Problem
    from ..campaign.importing.answers import Answers, Question
    from ..campaign.importing.proposal import Proposal


def add_check(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow check`` to the program."""
    parser = commands.add_parser("check", help="list every problem of a campaign")
    parser.add_argument("campaign", type=Path, help="folder of the campaign, or a workbook (.xlsx)")
    parser.add_argument("--json", action="store_true", help="print the problems as JSON")
    parser.set_defaults(run=check)


def check(options: argparse.Namespace) -> int:
    """Print the problems of a campaign; returns exit status 1 if one of them is an error."""
    problems, notes = _find_problems(options.campaign)
    counts = Counter(problem.severity for problem in problems)
    if options.json:
        entries = [problem.as_dict() for problem in problems]
        numbers = {f"{severity}s": counts[severity] for severity in ("error", "warning", "flag")}
        print(json.dumps(numbers | {"problems": entries}, ensure_ascii=False))
    else:
        from ..campaign.problems import lines_of

        for line in lines_of(problems):
            print(line)
        for note in notes:
            print(f"note: {note}")
        warnings = sum(problem.severity == "warning" and problem.needs_action for problem in problems)
        print(f"errors: {counts['error']}, warnings: {warnings}, flags: {counts['flag']}")
    return 1 if counts["error"] else 0


def _find_problems(folder: Path) -> tuple[list[Problem], tuple[str, ...]]:
    """Problems of a campaign with its quality flags, and notes of the analysis; only problems if it has errors."""
    from ..campaign import Problem, read_campaign
    from ..estimation import campaign_notes, quality_flags

    with Progress() as progress:
        try:
            campaign = read_campaign(folder, progress=progress)
        except FieldDataError as error:
            return [problem for problem in error.problems if isinstance(problem, Problem)], ()
        return [*campaign.problems, *quality_flags(campaign)], campaign_notes(campaign)


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
    """Analyse a campaign, write its results to a folder, and print a summary."""
    from .. import estimation
    from .._support.environment import paused_collector
    from ..campaign import read_campaign
    from ..estimation.results import results_json

    given = {"seed": options.seed, "n_resamples": options.resamples}
    chosen: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
    with Progress() as progress, paused_collector():
        campaign = read_campaign(options.campaign, progress=progress)
        prepare_output(options.out)
        difference = options.difference / 100.0
        analysis = estimation.analyse(
            campaign, geometry=options.geometry, difference=difference, progress=progress, **chosen
        )
        if options.out is not None:
            from ..report import write_report

            write_report(analysis, options.out, language=options.language, progress=progress)
    if options.json:
        print(results_json(analysis.results).decode("utf-8"), end="")
        return 0
    from ..report.campaign.summary import summary

    print(summary(analysis))
    if options.out is not None:
        print(f"Report: {options.out / 'report.html'}", file=sys.stderr)
    return 0


OPTIONS: Final = {
    "table": ("SHEET:ROW=TABLE", "table below a row of headings: penetration, shear, density, drop_cone, - for none"),
    "column": ("HEADING=COLUMN", "column of a heading, or of TABLE.HEADING; - leaves it out"),
    "unit": ("HEADING=UNIT", "unit of the numbers below a heading, such as kg"),
    "site": ("SHEET=SITE", "site of the tests on a sheet"),
    "tool": ("TOOL", "tool with its lengths, such as 'ski 200 x 62 mm', or NAME=TOOL for a name in the table"),
    "plate": ("LENGTH", "length of the blade, such as '100 mm', or NAME=LENGTH for a name in the table"),
    "cells": (
        "KEY=VALUE",
        "decimal=, or thousands=. for numbers typed as text; fill-down=yes for blank names and angles; "
        "hidden=no or struck=no to leave out what is hidden or struck through",
    ),
    "ignore": ("PLACE", "row, column or cell that is not imported: SHEET!5, SHEET!H, SHEET!H5"),
}
PREVIEW_ROWS: Final = 3


def add_import(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow import`` to the program."""
    parser = commands.add_parser(
        "import",
        help="make a campaign of a workbook or CSV file in any layout",
        description="Find tables, columns, units, tools and sites in FILE, ask for what the file does not state, and "
        "write a campaign with the original file and the mapping. Each answer is also an option (repeatable).",
    )
    parser.add_argument("file", type=Path, nargs="?", metavar="FILE", help="workbook (.xlsx) or CSV file")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder to write, new or empty")
    parser.add_argument(
        "--yes",
        action="store_true",
        help="do not ask: accept what headings, units and notes state, and reject the file if anything else is needed",
    )
    parser.add_argument(
        "--template", metavar="NAME|DIR", help="saved template, or campaign of an earlier import, with its answers"
    )
    parser.add_argument("--save-template", metavar="NAME", help="save the answers under a name for the next campaign")
    parser.add_argument("--undo", type=Path, metavar="DIR", help="remove the files of an import, if none was changed")
    for option, (form, about) in OPTIONS.items():
        parser.add_argument(f"--{option}", action="append", default=[], metavar=form, help=about)
    parser.set_defaults(run=import_file)


def import_file(options: argparse.Namespace) -> int:
    """Import a file as a campaign, or undo an import, and print the written or removed files."""
    from ..campaign.importing.answers import Answers, read_template, save_template
    from ..campaign.importing.folder import undo_import, write_import
    from ..campaign.reading.campaign_file import CAMPAIGN_FILE

    if options.undo is not None:
        print(f"Removed: {', '.join(undo_import(options.undo))}")
        return 0
    if options.file is None or options.out is None:
        raise ParameterError("Name the file and the folder: skisnow import FILE --out DIR.").tag("missing_option")
    asks = not options.yes and sys.stdin.isatty()
    answers = Answers.of_options({option: getattr(options, option) for option in OPTIONS})
    if options.template is not None:  # options override the answers of the template
        answers = read_template(options.template).updated(answers)
    proposal = _ask_questions(options, answers, asks=asks)
    if proposal.problems:
        raise FieldDataError(proposal.problems)
    print("\n".join(preview_lines(proposal)))
    if asks and input("Write this campaign? [y/N] ").strip().lower() not in {"y", "yes", "j", "ja"}:
        print("Nothing was written.")
        return 1
    if options.save_template is not None:
        saved = save_template(options.save_template, proposal.files[CAMPAIGN_FILE])
        print(f"Template {options.save_template} saved: {saved}")
    write_import(proposal.files, options.out)
    print(f"Written: {', '.join(str(options.out / name) for name in proposal.files)}")
    print(f"Then: skisnow analyse {options.out}")
    return 0


def _ask_questions(options: argparse.Namespace, answers: Answers, *, asks: bool) -> Proposal:
    """Proposal of an import; with `asks` True its open questions are asked on the terminal first."""
    from ..campaign.importing.proposal import propose

    data = options.file.read_bytes()
    proposal = propose(options.file.name, data, answers)
    while asks and proposal.questions:
        question = proposal.questions[0]
        answers = answers.with_(question.option, question.key, _ask_in_terminal(question))
        proposal = propose(options.file.name, data, answers)
    return proposal


def _ask_in_terminal(question: Question) -> str:
    """Answer that the user types to a question; an empty line takes the proposal, if there is one."""
    print(question.problem.message)
    if question.choices:
        print(f"  choices: {', '.join(question.choices)}")
    default = f" [{question.proposed}]" if question.proposed else ""
    while not (answer := input(f"  {question.option} {question.key}{default}: ").strip() or question.proposed):
        pass
    return answer


def preview_lines(proposal: Proposal) -> list[str]:
    """Lines for the terminal with the first rows of each table as they are stored, and H_V (N/mm³) of one series."""
    from ..campaign.reading.campaign import campaign_of_files
    from ..estimation.result_rows import first_hardness

    lines = []
    for table in proposal.tables:
        columns = [choice.column for choice in table.columns if choice.column]
        units = [f"{choice.heading} in {choice.unit.name}" for choice in table.columns if choice.unit is not None]
        lines += [f"{table.section.key}: {table.form.file}, {len(table.rows)} rows ({', '.join(units)})"]
        lines += [f"  {', '.join(dict.fromkeys(('site', *columns)))}"]
        for row in table.rows[:PREVIEW_ROWS]:
            lines.append("  " + ", ".join(row.cells.get(name, "") for name in dict.fromkeys(("site", *columns))))
    first = first_hardness(campaign_of_files(proposal.files))
    return [*lines, f"H_V of {first[0]}: {first[1]:.3f} N/mm³"] if first is not None else lines
