"""docs/files/command-line.md names every command and option that there is, and no other."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from skisnow.cli import build_parser

PAGE = (Path(__file__).parents[2] / "docs" / "files" / "command-line.md").read_text(encoding="utf-8")
PIECES = [piece for piece in re.split(r"\n\n|\n(?=`skisnow |\| )", PAGE) if piece.strip()]


def commands(parser: argparse.ArgumentParser, words: tuple[str, ...] = ()) -> Iterator[tuple[str, argparse.Action]]:
    """Each command that does something, with each of its options."""
    inner = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    for group in inner:
        for name, command in group.choices.items():
            yield from commands(command, (*words, name))
    if not inner:
        for action in parser._actions:
            yield " ".join(words), action


EVERY = list(commands(build_parser()))


def told(command: str) -> str:
    """The page's rows about a command and those that begin with its name; of stores their common words."""
    group, *rest = command.split()
    own = [piece for piece in PIECES if re.search(rf"`skisnow {command}(?![\w-])", piece)]
    if group == "store":
        own += [piece for piece in PIECES if f"`{' '.join(rest)}" in piece or "Each `store` command" in piece]
    return "\n".join(own)


@pytest.mark.parametrize("command", sorted({command for command, _ in EVERY}))
def test_it_names_the_command_with_every_option_and_choice(command: str) -> None:
    text = told(command)
    assert text, f"skisnow {command} is not there"
    for action in (action for name, action in EVERY if name == command):
        if not action.option_strings or action.dest == "help" or action.help == argparse.SUPPRESS:
            continue
        option = max(action.option_strings, key=len)
        assert re.search(rf"{option}(?![\w-])", text), f"skisnow {command} {option} is not there"
        for choice in action.choices or ():
            assert re.search(rf"(?<![\w-]){re.escape(str(choice))}(?![\w-])", text), f"{command} {option} {choice}"


def test_it_names_no_option_that_is_none() -> None:
    known = {option for _, action in EVERY for option in action.option_strings} | {"--version"}
    assert set(re.findall(r"(?<![\w-])--[A-Za-z][\w-]*", PAGE)) <= known
    for row in re.findall(r"^\| `skisnow (.*?)` ", PAGE, re.MULTILINE):
        words = re.match(r"[a-z]+(?: [a-z]+)*", row)
        assert words is not None
        command = next(name for name in (words[0], words[0].split()[0], " ".join(words[0].split()[:2])) if told(name))
        own = {o for name, action in EVERY if name.startswith(command) for o in action.option_strings}
        assert set(re.findall(r"--[A-Za-z][\w-]*", row)) <= own, row
