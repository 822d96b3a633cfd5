"""Draw the chart of the benchmarks from the tables of their page: python docs/figure_of_benchmarks.py."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from skisnow.report.figures.style import BLUE, DOUBLE_MM, VERMILLION, journal_style, new_figure

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from matplotlib.figure import Figure

DOCS: Final = Path(__file__).resolve().parent
PICTURE: Final = DOCS / "_static" / "benchmarks.png"
AMOUNT: Final = re.compile(r"^([\d.,]+)(?: (ms|s))?\b")
SECONDS: Final = {"ms": 1e-3, "s": 1.0, None: 1.0}
SPEEDS: Final = ("times real time", "simulated seconds per second")
"""Of these more is better."""
GOALS: Final = ("goal", "to reach")


@dataclass(frozen=True, slots=True)
class Measured:
    """A row with a goal; its share is below 1 where the goal is reached."""

    what: str
    share: float


def rows(tables: Iterable[str]) -> Iterator[Measured]:
    """Every row of the tables, each the text of a CSV file, that has a measured value and a goal."""
    for table in tables:
        head, *body = csv.reader(table.splitlines())
        places = [n for n, name in enumerate(head) if name.startswith(GOALS)]
        if places:
            yield from _of_table(head, body, places[0])


def _of_table(head: list[str], body: list[list[str]], goal: int) -> Iterator[Measured]:
    """The value is in the column that the goal's heading names, as "to reach (fast)", else in the second."""
    named = re.search(r"\((\w+)\)$", head[goal])
    column = head.index(named[1]) if named and named[1] in head else 1
    for row in body:
        value, aim = _amount(row[column]), _amount(row[goal])
        if value is None or aim is None:
            continue
        speed = head[1] in SPEEDS or row[0].startswith(SPEEDS)
        what = re.sub(r"[*`]", "", row[0].split(";")[0])
        yield Measured(f"turn: {what}" if head[0] == "run" else what, aim / value if speed else value / aim)


def _amount(cell: str) -> float | None:
    """A time in s, a speed, or a size in MB."""
    found = AMOUNT.match(cell)
    return float(found[1].replace(",", "")) * SECONDS[found[2]] if found else None


def page_tables() -> list[str]:
    """Tables of the page in its order."""
    page = (DOCS / "benchmarks.md").read_text(encoding="utf-8")
    return [(DOCS / name).read_text(encoding="utf-8") for name in re.findall(r"^:file: (.+)$", page, re.MULTILINE)]


def chart(measured: list[Measured]) -> Figure:
    """A bar for each, from the goal to what was measured."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=4.6 * len(measured) + 14)
    axes = figure.subplots()
    for place, row in enumerate(measured):
        colour = BLUE if row.share <= 1.0 else VERMILLION
        axes.plot([1.0, row.share], [place, place], color=colour, linewidth=2.2, solid_capstyle="butt")
        axes.plot(row.share, place, "o", color=colour)
    axes.axvline(1.0, color="black", linewidth=0.8)
    axes.set_xscale("log")
    ticks = (0.03, 0.1, 0.3, 1, 3, 10)
    axes.set_xticks(ticks, labels=[f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set_yticks(range(len(measured)), labels=[row.what for row in measured], fontsize=6.5)
    axes.invert_yaxis()
    axes.set_xlabel("measured over goal: left of 1 the goal is reached")
    return figure


def main() -> None:
    """Write the picture."""
    with journal_style():
        figure = chart(list(rows(page_tables())))
        figure.savefig(PICTURE, dpi=170)


if __name__ == "__main__":
    main()
