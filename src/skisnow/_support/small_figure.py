"""Small figure as SVG, without a drawing library: what a notebook shows below the table of an object."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from typing import TYPE_CHECKING, Any, Final, NamedTuple

if TYPE_CHECKING:
    from .arrays import FloatArray

WIDTH, HEIGHT, LEFT, BELOW = 360, 150, 60, 34
_COLOURS: Final = ("#0072B2", "#D55E00", "#009E73")
MOST_POINTS: Final = 300


class SmallFigure(NamedTuple):
    """Lines (x, y) with the labels of both axes; `equal`: one scale along both axes; `points`: marks, not lines."""

    x_label: str
    y_label: str
    lines: Iterable[tuple[Any, Any]]
    equal: bool = False
    points: bool = False

    def svg(self) -> str:
        """The figure as SVG; "" without a finite point."""
        import numpy as np  # the commands' help starts without it

        lines = [np.column_stack([x, y]).astype(float) for x, y in self.lines]
        lines = [line[np.isfinite(line).all(axis=1)] for line in lines]
        every = np.concatenate([line for line in lines if len(line)] or [np.empty((0, 2))])
        if not len(every):
            return ""
        low, high = every.min(axis=0), every.max(axis=0)
        room = np.array([WIDTH - LEFT - 10.0, HEIGHT - BELOW - 10.0])
        extent = np.where(high - low > 1e-9 * np.maximum(np.abs(high), 1e-9), high - low, 1.0)
        scale = room / extent
        shown = [np.where(np.abs(end) < 1e-3 * extent, 0.0, end).tolist() for end in (low, high)]
        if self.equal:
            scale[:] = scale.min()
        drawn = "".join(
            self._drawn((line - low) * scale, _COLOURS[place % len(_COLOURS)]) for place, line in enumerate(lines)
        )
        right = WIDTH - 10
        texts = [
            (LEFT, HEIGHT - 20, "start", f"{shown[0][0]:.4g}"), (right, HEIGHT - 20, "end", f"{shown[1][0]:.4g}"),
            ((LEFT + right) / 2, HEIGHT - 6, "middle", self.x_label),
            (LEFT - 4, HEIGHT - BELOW, "end", f"{shown[0][1]:.4g}"),
            (LEFT - 4, HEIGHT - BELOW - (high[1] - low[1]) * scale[1] + 8, "end", f"{shown[1][1]:.4g}"),
        ]  # fmt: skip
        words = "".join(
            f'<text x="{x:.0f}" y="{y:.0f}" text-anchor="{at}">{escape(text)}</text>' for x, y, at, text in texts
        )
        turned = f'<text transform="translate(12 {(HEIGHT - BELOW + 10) / 2}) rotate(-90)" text-anchor="middle">'
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" role="img" '
            f'font-family="sans-serif" font-size="10"><path d="M{LEFT} 10V{HEIGHT - BELOW}H{right}" fill="none" '
            f'stroke="#888"/>{drawn}{words}{turned}{escape(self.y_label)}</text></svg>'
        )

    def _drawn(self, line: FloatArray, colour: str) -> str:
        step = max(1, -(-len(line) // MOST_POINTS))
        places = [(LEFT + x, HEIGHT - BELOW - y) for x, y in line[::step].tolist()]
        if self.points:
            return "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="1.5" fill="{colour}"/>' for x, y in places)
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
        return f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.4"/>'
