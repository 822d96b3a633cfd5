"""``skisnow man``: the help of every command as one page for ``man``."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    about = "Print the manual page: skisnow man > ~/.local/share/man/man1/skisnow.1; then man skisnow."
    parser = commands.add_parser("man", help="print the manual page, made of these helps", description=about)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the page."""
    from importlib.metadata import version

    print(manual_page(options.program, version("skisnow")), end="")
    return 0


def manual_page(parser: argparse.ArgumentParser, version: str) -> str:
    """The page in roff, section 1."""
    lines = [
        f'.TH SKISNOW 1 "" "skisnow {_text(version)}" "User commands"',
        ".SH NAME",
        f"skisnow \\- {_text((parser.description or '').rstrip('.'))}",
        ".SH SYNOPSIS",
        *_synopsis(parser),
        ".SH COMMANDS",
        *(line for name, command in _commands(parser) for line in _command(command, _help_of(parser, name))),
        ".SH EXIT STATUS",
        "0: done. 1: the data or the machine refused, with a sentence on standard error. 2: wrong words. 70: an error",
        "that was not foreseen. 130: interrupted.",
        ".SH SEE ALSO",
        "docs/files/command\\-line.md in the repository says more, with every default and unit.",
    ]
    return "\n".join(lines) + "\n"


def _commands(parser: argparse.ArgumentParser) -> Iterator[tuple[str, argparse.ArgumentParser]]:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            yield from action.choices.items()


def _help_of(parser: argparse.ArgumentParser, name: str) -> str:
    actions = (action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    return next(
        (choice.help or "" for action in actions for choice in action._choices_actions if choice.dest == name), ""
    )


def _command(parser: argparse.ArgumentParser, about: str) -> Iterator[str]:
    yield f".SS {_text(parser.prog)}"
    yield from _synopsis(parser)
    yield ".PP"
    yield _text(_filled(parser.description or about, parser))
    for action in parser._actions:
        if not isinstance(action, argparse._HelpAction | argparse._SubParsersAction):
            yield ".TP"
            yield f".B {_text(_called(action))}"
            yield _text(_filled(action.help or "", parser, action)) or "\\&"
    for inner, command in _commands(parser):
        yield from _command(command, _help_of(parser, inner))


def _synopsis(parser: argparse.ArgumentParser) -> Iterator[str]:
    usage = parser.format_usage().removeprefix("usage:")
    yield _text(" ".join(usage.split()))


def _called(action: argparse.Action) -> str:
    metavar = action.metavar if isinstance(action.metavar, str) else None
    if action.choices is not None and metavar is None:
        metavar = "|".join(map(str, action.choices))
    if not action.option_strings:
        return metavar or action.dest
    names = ", ".join(action.option_strings)
    return names if action.nargs == 0 else f"{names} {metavar or action.dest.upper()}"


def _filled(text: str, parser: argparse.ArgumentParser, action: argparse.Action | None = None) -> str:
    """A help with what argparse puts in for %(default)s and %%."""
    return text % {**(vars(action) if action is not None else {}), "prog": parser.prog}


def _text(text: str) -> str:
    """Text that roff takes as it is: a line that begins with a point or an apostrophe would be a request."""
    escaped = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^(?=[.'])", r"\\&", escaped)
