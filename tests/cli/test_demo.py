"""The commands of `make demo` print no warning."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from skisnow.cli import main

MAKEFILE = Path(__file__).parents[2] / "Makefile"
REDUCED = {
    "analyse": ["--resamples", "100"],
    "turn": ["--runs", "3", "--workers", "1", "--set", "run.duration_s=0.5"],
    "simulate": ["--set", "run.duration_s=0.5"],
}
"""Further options with which each command is quick."""


def commands(folder: Path) -> list[list[str]]:
    """Arguments of the commands of the demo, with its own settings."""
    text = MAKEFILE.read_text(encoding="utf-8")
    turn = re.search(r"^TURN := (.*)$", text, re.MULTILINE)
    recipe = re.search(r"^demo:.*\n((?:\t.*\n)+)", text, re.MULTILINE)
    assert turn is not None
    assert recipe is not None
    lines = re.findall(r"^\t\$\(BIN\)/skisnow (.*)$", recipe[1], re.MULTILINE)
    values = {"DEMO": str(folder), "SEED": "1", "TURN": turn[1]}
    return [shlex.split(re.sub(r"\$\((\w+)\)", lambda found: values[found[1]], line)) for line in lines]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("reduced", [True, pytest.param(False, marks=pytest.mark.slow)])
def test_the_demo_prints_no_warning(
    reduced: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str], request: pytest.FixtureRequest
) -> None:
    if reduced:
        request.getfixturevalue("undrawn")
    found = commands(tmp_path / "demo")
    assert [arguments[0] for arguments in found] == ["reference", "analyse", "turn", "simulate"]
    for arguments in found:
        status = main([*arguments, *(REDUCED.get(arguments[0], []) if reduced else [])])
        said = capsys.readouterr()
        # the reduced slalom passes no gate, which is the outcome of its length
        assert status == 0 or (reduced and arguments[0] == "simulate")
        assert "warning" not in (said.out + said.err).lower()
