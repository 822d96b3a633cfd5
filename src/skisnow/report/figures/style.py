"""Style of the figures: journal widths, 8 pt, colours for colour-blind readers, a symbol for each site."""

from __future__ import annotations

import warnings
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, cast

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import Formatter, LogFormatter, LogLocator, NullFormatter, ScalarFormatter

from ..._support.messages import Message, local_number
from ..formatting import counted, figure_text

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from ..._support.arrays import BoolArray, FloatArray
    from ..campaign.data import ReportData, TextArray

MM_PER_INCH: Final = 25.4
SINGLE_MM: Final = 85.0
DOUBLE_MM: Final = 180.0
RASTERISE_FROM: Final = 2000  # number of points above which a cloud is an image inside the SVG
MOST_POINTS: Final = 40_000

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILLION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
GREY: Final = "#767676"
PALE: Final = "#B8B8B8"
BROWN: Final = "#8C510A"
SAND: Final = "#D8B365"
COLOURS: Final = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK)
"""Colours of Okabe and Ito (2008) without yellow, which is too pale on white paper."""
LINE_STYLES: Final = ("-", (0, (5, 1.5)), (0, (1, 1)), "-.", (0, (7, 2, 1, 2, 1, 2)))
MARKERS: Final = ("o", "^", "s", "D", "v", "P", "X", "<", "p", ">", "*", "h", "d", "8")
NAMED_SITES: Final = 14
_LETTER_MM: Final = 1.4
_HANDLE_MM: Final = 9.0
_ROW_MM: Final = 3.6

_RC: Final[dict[str, Any]] = {
    "font.family": "DejaVu Sans",  # installed with Matplotlib: the same picture on every machine
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "axes.titlesize": 8.0,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "legend.fontsize": 7.0,
    "mathtext.fontset": "dejavusans",
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.unicode_minus": True,
    "axes.labelpad": 3.0,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "xtick.major.size": 3.0,
    "ytick.major.size": 3.0,
    "xtick.minor.size": 1.6,
    "ytick.minor.size": 1.6,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.8,
    "lines.markeredgewidth": 0.7,
    "legend.frameon": False,
    "legend.handletextpad": 0.5,
    "legend.columnspacing": 1.1,
    "legend.borderaxespad": 0.2,
    "savefig.dpi": 300,
    "svg.fonttype": "none",
    "svg.hashsalt": "skisnow",
}


@contextmanager
def journal_style() -> Iterator[None]:
    """Matplotlib's defaults with the style of the figures inside the block, independent of the user's settings."""
    with matplotlib.rc_context(), warnings.catch_warnings():
        # a site's name in a script that the font lacks: boxes in the PNG, right in the SVG, whose text is text
        warnings.filterwarnings("ignore", message=r"Glyph \d+ .* missing from font")
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(cast("Any", _RC))
        yield


def new_figure(*, width_mm: float = SINGLE_MM, height_mm: float = 68.0) -> Figure:
    """An empty figure with the width of one journal column by default."""
    return Figure(figsize=(width_mm / MM_PER_INCH, height_mm / MM_PER_INCH), layout="constrained")


def line_style(place: int) -> dict[str, Any]:
    """Arguments for Matplotlib with colour and style of the line with this number, from 0."""
    return {"color": COLOURS[place % len(COLOURS)], "linestyle": LINE_STYLES[place % len(LINE_STYLES)]}


@dataclass(frozen=True, slots=True)
class SiteStyle:
    """Colour and symbol of a site, or of several ``sites`` that share them."""

    label: str
    colour: str
    marker: str
    sites: tuple[str, ...]


def site_styles(data: ReportData) -> tuple[SiteStyle, ...]:
    """Style of each site; of many sites, those with fewest experiments share one grey style."""
    counts = dict.fromkeys(data.sites, 0)
    for name, count in zip(*np.unique([*data.pressed.site, *data.sheared.site], return_counts=True), strict=True):
        counts[str(name)] += int(count)
    order = sorted(data.sites, key=lambda site: (-counts[site], site))
    named = sorted(order[: NAMED_SITES if len(order) > NAMED_SITES + 1 else NAMED_SITES + 1])
    styles = [
        SiteStyle(figure_text(site), COLOURS[index % len(COLOURS)], MARKERS[index % len(MARKERS)], (site,))
        for index, site in enumerate(named)
    ]
    rest = tuple(sorted(set(order) - set(named)))
    if rest:
        styles.insert(0, SiteStyle(counted(len(rest), "{count} other site", "{count} other sites"), PALE, ".", rest))
    return tuple(styles)


def masks(styles: Sequence[SiteStyle], site: TextArray) -> Iterator[tuple[SiteStyle, BoolArray]]:
    """Yield each style with the mask of the observations at its sites; a style without observations is omitted."""
    names, inverse = np.unique(site, return_inverse=True)
    for style in styles:
        mask = np.isin(names, style.sites)[inverse]
        if mask.any():
            yield style, mask


def scatter(
    axes: Axes, x: FloatArray, y: FloatArray, site: TextArray, styles: Sequence[SiteStyle], *, size: float | None = None
) -> list[Line2D]:
    """Draw points by site; returns the handles of the legend."""
    many, part = len(x) > RASTERISE_FROM, thinned(len(x))
    x, y, site = x[part], y[part], site[part]
    handles = []
    for style, mask in masks(styles, site):
        look: dict[str, Any] = {"linestyle": "none", "marker": style.marker, "color": style.colour}
        look["markerfacecolor"] = "none"
        handles.append(Line2D([], [], label=style.label, **look))
        look["markersize"] = size or (2.5 if many else handles[-1].get_markersize())
        axes.plot(x[mask], y[mask], rasterized=many, zorder=3, **look)
    return handles


def thinned(count: int) -> slice:
    """Slice of every k-th of `count` points, at most MOST_POINTS of them.

    k has no divisor below 11: every seventh reading could always be the same load step.
    """
    step = max(1, -(-count // MOST_POINTS))
    while step > 1 and any(step % divisor == 0 for divisor in range(2, 11)):
        step += 1
    return slice(None, None, step)


def thinning_sentence(count: int) -> str:
    """Sentence of the caption about a thinned cloud; empty if all points are drawn."""
    step = thinned(count).step
    return Message(" One point in {step} is drawn.", step=step) if step > 1 else ""


def legend_below(figure: Figure, handles: Sequence[Artist]) -> None:
    """Draw the legend below the axes, in the largest number of equal columns that fit."""
    if not handles:
        return
    room_mm = figure.get_figwidth() * MM_PER_INCH - 4.0
    widths = [_LETTER_MM * len(str(handle.get_label())) + _HANDLE_MM for handle in handles]
    columns = next(n for n in range(len(handles), 0, -1) if n == 1 or _width(widths, n) <= room_mm)
    rows = -(-len(handles) // columns)
    # a tall legend makes the figure higher instead of the axes lower
    figure.set_figheight(figure.get_figheight() + max(0, rows - 2) * _ROW_MM / MM_PER_INCH)
    figure.legend(handles=list(handles), loc="outside lower center", ncols=-(-len(handles) // rows))


def _width(widths: list[float], columns: int) -> float:
    """Width (mm) of a legend that is filled column by column, as Matplotlib does."""
    rows = -(-len(widths) // columns)
    return sum(max(widths[start : start + rows]) for start in range(0, len(widths), rows))


def mark_synthetic(data: ReportData, axes: Axes) -> None:
    """Write "synthetic data" above axes if the campaign is synthetic."""
    if data.synthetic:
        axes.set_title(Message("synthetic data"), loc="right", fontsize=7.0, color=GREY, fontstyle="italic", pad=3.0)


def spans_a_decade(values: FloatArray) -> bool:
    """True if the positive values span more than a factor of 10."""
    positive = values[np.isfinite(values) & (values > 0)]
    return bool(positive.size and positive.max() > 10.0 * positive.min())


def logarithmic(axes: Axes, which: str, values: FloatArray) -> None:
    """Make an axis, "x" or "y", logarithmic around the positive values; below two decades with ticks at 2 and 5."""
    positive = values[np.isfinite(values) & (values > 0)]
    low, high = float(positive.min()) / 1.3, float(positive.max()) * 1.3
    axes.set(**{f"{which}scale": "log"})
    axes.set(**{f"{which}lim": (low, high)})
    axis = axes.xaxis if which == "x" else axes.yaxis
    if high < 200.0 * low:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(plain_number)
    axis.set_minor_formatter(NullFormatter())


def label_time(axes: Axes, time: FloatArray) -> None:
    """Label the horizontal axis as time, and limit it to the first and last of the times (s)."""
    axes.set_xlim(float(time[0]), float(time[-1]))
    axes.set_xlabel(Message("time (s)"))


def plain_number(value: float, _place: float | None = None) -> str:
    """Text of a number at a tick without a power of ten unless it is very small or large, with a minus sign."""
    if value != 0 and not 1e-4 <= abs(value) < 1e5:
        return f"$10^{{{np.log10(abs(value)):.0f}}}$"
    return local_number(f"{value:g}".replace("-", "−"))


def local_axes(figure: Figure) -> None:
    """Write the numbers at the axes with the decimal sign of the current language."""

    def local(text: str) -> str:
        return local_number(Formatter.fix_minus(text))

    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            for formatter in (axis.get_major_formatter(), axis.get_minor_formatter()):
                if isinstance(formatter, ScalarFormatter | LogFormatter):
                    vars(formatter)["fix_minus"] = local  # Matplotlib calls it for each number


class SitePlot:
    """One panel of points by site, finished with title and legend.

    handles: handles of the legend, filled by the methods that draw.
    """

    def __init__(
        self, data: ReportData, styles: Sequence[SiteStyle], xlabel: str, ylabel: str, *, height_mm: float
    ) -> None:
        self.data, self.styles, self.figure = data, styles, new_figure(height_mm=height_mm)
        self.axes = self.figure.add_subplot(xlabel=xlabel, ylabel=ylabel)
        self.handles: list[Line2D] = []

    def draw(
        self, x: FloatArray, y: FloatArray, site: TextArray, *, ends: FloatArray | None = None,
        size: float | None = None,
    ) -> None:  # fmt: skip
        """Draw points by site, with their intervals ``ends``, shape (n, 2), behind them."""
        if ends is not None and len(x) <= RASTERISE_FROM:  # more cannot be distinguished
            closed = np.isfinite(ends).all(axis=1)
            for style, mask in masks(self.styles, site):
                (low, high), at, colour = ends[mask & closed].T, x[mask & closed], style.colour
                self.axes.vlines(at, low, high, color=colour, linewidth=0.5, alpha=0.5, zorder=2)
        self.handles.extend(scatter(self.axes, x, y, site, self.styles, size=size))

    def start_at_zero(self, which: str, values: FloatArray, margin: float) -> None:
        """Set the limits of an axis, "x" or "y", from 0 to `margin` times the maximum of the values."""
        self.axes.set(**{f"{which}lim": (0.0, float(values.max()) * margin or 1.0)})

    def finish(self) -> Figure:
        """The figure with its legend, marked if the data are synthetic."""
        mark_synthetic(self.data, self.axes)
        legend_below(self.figure, self.handles)
        return self.figure
