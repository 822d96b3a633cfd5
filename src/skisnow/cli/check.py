"""``skisnow check``: every problem of a campaign, with file, row, column, value and what to do."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..campaign import Problem


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser("check", help="list every problem of a campaign")
    parser.add_argument("campaign", type=Path, help="folder of the campaign, or a workbook (.xlsx)")
    parser.add_argument("--json", action="store_true", help="print the problems as JSON")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
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
    from .progress import Progress

    with Progress() as progress:
        try:
            campaign = read_campaign(folder, progress=progress)
        except FieldDataError as error:
            return [problem for problem in error.problems if isinstance(problem, Problem)], ()
        return [*campaign.problems, *quality_flags(campaign)], campaign_notes(campaign)


def _count(problems: list[Problem], severity: str) -> int:
    return sum(problem.severity == severity for problem in problems)
