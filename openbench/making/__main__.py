"""All that stands in ``v1``, made anew.

``cases`` writes the cases, ``exact`` the exact answers, ``twins`` runs both programs at their finest and writes theirs,
with sensitivities (minutes), ``measured DATA`` that of the sand, ``drawings`` draws, ``pages`` writes the pages.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from .. import CASES
from ..running import Asked, run
from . import answers
from .cases import CASES as MAKERS
from .exact import EXACT

FINEST = {
    "skisnow-finest": [sys.executable, "-m", "openbench.entries.skisnow", "--finest"],
    "numpy-finest": [sys.executable, "-m", "openbench.entries.numpy_reference", "--finest"],
}
TWIN_CASES = ("06-carve", "07-turn")
LIMIT_S = 7200.0
"""A busy machine takes its time."""


def main() -> None:
    """One part of the set."""
    parser = argparse.ArgumentParser(prog="python -m openbench.making", description=__doc__)
    parser.add_argument("part", choices=("cases", "exact", "twins", "measured", "drawings", "pages"))
    parser.add_argument("folder", type=Path, nargs="?", help="of the runs of the twins; of the data of the sand")
    asked = parser.parse_args()
    if asked.part == "cases":
        for make in MAKERS:
            write_case(make())
    elif asked.part == "exact":
        for name in EXACT:
            answers.write(name, answers.exact(name))
    elif asked.part == "measured":
        answers.write("05-sand", answers.measured(asked.folder))
    elif asked.part == "drawings":
        from .drawings import draw_all

        draw_all()
    elif asked.part == "pages":
        from .pages import write_all

        write_all()
    else:
        twins(asked.folder or Path("openbench-twins"))


def write_case(case: dict[str, object]) -> None:
    """Into its folder."""
    folder = CASES / str(case["case"])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "case.json").write_text(json.dumps(case, indent=1) + "\n", encoding="utf-8")


def twins(runs: Path) -> None:
    """Run what is not there yet, then write the answers."""
    from .sensitivity import sensitivities

    for name, command in FINEST.items():
        if not (runs / name / "run.json").exists():
            run(name, command, runs, Asked(TWIN_CASES, limit_s=LIMIT_S))
    for case in TWIN_CASES:
        answers.write(case, answers.twin(case, runs, sensitivities(runs) if case == "07-turn" else None))


if __name__ == "__main__":
    main()
