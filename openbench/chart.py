"""Error against cost as a picture: a panel for each case, a mark for each program."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from .scoring import Score

MARKS: Final = ("o", "s", "^", "D", "v", "P", "X", "*", "<", ">")
EXACT: Final = 1e-7
"""What is nearer than this is drawn here, as exact (per cent)."""


def draw(scores: Sequence[Score], path: Path) -> None:
    """A panel for each case; logarithmic both ways; the grey band is the answer's own uncertainty."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt
    from matplotlib.lines import Line2D

    cases = sorted({each.case for each in scores})
    programs = list(dict.fromkeys(each.program for each in scores))
    columns = 4
    rows = -(-len(cases) // columns)
    figure, panels = plt.subplots(rows, columns, figsize=(12.0, 3.2 * rows + 0.6), squeeze=False)
    for panel, case in zip(panels.flat, cases, strict=False):
        _panel(panel, case, [each for each in scores if each.case == case and each.error is not None], programs)
    for panel in panels.flat[len(cases) :]:
        panel.axis("off")
    colours = [f"C{i % 10}" for i in range(len(programs))]
    handles = [
        Line2D([], [], linestyle="", marker=MARKS[i % len(MARKS)], color=colours[i], label=name)
        for i, name in enumerate(programs)
    ]
    figure.legend(handles=handles, loc="lower center", ncols=min(8, len(programs)), frameon=False)
    figure.supxlabel("cost (CPU time over that of the calibration loop)", y=0.075, fontsize=10)
    figure.supylabel("error (% of the answer's scale)", fontsize=10)
    figure.tight_layout(rect=(0.01, 0.09, 1.0, 1.0))
    figure.savefig(path, dpi=110)
    plt.close(figure)


def _panel(panel: Any, case: str, scores: Sequence[Score], programs: list[str]) -> None:
    panel.set(title=case, xscale="log", yscale="log", ylim=(EXACT / 3.0, 400.0), xlim=(0.01, 3e3))
    panel.title.set_fontsize(10)
    panel.grid(alpha=0.3, linewidth=0.5)
    panel.axhspan(EXACT / 3.0, EXACT * 3.0, color="0.93", linewidth=0)
    for each in scores:
        number = programs.index(each.program)
        assert each.error is not None
        if each.floor * 100.0 > EXACT:
            panel.axhspan(EXACT / 3.0, each.floor * 100.0, color="0.88", linewidth=0, zorder=0)
        error = max(100.0 * each.error, EXACT)
        panel.plot(each.cost, error, MARKS[number % len(MARKS)], color=f"C{number % 10}", markersize=7, alpha=0.85)
    panel.text(0.97, 0.03, "exact", transform=panel.transAxes, ha="right", va="bottom", fontsize=8, color="0.4")
