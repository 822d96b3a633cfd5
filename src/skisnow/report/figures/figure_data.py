"""Data of a figure as CSV: one row for each point, corner of an area, bar or cell of a map that the figure shows."""

from __future__ import annotations

import re
from collections.abc import Iterator
from string import ascii_lowercase
from typing import Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import LineCollection, PathCollection, PolyCollection, QuadMesh
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import FixedLocator

from ..._support.arrays import FloatArray
from ..._support.spreadsheet_text import csv_text

COLUMNS: Final = ("panel", "x_axis", "y_axis", "series", "point", "x", "y", "value")
"""Panel, its axes with units, name or number of the series, number of the point, coordinates, value of the colour."""
MOST_CELLS: Final = 20_000
_COLOUR_BAR: Final = "<colorbar>"


def figure_data(figure: Figure) -> str:
    """Data that a figure shows, as CSV with the columns of `COLUMNS`.

    Points are those drawn, also of a thinned cloud; of a map with more than `MOST_CELLS` cells, each k-th point.
    Lines through a whole panel and texts are not included.
    """
    rows: list[tuple[str, ...]] = [COLUMNS]
    panels = [axes for axes in figure.axes if axes.get_visible() and axes.get_label() != _COLOUR_BAR]
    names = _names_of_legends(figure)
    for place, axes in enumerate(panels):
        letter = ascii_lowercase[place % len(ascii_lowercase)] if len(panels) > 1 else ""
        head = (letter, _label(axes, "x"), _label(axes, "y"))
        ticks: list[dict[float, str]] = [_named_ticks(axes.xaxis), _named_ticks(axes.yaxis), {}]
        number = 0
        for artist in axes.get_children():
            points = _points(artist, axes)
            if not len(points):
                continue
            number += 1
            series = _series(artist, axes, names) or str(number)
            step = -(-len(points) // MOST_CELLS)
            columns = [_value_texts(values[::step], names) for values, names in zip(points.T, ticks, strict=True)]
            numbers = (str(point) for point in range(1, len(points) + 1, step))
            rows += [(*head, series, *cells) for cells in zip(numbers, *columns, strict=True)]
    return csv_text(rows)


def _label(axes: Axes, which: str) -> str:
    """Label of an axis, which only one of the panels with a shared axis may have."""
    shared = axes.get_shared_x_axes() if which == "x" else axes.get_shared_y_axes()
    texts = (getattr(panel, f"get_{which}label")() for panel in (axes, *shared.get_siblings(axes)))
    return " ".join(next(filter(None, texts), "").split())


def _names_of_legends(figure: Figure) -> dict[tuple[str, str], str]:
    """Names in legends by colour and marker of their lines."""
    legends = [*figure.legends, *(legend for axes in figure.axes if (legend := axes.get_legend()) is not None)]
    return {
        _line_style(handle): text.get_text()
        for legend in legends
        for handle, text in zip(legend.legend_handles, legend.get_texts(), strict=True)
        if isinstance(handle, Line2D)
    }


def _line_style(line: Line2D) -> tuple[str, str]:
    """Colour as hexadecimal text, and marker of a line."""
    return to_hex(line.get_color()), str(line.get_marker())


def _series(artist: Artist, axes: Axes, names: dict[tuple[str, str], str]) -> str:
    """Name of a series: its label, that of its style in a legend, or of the colour bar; "" without one."""
    label = str(artist.get_label())
    if label and not label.startswith("_"):
        return label
    if isinstance(artist, Line2D):
        return names.get(_line_style(artist), "")
    if isinstance(artist, QuadMesh):
        bars = [bar for bar in axes.figure.axes if bar.get_label() == _COLOUR_BAR]
        return next((bar.get_ylabel() for bar in bars if axes in getattr(bar, "_colorbar_info")["parents"]), "")  # noqa: B009
    return ""


def _points(artist: Artist, axes: Axes) -> FloatArray:
    """Coordinates and values of the colour, shape (n, 3), NaN without one; (0, 3) for an artist without data."""
    parts = [np.asarray(part, float).reshape(-1, 2) for part in _coordinates(artist, axes) if artist.get_visible()]
    places = np.concatenate(parts) if parts else np.empty((0, 2))
    values = artist.get_array() if isinstance(artist, PathCollection | QuadMesh | LineCollection) else None
    colours = np.full(len(places), np.nan)
    if values is not None:
        numbers: FloatArray = np.ma.filled(np.ma.asarray(values, float).ravel(), np.nan)
        colours = np.repeat(numbers, [len(part) for part in parts]) if len(parts) == numbers.size else numbers
    points = np.column_stack([places, colours[: len(places)]])
    return points[np.isfinite(points[:, 2 if isinstance(artist, QuadMesh) else 0])]


def _coordinates(artist: Artist, axes: Axes) -> Iterator[object]:
    """Coordinates (n, 2) of what an artist draws in units of the data; none for other artists."""
    if isinstance(artist, Line2D):
        if artist.get_transform() == axes.transData:  # not a line through the whole panel
            yield artist.get_xydata()
    elif isinstance(artist, PathCollection):
        yield np.ma.filled(artist.get_offsets(), np.nan)
    elif isinstance(artist, QuadMesh):
        corners = np.asarray(artist.get_coordinates(), float)
        yield (corners[:-1, :-1] + corners[1:, 1:]) / 2.0
    elif isinstance(artist, LineCollection):
        yield from artist.get_segments()
    elif isinstance(artist, PolyCollection):
        yield from (path.vertices for path in artist.get_paths())
    elif isinstance(artist, Rectangle) and artist in axes.patches:
        yield (artist.get_x() + artist.get_width() / 2.0, artist.get_y() + artist.get_height())


def _named_ticks(axis: Axis) -> dict[float, str]:
    """Names of places on an axis whose ticks are words, such as sites."""
    if not isinstance(axis.get_major_locator(), FixedLocator):
        return {}
    places = [float(place) for place in axis.get_majorticklocs()]
    names = dict(zip(places, axis.get_major_formatter().format_ticks(places), strict=True))
    return names if any(any(map(str.isalpha, re.sub(r"\$.*?\$", "", name))) for name in names.values()) else {}


def _value_texts(values: FloatArray, names: dict[float, str]) -> list[str]:
    """Texts of values with seven digits, "" for NaN, or the name of the nearest tick if there are names."""
    if names:
        return [names[min(names, key=lambda tick: abs(tick - value))] for value in values.tolist()]
    return ["" if np.isnan(value) else f"{value:.7g}" for value in values.tolist()]
