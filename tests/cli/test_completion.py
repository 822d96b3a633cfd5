"""Completion in the shells, the manual page, numbers of options, and progress."""

import argparse
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from skisnow.cli import build_parser
from skisnow.cli.options import number
from skisnow.cli.output import Progress
from skisnow.cli.shell import candidates, manual_page

from ..docs.page_text import page_text


def after(*words: str) -> list[str]:
    return candidates(build_parser(), words[:-1], words[-1])


def test_commands_options_and_names() -> None:
    assert {"new", "check", "simulate", "carve"} <= set(after(""))
    assert after("--") == ["--help", "--version"]
    assert after("store", "") == ["add", "list", "show", "export", "verify", "sync"]
    assert set(after("store", "list", "--")) == {"--help", "--store", "--json"}
    assert "carved-46m" in after("simulate", "")
    assert "slalom" in after("carve", "--ski", "")
    assert after("carve", "--groove", "") == ["edge", "path"]
    assert "race-piste" in after("carve", "--published", "")
    assert "snow.S_f_N_per_mm2=" in after("simulate", "carved-46m", "--set", "")


def test_what_is_there_is_not_offered_again_unless_it_may_be() -> None:
    assert "--json" not in after("simulate", "--json", "--")
    assert "--set" in after("simulate", "--set", "mass_kg=80", "--")


@pytest.mark.parametrize("words", [("check", ""), ("carve", "--load-N", ""), ("nonsense", "")])
def test_where_a_file_or_a_number_belongs_nothing_is_offered(words: tuple[str, ...]) -> None:
    assert after(*words) == []


SCRIPTS = {
    "bash": """
eval "$(skisnow completion bash)"
COMP_WORDS=(skisnow simulate carver); COMP_CWORD=2; _skisnow; echo "${COMPREPLY[@]}"
complete -p skisnow
""",
    "zsh": """
compdef() { print -r -- "$@" }
eval "$(skisnow completion zsh)"
compadd() { print -r -- ${(M)${(P)@[-1]}:#carver*} }
words=(skisnow simulate carver); CURRENT=3; _skisnow
""",
    "fish": """
skisnow completion fish | source
complete -C "skisnow simulate carver"
""",
}
SAID = {
    "bash": "carver-42m\ncomplete -o default -F _skisnow skisnow\n",
    "zsh": "_skisnow skisnow\ncarver-42m\n",
    "fish": "carver-42m\n",
}


@pytest.mark.parametrize("shell", list(SCRIPTS))
def test_in_the_shell_itself(shell: str, tmp_path: Path) -> None:
    program = shutil.which(shell)
    if program is None:
        pytest.skip(f"{shell} is not installed")
    command = tmp_path / "skisnow"
    command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m skisnow "$@"\n', encoding="utf-8")
    command.chmod(0o755)
    script = tmp_path / "script"
    script.write_text(SCRIPTS[shell], encoding="utf-8")
    bare = {"bash": ["--norc"], "zsh": ["-f"], "fish": ["--no-config"]}[shell]
    environment = {**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}", "HOME": str(tmp_path)}
    done = subprocess.run(
        [program, *bare, str(script)], check=True, capture_output=True, text=True, encoding="utf-8", env=environment
    )
    assert done.stdout == SAID[shell]
    assert done.stderr == ""


# The manual page


PAGE = manual_page(build_parser(), "0.1.0")


def test_every_command_and_option_is_listed() -> None:
    commands = re.findall(r"^\.SS skisnow (.*)$", PAGE, re.MULTILINE)
    assert {"new campaign", "check", "store verify", "simulate", "serve", "completion"} <= set(commands)
    plain = PAGE.replace("\\-", "-")
    for option in ("--xlsx", "--fall-line-azimuth-deg", "--fit-offset", "--H-V-N-per-mm3"):
        assert option in plain
    assert "0.1 % more" in plain  # the help says %%
    assert "%(" not in plain


def test_roff_takes_every_line() -> None:
    groff = shutil.which("groff")
    if groff is None:
        pytest.skip("groff is not installed")
    done = subprocess.run(
        [groff, "-man", "-Tutf8", "-ww", "-Kutf8"],
        input=PAGE,
        check=True,
        capture_output=True,
        text=True,
        encoding="utf-8",
    )
    assert "SKISNOW(1)" in done.stdout
    assert [line for line in done.stderr.splitlines() if "warning: can't break" not in line] == []


# How words of the command line become numbers


def test_an_end_that_is_not_given_is_open() -> None:
    assert number("N", highest=5.0)("-1e9") == -1e9
    assert number("N", lowest=5.0)("1e9") == 1e9
    assert number("N")("-3.5") == -3.5


def test_ends_are_allowed_but_the_lowest_above_which_it_must_be() -> None:
    within = number("s", lowest=0.0, highest=10.0)
    assert (within("0"), within("10")) == (0.0, 10.0)
    for word in ("-1e-9", "10.1", "nan"):
        with pytest.raises(argparse.ArgumentTypeError, match="from 0 to 10"):
            within(word)
    above = number("s", lowest=0.0, highest=10.0, above=True)
    assert (above("1e-9"), above("10")) == (1e-9, 10.0)
    with pytest.raises(argparse.ArgumentTypeError, match="above 0 to 10"):
        above("0")


@pytest.mark.parametrize(
    ("unit", "word", "told"), [("N", "800 N", "in N, .* 800"), ("", "1,5", r" 1\.5"), ("m", "much", "in m")]
)
def test_what_is_no_number_gets_an_example(unit: str, word: str, told: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match=told):
        number(unit)(word)


# docs/files/command-line.md has every command with every option and choice

SECTIONS = dict(part.split("\n", 1) for part in page_text("files/command-line").split("\n## ")[1:])


def commands(
    parser: argparse.ArgumentParser, words: tuple[str, ...] = ("skisnow",)
) -> Iterator[tuple[str, argparse.Action]]:
    """Each command that does something, with each of its arguments."""
    inner = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    for group in inner:
        for name, command in group.choices.items():
            yield from commands(command, (*words, name))
    if not inner:
        for action in parser._actions:
            yield " ".join(words), action


def test_every_option_and_choice_has_a_row() -> None:
    missing = []
    for command, action in commands(build_parser()):
        if action.help == argparse.SUPPRESS or action.dest == "help":
            continue
        text = SECTIONS[command].replace("\\|", "|")
        words = [
            max(action.option_strings, key=len, default=""),
            *([] if action.metavar else map(str, action.choices or ())),
        ]
        missing += [(command, word) for word in words if word not in text]
    assert missing == []


# Progress: nothing for a second; then one line that is written over, or in a log a line every ten seconds


@pytest.fixture(autouse=True)
def patient() -> None:
    """As its users have it."""


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [100.0]
    monkeypatch.setattr("skisnow.cli.output.time.monotonic", lambda: now[0])
    return now


def said(clock: list[float], *moments: float) -> None:
    with Progress() as progress:
        for moment in moments:
            clock[0] = 100.0 + moment
            progress("x" * (10 - int(moment)))


def test_a_second_of_patience_and_ten_seconds_between(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    said(clock, 0.0, 0.99, 1.0, 5.0, 10.9, 9.0)
    assert capsys.readouterr().err == f"{'x' * 9}\n"
    clock[0] = 200.0
    with Progress() as progress:
        for moment in (0.0, 1.0, 10.9, 11.0, 20.9, 21.0):
            clock[0] = 200.0 + moment
            progress(f"{moment:g}")
    assert capsys.readouterr().err == "1\n11\n21\n"


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Function that writes to a terminal with a number of columns from now on."""

    def make(columns: int) -> None:
        monkeypatch.setattr("sys.stderr.isatty", lambda: True)
        monkeypatch.setenv("COLUMNS", str(columns))

    return make


def test_a_terminal_has_one_line(
    clock: list[float], capsys: pytest.CaptureFixture[str], terminal: Callable[[int], None]
) -> None:
    terminal(80)
    said(clock, 0.9, 1.0, 1.4, 2.0, 3.0)
    assert capsys.readouterr().err == f"\r{'x' * 9}\r{'x' * 8} \r{'x' * 7} \r{' ' * 7}\r"
    said(clock, 0.5)
    assert capsys.readouterr().err == ""


def test_a_line_is_cut(clock: list[float], capsys: pytest.CaptureFixture[str], terminal: Callable[[int], None]) -> None:
    """A line of its whole width would wrap, and the next would leave it standing."""
    terminal(20)
    with Progress() as progress:
        clock[0] += 1.0
        progress("y" * 40)
    assert capsys.readouterr().err == f"\r{'y' * 18}…\r{' ' * 19}\r"


def test_time_to_end(clock: list[float], capsys: pytest.CaptureFixture[str], terminal: Callable[[int], None]) -> None:
    """Two runs in four seconds: the eight that are left take sixteen."""
    terminal(80)
    with Progress() as progress:
        for moment, done in ((1.0, 0), (3.0, 1), (5.0, 2), (22.0, 11)):
            clock[0] = 100.0 + moment
            progress(f"run {done} of 10")
        clock[0] += 1.0
        progress("writing report.html")
    texts = [text.strip() for text in capsys.readouterr().err.split("\r") if text.strip()]
    numbers = [[int(number) for number in re.findall(r"\d+", text)] for text in texts]
    assert numbers == [[0, 10], [1, 10, 18], [2, 10, 16], [11, 10], []]


def test_lines_at_once(clock: list[float], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SKISNOW_PROGRESS_LINES", "1")
    said(clock, 1.0, 1.25, 1.5)
    assert len(capsys.readouterr().err.splitlines()) == 2
