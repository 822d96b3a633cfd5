"""The manual page."""

from __future__ import annotations

import re
import shutil
import subprocess

import pytest

from skisnow.cli import build_parser
from skisnow.cli.shell import manual_page

PAGE = manual_page(build_parser(), "0.1.0")


def test_every_command_and_option_stands_there() -> None:
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
