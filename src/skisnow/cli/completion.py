"""``skisnow completion``: what a shell needs to complete commands, options and names."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

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


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
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
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the script, or the words."""
    if options.shell != WORDS:
        print(_SCRIPTS[options.shell], end="")
        return 0
    words = options.given[1:] if options.given[:1] == ["--"] else options.given
    print("\n".join(candidates(options.program, words[:-1], (words or [""])[-1])))
    return 0


def candidates(parser: argparse.ArgumentParser, words: Sequence[str], begun: str) -> list[str]:
    """Completions of a word that follows others; empty where a file or a number belongs."""
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
    return [action for action in parser._actions if not action.option_strings]


def _options(parser: argparse.ArgumentParser, words: Iterable[str]) -> list[str]:
    """Long names of options that are not there yet, or may be there several times."""
    there = set(words)
    several = argparse._AppendAction
    actions = [
        action for action in parser._actions if isinstance(action, several) or not there & set(action.option_strings)
    ]
    return [name for action in actions for name in action.option_strings if name.startswith("--")]


def _values(action: argparse.Action) -> list[str]:
    """Choices of an option or an argument, where it can be named."""
    if action.choices is not None:
        return list(map(str, action.choices))
    names = _NAMES.get(action.dest)
    return [] if names is None else names()


def _skis() -> list[str]:
    from ..ski import ski_names

    return list(ski_names())


def _scenarios() -> list[str]:
    from ..scenario import scenario_names

    return list(scenario_names())


def _snows() -> list[str]:
    from ..snow import published_names

    return list(published_names())


def _keys() -> list[str]:
    from ..scenario.keys import SCENARIO_KEYS

    return [f"{name}=" for name in SCENARIO_KEYS]


_NAMES: Final[dict[str, Callable[[], list[str]]]] = {
    "ski": _skis,
    "scenario": _scenarios,
    "published": _snows,
    "changes": _keys,
}
"""Names that are known, by what the option or argument is stored as."""
