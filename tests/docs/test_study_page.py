"""The section about many computers: its job script and its files are such as they are taken."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from skisnow.cli import build_parser
from skisnow.studies import Shard

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "how-to" / "study.md").read_text(encoding="utf-8")
SECTION = PAGE.partition("\n## Many computers\n")[2]


def blocks(language: str) -> list[str]:
    return [part.split("```")[0] for part in SECTION.split(f"```{language}\n")[1:]]


def test_job_script_asks_for_each_part_once() -> None:
    (script,) = blocks("bash")
    options = dict(re.findall(r"^#SBATCH --([a-z-]+)=(\S+)$", script, re.MULTILINE))
    assert set(options) == {"job-name", "array", "ntasks", "cpus-per-task", "mem", "time"}
    first, last = map(int, options["array"].split("-"))
    (command,) = [line for line in script.splitlines() if line.startswith("skisnow")]
    words = []
    for number in range(first, last + 1):
        line = command.replace("$SLURM_ARRAY_TASK_ID", str(number)).replace("$SLURM_CPUS_PER_TASK", "16")
        asked = build_parser().parse_args(line.replace('"', "").split()[1:])
        assert asked.workers == int(options["cpus-per-task"])
        words.append(Shard.of(asked.shard))
    numbers = sorted(number for shard in words for number in shard.points(1000))
    assert numbers == list(range(1000))


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash")
def test_job_script_is_one_of_bash() -> None:
    (script,) = blocks("bash")
    assert subprocess.run(["bash", "-n"], input=script.encode(), check=False).returncode == 0


def test_commands_of_the_page_are_taken() -> None:
    commands = [line for block in blocks("") for line in block.splitlines() if line.startswith("skisnow ")]
    assert len(commands) == 2
    for line in commands:
        assert build_parser().parse_args(line.split()[1:]).run
