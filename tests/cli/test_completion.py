"""Completion: the words themselves, and the shells where they are installed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from skisnow.cli import build_parser
from skisnow.cli.shell import candidates


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
