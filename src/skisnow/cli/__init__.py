"""The command line: thin. No formula, no default of the science and no unit factor lives here."""

from __future__ import annotations

import argparse
import io
import os
import sys
import traceback
from collections.abc import Sequence
from typing import Any, Final

from .._support.errors import FieldDataError, SkisnowError
from .._support.messages import ENGLISH, LANGUAGE_OF_ERRORS
from .output import Ended

LONGEST_MESSAGE: Final = 8_000
STATUS: Final = 70  # exit status after an unforeseen error; ``EX_SOFTWARE`` of sysexits.h


def build_parser() -> argparse.ArgumentParser:
    """Parser of the command line with all commands; heavy modules are imported only when a command runs."""
    from importlib.metadata import version

    from . import (
        beginning,
        campaign,
        carve,
        convert,
        identify,
        race,
        replay,
        shell,
        simulate,
        store,
        study,
        track,
    )
    from .options import Parser

    parser = Parser(
        prog="skisnow",
        description="From field tests of a ski slope to snow parameters, and from those to what a ski does on it.",
    )
    parser.add_argument("--version", action="version", version=f"skisnow {version('skisnow')}")
    commands: Any = parser.add_subparsers(title="commands", metavar="COMMAND", parser_class=Parser)
    parser.set_defaults(run=lambda _: parser.print_help(), program=parser)
    for add_command in (
        beginning.add_new, campaign.add_import, campaign.add_check, campaign.add_analyse, store.add_parser,
        beginning.add_reference, beginning.add_samples, carve.add_carve, carve.add_design, simulate.add_simulate,
        replay.add_replay, simulate.add_turn, study.add_parser, race.add_parser, track.add_track, track.add_compare,
        identify.add_parser, convert.add_export, convert.add_convert, shell.add_schema, replay.add_serve,
        shell.add_completion, shell.add_man,
    ):  # fmt: skip
        add_command(commands)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; `arguments` default to those of the process.

    Returns the exit status: 0 after success, 1 after an error in data or files, 70 after an unforeseen error. Wrong
    words on the command line exit with 2.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # JSON is UTF-8 whatever the terminal's code page
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    try:  # an interrupt may come already while commands are still being loaded
        options = build_parser().parse_args(arguments)
        status: int = options.run(options) or 0
        sys.stdout.flush()
    except (Exception, KeyboardInterrupt) as error:
        return _report_end(error)
    return status


def _report_end(error: Exception | KeyboardInterrupt) -> int:
    """Print why a command ended; returns its exit status."""
    if isinstance(error, KeyboardInterrupt):
        print("skisnow: interrupted; nothing half-written was left behind.", file=sys.stderr)
        return 143 if isinstance(error, Ended) else 130
    if isinstance(error, BrokenPipeError):
        return _replace_lost_stdout()
    if isinstance(error, OSError):
        print(f"skisnow: {error.strerror or error}{f': {error.filename}' if error.filename else ''}", file=sys.stderr)
        return _replace_lost_stdout()
    if isinstance(error, SkisnowError | MemoryError):
        _print_error(error)
        return 1
    traceback.print_exception(error)
    print("skisnow: an error that was not foreseen; please send the lines above with what you did.", file=sys.stderr)
    return STATUS


def _print_error(error: SkisnowError | MemoryError) -> None:
    """Print an error on standard error: one line per problem of field data, otherwise one sentence."""
    if isinstance(error, FieldDataError):
        from ..campaign.problems import Problem, lines_of

        of_campaign = [problem for problem in error.problems if isinstance(problem, Problem)]
        others = [str(problem) for problem in error.problems if not isinstance(problem, Problem)]
        for line in (*lines_of(of_campaign), *others):
            print(_short(line), file=sys.stderr)
        print("Nothing was written: fix the errors above first.", file=sys.stderr)
    elif isinstance(error, SkisnowError):
        print(f"skisnow: {_short(error.text(os.environ.get(LANGUAGE_OF_ERRORS, ENGLISH)))}", file=sys.stderr)
    else:
        print("skisnow: the memory of this machine does not hold it. Give less at once.", file=sys.stderr)


def _short(message: str) -> str:
    """A message of an error, shortened to `LONGEST_MESSAGE` characters."""
    return message if len(message) <= LONGEST_MESSAGE else f"{message[:LONGEST_MESSAGE]} …"


def _replace_lost_stdout() -> int:
    """Replace standard output if it cannot be written, so that Python prints no second error; returns exit status 1."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return 1
