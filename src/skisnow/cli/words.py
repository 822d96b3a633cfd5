"""Arguments that need more than a type, and misspelt options."""

from __future__ import annotations

import argparse
import difflib
import re
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

_BEGINS_AS_NUMBER: Final = re.compile(r"[-+]?\d+(?:[.,]\d+)?")


class Parser(argparse.ArgumentParser):
    """A parser that names the option which a misspelt one is most like, before it misses that one."""

    _has_commands = False

    def add_subparsers(self, **named: Any) -> Any:
        """Take commands of its own: the options behind them are theirs."""
        self._has_commands = True
        return super().add_subparsers(**named)

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Look at the options, then parse as usual."""
        if args is not None and not self._has_commands:
            self._require_known(list(args))
        return super().parse_known_args(args, namespace)

    def _require_known(self, words: list[str]) -> None:
        options = set(re.findall(r"--[\w-]+", self.format_help()))
        for word in words[: words.index("--")] if "--" in words else words:
            name = word.split("=", 1)[0]
            if name.startswith("--") and not any(option.startswith(name) for option in options):
                self.error(f"there is no option {name}.{_meant(name, options)} {self.prog} --help names all")


def _meant(name: str, options: Iterable[str]) -> str:
    by_small = {option.lower(): option for option in sorted(options)}
    like = difflib.get_close_matches(name.lower(), by_small, n=1, cutoff=0.6)
    return f" Is {by_small[like[0]]} meant?" if like else ""


def number(unit: str) -> Callable[[str], float]:
    """A reader of numbers that says how to write one.

    Parameters
    ----------
    unit
        In which the number is; empty where it has none.
    """

    def read(word: str) -> float:
        try:
            return float(word)
        except ValueError:
            found = _BEGINS_AS_NUMBER.match(word.strip())
            example = f", such as {found[0].replace(',', '.')}" if found else ""
            told = f" in {unit}, without the unit" if unit else ""
            raise argparse.ArgumentTypeError(
                f"{word!r} is no number; write one with a decimal point{told}{example}"
            ) from None

    return read


def whole_number(word: str) -> int:
    """A whole number."""
    try:
        return int(word)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{word!r} is no whole number; write one such as 160") from None


def port_number(word: str) -> int:
    """A port to listen on: a whole number from 0 to 65535."""
    try:
        port = int(word)
    except ValueError:
        port = -1
    if not 0 <= port <= 65_535:
        raise argparse.ArgumentTypeError(f"{word!r} is no port; a whole number from 1 to 65535 is, or 0 for a free one")
    return port


def seed_number(word: str) -> int:
    """A seed: a whole number from 0 to 2⁶³ - 1, so that it can stand in every file."""
    try:
        seed = int(word)
    except ValueError:
        seed = -1
    if not 0 <= seed < 2**63:
        raise argparse.ArgumentTypeError(f"{word!r} is no seed; a whole number from 0 to 9223372036854775807 is")
    return seed
