"""``skisnow completion``, ``man`` and ``schema``: words for shells, the help as one page, JSON Schemas of files."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import Final

from ..parameters.json_schema import Schema

SHELLS: Final = ("bash", "zsh", "fish")
WORDS: Final = "words"
_SCRIPTS: Final = {
    "bash": """\
# skisnow in bash: eval "$(skisnow completion bash)", in ~/.bashrc
_skisnow() {
    local IFS=$'\\n' word="${COMP_WORDS[COMP_CWORD]}"
    local words="$("${COMP_WORDS[0]}" completion words -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)"
    COMPREPLY=($(compgen -W "$words" -- "$word"))
    [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *= ]] && compopt -o nospace
    return 0
}
complete -o default -F _skisnow skisnow
""",
    "zsh": """\
# skisnow in zsh: eval "$(skisnow completion zsh)", in ~/.zshrc behind compinit
_skisnow() {
    local -a found
    found=("${(@f)$("${words[1]}" completion words -- "${(@)words[2,CURRENT]}" 2>/dev/null)}")
    if (( ${#found} )) && [[ -n "${found[1]}" ]]; then compadd -a found; else _files; fi
}
compdef _skisnow skisnow
""",
    "fish": """\
# skisnow in fish: skisnow completion fish | source, in ~/.config/fish/config.fish
function __skisnow_words
    set -l given (commandline -opc)
    $given[1] completion words -- $given[2..-1] (commandline -ct) 2>/dev/null
end
complete -c skisnow -a '(__skisnow_words)'
""",
}  # fmt: skip


def add_completion(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow completion`` to the program."""
    parser = commands.add_parser(
        "completion",
        help="let bash, zsh or fish complete commands, options and names",
        description='Print what a shell needs to complete words. In ~/.bashrc: eval "$(skisnow completion bash)"; in '
        '~/.zshrc: eval "$(skisnow completion zsh)"; in ~/.config/fish/config.fish: skisnow completion fish | source.',
    )
    parser.add_argument(
        "shell", choices=(*SHELLS, WORDS), help="words: what the last WORD may become; shells ask for it"
    )
    parser.add_argument("given", nargs=argparse.REMAINDER, metavar="WORD", help="words of the command line so far")
    parser.set_defaults(run=print_completion)


def print_completion(options: argparse.Namespace) -> int:
    """Print the completion script of a shell, or the words that can come next on a command line."""
    if options.shell != WORDS:
        print(_SCRIPTS[options.shell], end="")
        return 0
    words = options.given[1:] if options.given[:1] == ["--"] else options.given
    print("\n".join(candidates(options.program, words[:-1], (words or [""])[-1])))
    return 0


def candidates(parser: argparse.ArgumentParser, words: Sequence[str], begun: str) -> list[str]:
    """Words that can complete `begun` after other words, options if it begins with -; [] for a file or a number."""
    waiting: argparse.Action | None = None
    places = _positionals(parser)
    for word in words:
        option = parser._option_string_actions.get(word)
        if waiting is not None:
            waiting = None
        elif option is not None:
            waiting = option if option.nargs != 0 else None
        elif places and isinstance(places[0], argparse._SubParsersAction):
            if word not in places[0].choices:
                return []
            parser = places[0].choices[word]
            places = _positionals(parser)
        elif places and not word.startswith("-") and places[0].nargs not in ("+", "*"):
            places = places[1:]
    if waiting is not None:
        return _values(waiting)
    return _values(places[0]) if places and not begun.startswith("-") else _options(parser, words)


def _positionals(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    """Positional arguments of a parser."""
    return [action for action in parser._actions if not action.option_strings]


def _options(parser: argparse.ArgumentParser, words: Iterable[str]) -> list[str]:
    """Long names of a parser's options that are not among the words, or can be repeated."""
    there = set(words)
    several = argparse._AppendAction
    actions = [
        action for action in parser._actions if isinstance(action, several) or not there & set(action.option_strings)
    ]
    return [name for action in actions for name in action.option_strings if name.startswith("--")]


def _values(action: argparse.Action) -> list[str]:
    """Choices of an option or argument, or built-in skis, scenarios, snows or scenario keys; [] for others."""
    if action.choices is not None:
        return list(map(str, action.choices))
    if action.dest == "ski":
        from ..ski import ski_names as names
    elif action.dest == "scenario":
        from ..scenario import scenario_names as names
    elif action.dest == "published":
        from ..snow import published_names as names
    elif action.dest == "changes":
        from ..scenario.keys import SCENARIO_KEYS

        return [f"{name}=" for name in SCENARIO_KEYS]
    else:
        return []
    return list(names())


def add_man(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow man`` to the program."""
    about = "Print the manual page: skisnow man > ~/.local/share/man/man1/skisnow.1; then man skisnow."
    parser = commands.add_parser("man", help="print the manual page, made of these helps", description=about)
    parser.set_defaults(run=print_manual)


def print_manual(options: argparse.Namespace) -> int:
    """Print the manual page of the program in roff."""
    from importlib.metadata import version

    print(manual_page(options.program, version("skisnow")), end="")
    return 0


def manual_page(parser: argparse.ArgumentParser, version: str) -> str:
    """Manual page in roff (section 1) with the help of each command."""
    lines = [
        f'.TH SKISNOW 1 "" "skisnow {_text(version)}" "User commands"',
        ".SH NAME",
        f"skisnow \\- {_text((parser.description or '').rstrip('.'))}",
        ".SH COMMANDS",
        *_help_lines(parser),
        ".SH EXIT STATUS",
        "0: done. 1: the data or the machine refused, with a sentence on standard error. 2: wrong words. 70: an error",
        "that was not foreseen. 130: interrupted.",
        ".SH SEE ALSO",
        "docs/files/command\\-line.md in the repository says more, with every default and unit.",
    ]
    return "\n".join(lines) + "\n"


def _help_lines(parser: argparse.ArgumentParser) -> Iterator[str]:
    """Lines in roff with the help of a command, then of its subcommands, each below its name."""
    parser.formatter_class = partial(argparse.HelpFormatter, width=78)
    yield from (f".SS {_text(parser.prog)}", ".nf", *map(_text, parser.format_help().splitlines()), ".fi")
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command in action.choices.values():
                yield from _help_lines(command)


def _text(text: str) -> str:
    """Text with characters escaped that are commands in roff."""
    escaped = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^(?=[.'])", r"\\&", escaped)


INPUTS: Final = ("campaign", "scenario")
OUTPUTS: Final = {
    "carve": "carving",
    "check": "campaign",
    "compare": "track",
    "identification": "identification",
    "results": "estimation",
    "summary": "simulation",
    "track": "track",
    "turn": "report",
}
"""Package that has the schema of each output; the keys of inputs in it come from their declarations."""
MOST_BYTES: Final = 1 << 20
NAMES: Final = (*INPUTS, *OUTPUTS)


def add_schema(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow schema`` to the program."""
    parser = commands.add_parser(
        "schema",
        help="the JSON Schema of campaign.toml, of a scenario, or of the JSON of a command",
        description="Print a JSON Schema: of a parsed campaign.toml or scenario, or of the JSON that a command writes.",
    )
    parser.add_argument("name", choices=NAMES, metavar="NAME", help=f"one of {', '.join(NAMES)}")
    parser.set_defaults(run=print_schema)


def print_schema(options: argparse.Namespace) -> int:
    """Print the JSON Schema whose name the command states."""
    from ..parameters.json_schema import schema_text

    print(schema_text(json_schema(options.name)), end="")
    return 0


def json_schema(name: str) -> Schema:
    """JSON Schema of an input or output of skisnow by its name, one of `NAMES`."""
    from .._support.user_files.json_text import read_json
    from ..campaign.reading.campaign_file import campaign_schema
    from ..carving.question import CARVE_KEYS
    from ..parameters.json_schema import output_schema
    from ..scenario.schema import output_scenario_schema, scenario_schema

    if name in INPUTS:
        return campaign_schema() if name == "campaign" else scenario_schema()
    place = files("skisnow") / OUTPUTS[name] / "schemas" / f"{name}.schema.json"
    schema: Schema = read_json(Path(str(place)), most_bytes=MOST_BYTES)
    if name == "summary":
        schema["properties"]["scenario"] = output_scenario_schema()
    elif name == "carve":
        schema["$defs"]["answer"]["properties"]["inputs"] |= output_schema(CARVE_KEYS.values())
    return schema
