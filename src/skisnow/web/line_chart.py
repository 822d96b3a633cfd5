"""A chart of lines that is light enough to follow a slider: drawn as SVG by a few lines of our own in the browser.

The large drawing library takes half a second of a laptop's browser to be loaded and 20 ms for each chart that changes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

from nicegui.element import Element

from ..report.formatting import significant
from .language import decimal_mark, said

if TYPE_CHECKING:
    from collections.abc import Sequence

DIGITS: Final = 5
STYLES: Final = (
    {"colour": "#0b4f8a", "dash": "", "width": 2.5, "point": 11, "read": True},
    {"colour": "#b3450b", "dash": "7 5", "width": 2.5, "point": 11, "read": True},
    {"colour": "#48525c", "dash": "2 4", "width": 2.5, "point": 11, "read": True},
    {"colour": "#8b96a1", "dash": "", "width": 1, "point": 6, "read": False},
)
"""Colour, dashes, width of a line and of a point in pixels, and whether numbers stand beside the finger or mouse."""
BEHIND: Final = 3
"""The style of what the others are seen against."""


@dataclass(frozen=True, slots=True)
class ChartLine:
    """Values over places, None where there is none, which breaks the line.

    ``style`` 0, 1 or 2: the first, second or a further thing, or `BEHIND`. ``points``: points in place of a line.
    ``name``: what the legend calls it; nothing where it has no entry of its own.
    """

    x: Sequence[float | None]
    y: Sequence[float | None]
    style: int = 0
    points: bool = False
    name: str = ""


class LineChart(Element, component="line_chart.js"):
    """A panel of lines over one quantity.

    Parameters
    ----------
    x, y
        What is along the axes, with the unit.
    words
        What it shows, for who cannot see it; the extent of the values is added.
    height
        In pixels of the page.
    ends
        What the axis along the bottom leads to on the left and on the right.
    """

    def __init__(self, x: str, y: str, words: str, *, height: int = 240, ends: tuple[str, str] = ("", "")) -> None:
        super().__init__()
        self._titles = {"x": said(x), "y": said(y), "ends": [said(each) for each in ends], "mark": decimal_mark()}
        self._words = words
        self._drawn: list[tuple[ChartLine, dict[str, Any]]] = []
        self._props["height"] = height
        self._props["styles"] = STYLES
        self.show([])

    def show(
        self,
        lines: Sequence[ChartLine],
        *,
        range_: tuple[float, float] | None = None,
        from_zero: Literal["", "y", "xy"] = "",
    ) -> None:
        """Draw these lines, the first one undermost.

        ``range_``: values at the lower and the upper end of the axis, else all of them. ``from_zero``: which axes show
        zero whatever the values are.
        """
        self._drawn = [(line, self._plain(line)) for line in lines]
        self._props["panel"] = {
            **self._titles,
            "label": self._label(lines),
            "range": range_,
            "from_zero": from_zero,
            "lines": [plain for _, plain in self._drawn],
        }
        self.update()

    def _plain(self, line: ChartLine) -> dict[str, Any]:
        """As it is sent; what stands there already, such as hundreds of series behind one, is not rounded again."""
        for known, plain in self._drawn:
            if known == line:
                return plain
        plain = {"x": _short(line.x), "y": _short(line.y), "style": line.style, "points": line.points}
        return plain | {"name": said(line.name, self.client)}

    def _label(self, lines: Sequence[ChartLine]) -> str:
        found = [value for line in lines for value in line.y if value is not None and math.isfinite(value)]
        extent = f": {significant(min(found))} to {significant(max(found))}" if found else ": nothing yet"
        names = ", ".join(said(line.name, self.client) for line in lines if line.name)
        return said(self._words + extent, self.client) + (f" ({names})" if names else "")


def _short(values: Sequence[float | None]) -> list[float | None]:
    """To a hundredth of what a screen can show, and a third of the letters on the way to it."""
    known = [abs(value) for value in values if value is not None and math.isfinite(value)]
    if not known or max(known) == 0.0:
        return [None if value is None or not math.isfinite(value) else value for value in values]
    digits = DIGITS - 1 - math.floor(math.log10(max(known)))
    return [None if value is None or not math.isfinite(value) else round(value, digits) for value in values]
