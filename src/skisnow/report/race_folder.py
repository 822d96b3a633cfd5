"""What a race leaves: race.json, line.csv, evaluations.csv, figures, and what was compared."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from ..files import write_file
from ..racing import write_line
from .figures.figure_file import write_figure
from .figures.race_lines import race_lines
from .figures.race_worth import race_worth
from .race_summary import evaluations_csv, race_dict, worth_csv

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..racing import QuickestLine, Score, Worth

SUMMARY = "race.json"


def write_race(
    found: QuickestLine, folder: str | Path, *, checked: Sequence[tuple[str, Score]] = (), worth: Sequence[Worth] = ()
) -> Path:
    """Write it; race.json last, so that what it tells of is there.

    Returns
    -------
    Path
        Of race.json.

    Raises
    ------
    OutputError
        A file cannot be written.
    """
    folder = Path(folder)
    write_line(found.line, folder / "line.csv")
    write_file(folder / "evaluations.csv", evaluations_csv(found))
    write_figure(folder / "lines.png", lambda: race_lines(found))
    if worth:
        write_file(folder / "worth.csv", worth_csv(worth))
        write_figure(folder / "worth.png", lambda: race_worth(worth))
    contents = race_dict(found, checked, worth)
    text = json.dumps(contents, ensure_ascii=False, allow_nan=False, indent=1)
    write_file(folder / SUMMARY, f"{text}\n")
    return folder / SUMMARY
