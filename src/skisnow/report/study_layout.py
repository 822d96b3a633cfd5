"""Layout of a map of a study: inputs of the axis, the lines and the panels."""

from __future__ import annotations

import itertools
import math
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .._support.errors import ParameterError
from .._support.messages import local_number
from ..carving.question import CARVE_KEYS
from ..studies import StudyTable
from .figures.style import DOUBLE_MM, new_figure
from .formatting import figure_text

Json = dict[str, Any]

MOST_PANELS: Final = 12
MOST_LINES: Final = 7
MOST_COLUMNS: Final = 5
_CROWDED: Final = 4  # columns, from which neighbours' axis labels would touch
_CAPTION_LETTERS: Final = 125  # maximum length of a line of the caption, including the markup of symbols
_LETTERS: Final = 105  # maximum length of a title over the whole width of a figure


@dataclass(frozen=True, slots=True)
class MapLayout:
    """Assignment of a study's varied inputs to the parts of a map.

    x: input of the horizontal axis.
    second: input of the lines of the radius map and of the ordinate of the grip map; None if nothing else varies.
    panels: other inputs, one panel for each combination; of a sample only names and switches.
    sampled: True if the points are a sample instead of a grid.
    """

    x: str
    second: str | None
    panels: tuple[str, ...]
    sampled: bool


def map_layout(table: StudyTable, *, second_is_number: bool) -> MapLayout:
    """Layout of a study's map: edge angle on the axis and load as second input if they vary, else the next number.

    second_is_number: False lets a name or switch be the second input if no other number varies.

    Raises ParameterError: no number varies, or there would be too many panels.
    """
    varied = [name for name in table.varied if len(_distinct(table, name)) > 1]
    numbers = [name for name in varied if all(_is_number(row[name]) for row in table.rows)]
    if not numbers:
        raise ParameterError(
            "the map needs a number that varies, such as edge_angle_deg; only names and switches vary"
        ).tag("nothing_varies")
    x = "edge_angle_deg" if "edge_angle_deg" in numbers else numbers[0]
    others = [name for name in numbers if name != x]
    names = [name for name in varied if name not in numbers]
    second = "load_N" if "load_N" in others else next(iter(others), None)
    if second is None and not second_is_number:
        second = next(iter(names), None)
    sampled = math.prod(len(_distinct(table, name)) for name in varied) != len(table.rows)
    left = [name for name in varied if name not in (x, second) and (name in names or not sampled)]
    count = math.prod(len(_distinct(table, name)) for name in left)
    if count > MOST_PANELS:
        counts = ", ".join(f"{name} with {len(_distinct(table, name))} values" for name in left)
        raise ParameterError(
            "the map would have {count} panels ({counts}); at most {most} are readable. The table is written; make a "
            "study of fewer of them for the map"
        ).tag("too_many_panels", count=count, counts=counts, most=MOST_PANELS)
    return MapLayout(x, second, tuple(left), sampled)


def drawn_table(table: StudyTable) -> StudyTable:
    """Table of only the rows with an answer; the skis have their own names if these are unique.

    Raises ParameterError: no row has an answer.
    """
    rows = table.answers()
    if not rows:
        raise ParameterError("the map is empty: no point of this table could be computed").tag("nothing_to_draw")
    pairs = {(row.get("ski"), row.get("ski_name")) for row in rows}
    names = {name for _, name in pairs}
    if None not in names and len(names) == len(pairs):
        rows = [row | {"ski": row["ski_name"]} for row in rows]
    return StudyTable(table.columns, rows, table.varied)


def _fixed_inputs(table: StudyTable) -> str:
    """Caption of a map with the inputs that are equal in all rows and differ from their defaults; can be empty."""
    words = []
    for name, key in CARVE_KEYS.items():
        values = {row.get(name) for row in table.rows}
        value = next(iter(values))
        if name not in table.varied and len(values) == 1 and value not in (None, key.default):
            words.append(short(name, value))
    return "\n".join(textwrap.wrap(", ".join(words), _CAPTION_LETTERS, break_on_hyphens=False))


def empty_map(
    table: StudyTable, layout: MapLayout, ordinate: str, *, row_mm: tuple[float, float]
) -> tuple[Figure, list[tuple[Axes, list[Json]]]]:
    """Figure of a map with its caption, and axes and rows of its panels, still empty but with titles and labels.

    There is one panel for each combination of the values of `layout.panels`. The columns are the values of the last of
    these inputs if they fit; otherwise the rows of panels are equally long.

    row_mm: height (mm) of the only row of panels, and of each of several rows.
    """
    panels = []
    for values in itertools.product(*(_distinct(table, name) for name in layout.panels)):
        named = dict(zip(layout.panels, values, strict=True))
        rows = [row for row in table.rows if all(row[name] == value for name, value in named.items())]
        if rows:
            panels.append((", ".join(short(name, value) for name, value in named.items()), rows))
    count, last = len(panels), len(_distinct(table, layout.panels[-1])) if layout.panels else 1
    columns = -(-count // -(-count // MOST_COLUMNS))
    if len(layout.panels) > 1 and last <= MOST_COLUMNS and count % last == 0:
        columns = last
    grid_rows = -(-count // columns)
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=18.0 + (row_mm[0] if grid_rows == 1 else row_mm[1] * grid_rows))
    grid = figure.subplots(grid_rows, columns, squeeze=False, sharex=True, sharey=True)
    all_axes: list[Axes] = list(grid.flat)
    for spare in all_axes[count:]:
        spare.set_visible(False)
    is_long = max(len(title) for title, _ in panels) > _LETTERS // columns
    for place, (axes, (title, _)) in enumerate(zip(all_axes, panels, strict=False)):
        is_lowest, is_left = place + columns >= count, place % columns == 0
        axes.set_title(title.replace(", ", "\n") if is_long else title, loc="left", fontsize=7.5)
        axes.tick_params(labelbottom=is_lowest, labelleft=is_left)
        # of many columns only the middle one has a label
        if is_lowest and (columns < _CROWDED or place % columns == columns // 2 or count % columns):
            axes.set_xlabel(label(layout.x))
        if is_left:
            axes.set_ylabel(ordinate)
    if caption := _fixed_inputs(table):
        figure.suptitle(caption, x=0.01, ha="left", fontsize=8.0)
    return figure, [(axes, rows) for axes, (_, rows) in zip(all_axes, panels, strict=False)]


def lines_of(rows: Sequence[Json], name: str | None) -> Iterator[tuple[Any, list[Json]]]:
    """Yield each value of an input in rising order, with its rows; only None with all rows if `name` is None."""
    if name is None:
        yield None, list(rows)
        return
    for value in sorted({row[name] for row in rows}):
        yield value, [row for row in rows if row[name] == value]


def short(name: str, value: Any) -> str:
    """Text of one value of an input for a title or a legend.

    >>> short("load_N", 800.0), short("ski", "slalom"), short("twist", False)
    ('800 N', 'slalom', 'twist false')
    """
    before, behind = _prefix_and_suffix(name)
    if isinstance(value, bool):
        text = "true" if value else "false"
    else:
        text = figure_text(value) if isinstance(value, str) else local_number(f"{value:.4g}".replace("-", "−"))
    return f"{before}{text}{behind}"


def label(name: str) -> str:
    """Label of the axis of an input, with symbol and unit if it has them."""
    return CARVE_KEYS[name].axis_label if name in CARVE_KEYS else name


def _prefix_and_suffix(name: str) -> tuple[str, str]:
    """Texts before and after a value of an input in titles, such as its symbol and unit."""
    key = CARVE_KEYS.get(name)
    if key is None or not (key.label or key.symbol or (key.kind == "text" and not key.choices)):
        return f"{name.replace('_', ' ')} ", ""
    unit = key.unit if key.unit == "°" else f" {key.unit}".rstrip()
    if key.symbol:
        return f"{key.symbol} = ", unit
    return ("clamp ", unit) if name == "clamp_length_m" else ("", unit or f" {key.label}".rstrip())


def _distinct(table: StudyTable, name: str) -> list[Any]:
    """Different values of a column, in the order of the rows."""
    return list(dict.fromkeys(row[name] for row in table.rows))


def _is_number(value: Any) -> bool:
    """True for an int or float that is not a bool."""
    return isinstance(value, int | float) and not isinstance(value, bool)
