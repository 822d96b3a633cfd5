"""The whole program with machine code of its own: an edit is seen, damage is repaired, and the bits stay the same."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import pytest

from skisnow.machine_code import PACKAGE

from ..test_machine_code import DAMAGES, Damage

pytestmark = pytest.mark.slow
RUN = ("simulate", "carved-46m", "--set", "run.duration_s=0.3", "--json")
CARVE = (
    "carve", "--ski", "slalom", "--edge-angle-deg", "45", "--load-N", "800", "--H-V-N-per-mm3", "0.2",
    "--S-f-N-per-mm2", "0.35", "--unloading-ratio", "10", "--json",
)  # fmt: skip


class Program:
    """A copy of the program with a place for its machine code."""

    def __init__(self, folder: Path) -> None:
        self.sources, self.cache = folder / "src" / "skisnow", folder / "cache"
        shutil.copytree(PACKAGE, self.sources, ignore=shutil.ignore_patterns("__pycache__"))
        self.environment = os.environ | {"PYTHONPATH": str(folder / "src"), "NUMBA_CACHE_DIR": str(self.cache)}

    def start(self, *words: str) -> subprocess.Popen[str]:
        command = (sys.executable, "-m", "skisnow", *words)
        return subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=self.environment
        )

    def told(self, *words: str) -> tuple[str, str]:
        """Digest of what it prints, but for times; and its words on the side."""
        return self.heard(self.start(*words))

    def heard(self, process: subprocess.Popen[str]) -> tuple[str, str]:
        out, err = process.communicate()
        assert process.returncode == 0, err
        lines = [line for line in out.splitlines() if '"wall_s"' not in line and '"time"' not in line]
        return sha256("\n".join(lines).encode()).hexdigest(), err

    def edit(self, file: str, old: str, new: str) -> None:
        text = (self.sources / file).read_text(encoding="utf-8")
        assert text.count(old) == 1
        (self.sources / file).write_text(text.replace(old, new), encoding="utf-8")


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Program:
    return Program(tmp_path_factory.mktemp("program"))


@pytest.fixture(scope="module")
def first(program: Program) -> str:
    """Digest of the run that compiles; another process compiles the same beside it."""
    one, other = program.start(*RUN), program.start(*RUN)
    (found, _), (same, _) = program.heard(one), program.heard(other)
    assert found == same
    return found


@pytest.mark.parametrize("name", ["outputs.advance_outputs-*.nbc", "forces.feel-*.nbc", "made"])
@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_damage_is_repaired_with_a_word(program: Program, first: str, name: str, damage: Damage) -> None:
    (file,) = program.cache.rglob(name)
    file.write_bytes(damage(file.read_bytes()))
    found, word = program.told(*RUN)
    assert found == first
    assert word.count("was damaged and is made anew") == 1
    found, word = program.told(*RUN)
    assert found == first
    assert "damaged" not in word


def test_an_edited_law_changes_the_run(program: Program, first: str) -> None:
    (kept,) = program.cache.glob("*/*-*")
    program.edit("simulate/motion/pressure.py", "force = share *", "force = 1.05 * share *")
    assert program.told(*RUN)[0] != first
    assert not kept.exists()
    program.edit("simulate/motion/pressure.py", "force = 1.05 * share *", "force = share *")
    assert program.told(*RUN)[0] == first


def test_an_edited_pressure_changes_a_carve(program: Program) -> None:
    """What is edited is called by what is called from Python."""
    found, _ = program.told(*CARVE)
    assert program.told(*CARVE)[0] == found
    program.edit("simulate/contact/strip.py", "force = 0.5 * h", "force = 0.55 * h")
    assert program.told(*CARVE)[0] != found
