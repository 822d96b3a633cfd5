"""Run programs on the cases and score them.

``python -m openbench run PROGRAM`` runs a shipped entry by its name, all of them with ``all``, or any command, which is
given two words more: the folder of a case and the file of the result. ``score`` sets error against cost.
"""

from __future__ import annotations

import argparse
import json
import shlex
import sys
import tempfile
from dataclasses import asdict
from pathlib import Path

from . import VERSION, scoring, table
from .programs import command_of, shipped, why_not
from .reading import case_names
from .running import Asked, run
from .words import OpenbenchError


def main(words: list[str] | None = None) -> int:
    """The command line; 1 where something was wrong."""
    parser = argparse.ArgumentParser(
        prog="python -m openbench", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    verbs = parser.add_subparsers(dest="verb", required=True)
    runs = verbs.add_parser("run", help="a program on the cases")
    runs.add_argument("program", help=f"a command, or one of {', '.join(shipped())}, or all")
    runs.add_argument("--name", help="of the program in tables; left out: that of the entry or of the command's file")
    runs.add_argument("--out", type=Path, default=Path("openbench-runs"), help="folder of runs")
    runs.add_argument("--data", type=Path, help="folder with the measured files of case 05-sand")
    runs.add_argument("--case", action="append", choices=case_names(), help="this alone; may stand several times")
    runs.add_argument("--repeats", type=int, default=1, help="of each case; the one with the least CPU time counts")
    scores = verbs.add_parser("score", help="runs against the answers")
    scores.add_argument("runs", type=Path, nargs="?", default=Path("openbench-runs"))
    scores.add_argument("--data", type=Path)
    scores.add_argument("--json", type=Path, help="write all scores there")
    scores.add_argument("--chart", type=Path, help="draw error against cost there (matplotlib)")
    asked = parser.parse_args(words)
    try:
        return _run(asked) if asked.verb == "run" else _score(asked)
    except OpenbenchError as error:
        print(f"openbench: {error}", file=sys.stderr)
        return 1


def _run(asked: argparse.Namespace) -> int:
    how = Asked(tuple(asked.case or case_names()), asked.data, asked.repeats)
    failed = False
    with tempfile.TemporaryDirectory() as build:
        for name in shipped() if asked.program == "all" else [asked.program]:
            known = name in shipped()
            missing = why_not(name) if known else None
            if missing:
                print(missing)
                failed |= asked.program != "all"
                continue
            command = command_of(name, Path(build)) if known else shlex.split(name)
            title = asked.name or (name if known else Path(command[-1]).stem)
            record = run(title, command, asked.out, how)
            failed |= any(each["problems"] for case, each in record["cases"].items() if case in how.cases)
    return int(failed)


def _score(asked: argparse.Namespace) -> int:
    found = scoring.score(asked.runs, data=asked.data)
    starts = scoring.start_costs(asked.runs)
    print(f"openbench {VERSION}: error / cost in calibration loops\n")
    print(table.table(found, starts))
    print(table.reasons(found), end="")
    if asked.json:
        told = {"openbench": VERSION, "start_cost_1": starts, "scores": [asdict(each) for each in found]}
        asked.json.write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
    if asked.chart:
        from .chart import draw

        draw(found, asked.chart)
    return int(any(each.problems for each in found))


if __name__ == "__main__":
    sys.exit(main())
