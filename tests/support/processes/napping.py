"""A batch whose points only wait; `python -m tests.support.processes.napping FOLDER SCHEDULER POINTS` goes on.

What is kept is noted in `FOLDER/kept.txt` once `add` has returned: those rows no kill may lose.
"""

import sys
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from skisnow._support.errors import SkisnowError
from skisnow._support.processes.batch import compute_missing
from skisnow._support.processes.kept_rows import KeptRows, NumberedText

NAP_S = 0.02
LOST = 3
"""The exit code where the scheduler was lost."""


def nap(point: int) -> dict[str, Any]:
    """A row after a while."""
    time.sleep(NAP_S)
    return {"square": point * point}


class NotedRows(KeptRows):
    """Rows of which a file tells that they were kept."""

    noted: Path

    def add(self, rows: Iterable[NumberedText]) -> int:
        """Keep them, then note their numbers in one piece."""
        new = list(rows)
        count = super().add(new)
        with self.noted.open("a", encoding="utf-8") as file:
            file.write("".join(f"{number}\n" for number, _ in new))
        return count


def main(folder: Path, scheduler: str, points: int) -> int:
    """Compute what is missing."""
    kept = NotedRows.opened(folder / "rows", "naps")
    kept.noted = folder / "kept.txt"
    try:
        compute_missing(range(points), nap, kept, executor=scheduler)
    except SkisnowError as error:
        print(error, file=sys.stderr)
        return LOST
    finally:
        kept.close()
    return 0


if __name__ == "__main__":
    from tests.support.processes.napping import main  # whose function has a name that workers know

    sys.exit(main(Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])))
