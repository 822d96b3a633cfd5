"""How charts look: the ink, the axes, one colour for each of two skis."""

from __future__ import annotations

from typing import Any, Final

INK: Final = "#14181c"
GRID: Final = "#d8dee4"
COLOURS: Final = ("#0b4f8a", "#b3450b")
DASHES: Final = ("solid", "dash")


def axis(title: str, **further: Any) -> dict[str, Any]:
    """An axis with its name and unit; nothing zooms by accident."""
    look = {"fixedrange": True, "gridcolor": GRID, "linecolor": INK, "zerolinecolor": "#8b96a1", "ticks": "outside"}
    return {**look, "title": {"text": title, "standoff": 8}, **further}


def chart(data: list[dict[str, Any]], x: dict[str, Any], y: dict[str, Any], *, height: int = 230) -> dict[str, Any]:
    """A figure of one panel for the drawing library."""
    return {
        "data": data,
        "layout": {
            "xaxis": x,
            "yaxis": y,
            "margin": {"l": 70, "r": 10, "t": 8, "b": 44},
            "font": {"size": 14, "color": INK},
            "showlegend": False,
            "height": height,
            "hovermode": "closest",
        },
        "config": {"displayModeBar": False, "responsive": True},
    }


def line(x: Any, y: Any, number: int) -> dict[str, Any]:
    """A line in the look of the first or second of two."""
    look = {"color": COLOURS[number], "width": 2.5, "dash": DASHES[number]}
    return {"type": "scatter", "mode": "lines", "x": x, "y": y, "line": look, "hoverinfo": "x+y"}
