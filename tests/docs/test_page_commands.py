"""The commands of all pages run as printed, from an empty folder."""

import os
import re
import shutil
import signal
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

import pytest

from .page_commands import FIRST_WORDS, PACKAGES, PAGES, REASONS, ROOT, Block, blocks

SHELL = ["bash", "-euo", "pipefail", "-c"]


def test_few_blocks_are_marked_and_each_has_a_known_reason_and_every_command_is_in_a_fenced_block() -> None:
    marks = [block.mark for page in PAGES for block in blocks(page) if block.mark]
    assert len(marks) <= 10
    assert set(marks) <= REASONS | PACKAGES
    for page in PAGES:
        indented = re.findall(r"^    \S.*$", (ROOT / page).read_text(encoding="utf-8"), re.MULTILINE)
        fenced = "".join(block.text for block in blocks(page))
        assert [line for line in indented if line.strip().startswith(FIRST_WORDS) and line not in fenced] == [], page


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="needs bash")
@pytest.mark.parametrize("page", [page for page in PAGES if any(not block.is_doctest for block in blocks(page))])
def test_the_commands_of_a_page_run(page: str, tmp_path: Path) -> None:
    tools = tmp_path / "bin"
    tools.mkdir()
    for name, module in (("skisnow", "-m skisnow "), ("python", "")):
        tool = tools / name
        tool.write_text(f'#!/bin/sh\nexec "{sys.executable}" {module}"$@"\n', encoding="utf-8")
        tool.chmod(0o755)
    own = {"XDG_DATA_HOME": str(tmp_path / "data"), "XDG_STATE_HOME": str(tmp_path / "state"), "COLUMNS": "200"}
    environment = os.environ | own | {"PATH": f"{tools}{os.pathsep}{os.environ['PATH']}"}
    folder = tmp_path / "folder"
    folder.mkdir()
    for part in ("examples", "openbench"):  # copies: a study writes its table next to its file
        shutil.copytree(ROOT / part, folder / part)
    doctests = [block for block in blocks(page) if block.is_doctest]
    for block in blocks(page):
        if block.is_run and block not in doctests[1:]:
            _run(block, folder, environment, page)


def _run(block: Block, folder: Path, environment: dict[str, str], page: str) -> None:
    if block.is_doctest:  # all of the page at once, since later ones use the names of earlier ones
        steps = [[sys.executable, "-m", "doctest", "-o", "NORMALIZE_WHITESPACE", str(ROOT / page)]]
    elif block.language == "python":
        steps = [[sys.executable, "-c", block.text]]
    elif array := re.search(r"#SBATCH --array=(\d+)-(\d+)", block.text):
        first, last = map(int, array.groups())
        job = "export SLURM_CPUS_PER_TASK=2; for SLURM_ARRAY_TASK_ID in $(seq {} {}); do\n{}\ndone"
        steps = [[*SHELL, job.format(first, last, block.text)]]
    else:
        steps = [[*SHELL, command] for command in _commands(block.text)]
    for step in steps:
        if step[-1].startswith("skisnow serve"):
            _serve(step, folder, environment)
            continue
        done = subprocess.run(step, cwd=folder, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, f"{page}, line {block.line}: {step[-1]}\n{done.stdout[-2000:]}\n{done.stderr}"


def _commands(text: str) -> list[str]:
    """Each command of a block, without the path of the environment."""
    lines = text.replace("\\\n", " ").splitlines()
    return [line.removeprefix(".venv/bin/") for line in lines if line.strip()]


def _serve(step: list[str], folder: Path, environment: dict[str, str]) -> None:
    """Start the web lab on a free port, open its first page, and end it as Ctrl-C does."""
    command = [*step[:-1], f"exec {step[-1].partition('  #')[0]} --port 0"]
    with subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as lab:
        assert lab.stdout is not None
        try:
            address = next(match[0] for line in lab.stdout if (match := re.search(r"http://\S+", line)))
            assert _status(address) == (401 if "--token" in step[-1] else 200)
        finally:
            lab.send_signal(signal.SIGINT)
        assert lab.wait(timeout=60) in (0, 130)


def _status(address: str) -> int:
    """HTTP status of a page: 401 without the token of a lab that asks for one."""
    try:
        with urllib.request.urlopen(address, timeout=60) as answer:
            return int(answer.status)
    except urllib.error.HTTPError as error:
        return error.code
