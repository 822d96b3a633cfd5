"""The programs that are shipped, by name: their commands, and why one cannot run here."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

from .words import OpenbenchError

ENTRIES: Final = Path(__file__).parent / "entries"


def shipped() -> dict[str, Any]:
    """Of each name: command, what it needs, words."""
    listed: dict[str, Any] = json.loads((ENTRIES / "entries.json").read_text(encoding="utf-8"))
    return listed


def why_not(name: str) -> str | None:
    """What an entry needs that is not here; None where it can run."""
    needs = shipped()[name]["needs"]
    if needs == "cc":
        return None if compiler() else f"{name} is left out: no C compiler (cc, gcc, clang) on this machine"
    if needs and find_spec(needs) is None:
        return f"{name} is left out: {needs} is not installed"
    if name == "mujoco" and find_spec("skisnow") is None:
        return f"{name} is left out: skisnow, whose contact it brings into MuJoCo, is not installed"
    return None


def compiler() -> str | None:
    """A C compiler."""
    return next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)


def command_of(name: str, build: Path) -> list[str]:
    """The command of a shipped entry; that in C is compiled into ``build``."""
    if name == "c":
        build.mkdir(parents=True, exist_ok=True)
        found = compiler()
        if found is None:
            raise OpenbenchError(why_not(name) or name)
        source, program = ENTRIES / "in_c.c", build / "openbench_in_c"
        subprocess.run(
            [found, "-O2", "-std=c99", "-Wall", "-Wextra", "-Werror", str(source), "-lm", "-o", str(program)],
            check=True,
        )
    places = {"python": sys.executable, "entries": str(ENTRIES), "compiled": str(build)}
    return [word.format(**places) for word in shipped()[name]["command"]]
