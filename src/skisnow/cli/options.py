"""Arguments that need more than a type, and misspelt options."""

from __future__ import annotations

import argparse
import math
import re
from typing import TYPE_CHECKING, Any, Final

from .._support.errors import suggest
from .._support.messages import ENGLISH, languages

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..scenario import ScenarioFile

MOST_WORKERS: Final = 256
MOST_RESAMPLES: Final = 100_000
_BEGINS_AS_NUMBER: Final = re.compile(r"[-+]?\d+(?:[.,]\d+)?")


class Parser(argparse.ArgumentParser):
    """Argument parser that reports a misspelt option first, with the most similar known one."""

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Reject unknown options of the last of nested commands, then parse as usual."""
        words = [] if args is None or self._subparsers is not None else list(args)
        options = set(re.findall(r"--[\w-]+", self.format_help())) if words else set()
        for word in words[: words.index("--")] if "--" in words else words:
            name = word.split("=", 1)[0]
            if name.startswith("--") and not any(option.startswith(name) for option in options):
                self.error(f"there is no option {name}. {suggest(name, sorted(options))}{self.prog} --help names all")
        return super().parse_known_args(args, namespace)


def add_fall_line_azimuth(parser: argparse.ArgumentParser, why: str) -> None:
    """Add the option for the compass direction in which the slope falls; `why`: its purpose, for the help."""
    parser.add_argument(
        "--fall-line-azimuth-deg",
        type=number("degrees", lowest=-360, highest=360),
        metavar="DEG",
        help=f"compass direction in which the slope falls: {why}",
    )


def add_language(parser: argparse.ArgumentParser, what: str = "the page and the figures that --out writes") -> None:
    """Add the option for the language of a report; `what`: the parts that are translated."""
    parser.add_argument(
        "--language",
        choices=languages(),
        default=ENGLISH,
        help=f"of {what}; other printed text and files that programs read are English (default: en)",
    )


def add_changes(parser: argparse.ArgumentParser, more: str = "") -> None:
    """Add the option that overrides keys of a scenario; `more` is appended to the help."""
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        dest="changes",
        metavar="section.key=value",
        help=f"another value for one key, several times for several; the section may be left out{more}",
    )


def changes_of(options: argparse.Namespace) -> dict[str, object]:
    """Values by key from the option of `add_changes`."""
    from ..scenario.keys import parse_change

    return dict(parse_change(word) for word in options.changes)


def scenario_of(options: argparse.Namespace) -> ScenarioFile:
    """The scenario that a command names, with the changes of `add_changes`."""
    from ..scenario import scenario_file

    return scenario_file(options.scenario, changes=changes_of(options))


def add_workers(parser: argparse.ArgumentParser) -> None:
    """Add the option for the number of processes."""
    workers = "processes; default: one for each core"
    parser.add_argument("--workers", type=whole_number(1, MOST_WORKERS), metavar="N", help=workers)


def number(
    unit: str, *, lowest: float = -math.inf, highest: float = math.inf, above: bool = False
) -> Callable[[str], float]:
    """Function that converts the text of an option to a number; its error states the allowed form.

    unit: unit of the number; empty without one.
    lowest, highest: allowed range; it is only checked if `highest` is finite.
    above: True if the lowest value itself is excluded.
    """
    ranged = highest < math.inf

    def read(word: str) -> float:
        value = written(word)
        if ranged and (not lowest <= value <= highest or (above and value == lowest)):
            ends = f"{'above' if above else 'from'} {lowest:g} to {highest:g}"
            raise argparse.ArgumentTypeError(f"{_quoted(word)} is not allowed; allowed is a number {ends} in {unit}")
        return value

    def written(word: str) -> float:
        try:
            return float(word)
        except ValueError:
            match = _BEGINS_AS_NUMBER.match(word.strip())
            example = f", such as {match[0].replace(',', '.')}" if match else ""
            where = f" in {unit}, without the unit" if unit else ""
            raise argparse.ArgumentTypeError(
                f"{_quoted(word)} is not a number; write one with a decimal point{where}{example}"
            ) from None

    return read


def whole_number(
    lowest: float = -math.inf, highest: float = math.inf, *, or_zero: bool = False
) -> Callable[[str], int]:
    """Function that converts the text of an option to a whole number in a range; ``or_zero``: 0 is allowed, too."""

    def read(word: str) -> int:
        try:
            value = int(word)
        except ValueError:
            example = f"write one such as {int(lowest) if lowest > 0 else 160}"
            raise argparse.ArgumentTypeError(f"{_quoted(word)} is not a whole number; {example}") from None
        if not (lowest <= value <= highest or (or_zero and value == 0)):
            allowed = f"{'0, or ' if or_zero else ''}{lowest} to {highest}"
            raise argparse.ArgumentTypeError(f"{_quoted(word)} is not allowed; allowed is a whole number, {allowed}")
        return value

    return read


def _quoted(word: str, limit: int = 80) -> str:
    """A word in quotes for a message, cut after `limit` characters."""
    return repr(word if len(word) <= limit else f"{word[:limit]}…")


seed_number = whole_number(0, 2**63 - 1)
"""Converter of a seed, which can be in every file."""
