"""A figure with its caption, and its files: SVG, PNG and PDF, and its data as CSV."""

from __future__ import annotations

import base64
import io
import re
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from string import ascii_lowercase
from typing import Any, Final, Literal, TypeAlias

from markupsafe import Markup
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from ..._support.errors import ParameterError
from ..._support.messages import ENGLISH, Message, in_language
from ..._support.staging import require_writable, write_file
from ..formatting import html
from .figure_data import figure_data
from .style import journal_style, local_axes, thinning_sentence

UNDATED: Final[dict[str, dict[str, Any]]] = {
    "svg": {"Date": None, "Creator": None, "Format": None, "Type": None},
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
_FAMILY: Final = re.compile(r"'DejaVu Sans'(?!,)")


@dataclass(frozen=True)
class Drawing:
    """A figure with its caption. ``wide``: two columns of a journal; ``points``: number of points of its cloud."""

    name: str
    caption: Markup
    alt: str
    figure: Figure
    wide: bool = False
    points: int = 0

    @property
    def whole_caption(self) -> Markup:
        """The caption with the sentence about a thinned cloud of points."""
        return self.caption + html(thinning_sentence(self.points))


@dataclass(frozen=True)
class LeftOut:
    """A figure without data: its title ``what``, and the reason why it is missing."""

    name: str
    what: str
    reason: str


@dataclass(frozen=True)
class Picture:
    """A drawing rendered to files."""

    name: str
    caption: Markup
    alt: str
    wide: bool
    svg: str
    png: bytes
    pdf: bytes = b""
    csv: str = ""

    @property
    def data_uri(self) -> str:
        """Address of the image that contains the compacted SVG itself."""
        return data_uri(self.svg)

    @property
    def files(self) -> dict[str, str | bytes]:
        """Contents by file suffix without the point."""
        return {"svg": self.svg, "png": self.png, "pdf": self.pdf, "csv": self.csv}


FORMS: Final = ("png", "svg", "pdf", "csv")
Form: TypeAlias = Literal["png", "svg", "pdf"]


def data_uri(svg: str) -> str:
    """Address of an SVG that contains the SVG itself, compacted, for an attribute of HTML."""
    return "data:image/svg+xml;base64," + base64.b64encode(compact_svg(svg).encode()).decode("ascii")


def render(drawing: Drawing) -> Picture:
    """Render a drawing as SVG, PNG and PDF, with its data as CSV; the same bytes for the same data."""
    letter_panels(drawing.figure)
    csv = figure_data(drawing.figure)
    svg, png, pdf = _render_svg(drawing), _render_as("png", drawing), _render_as("pdf", drawing)
    return Picture(drawing.name, drawing.whole_caption, drawing.alt, drawing.wide, svg, png, pdf, csv)


def drawing_svg(drawing: Drawing) -> str:
    """SVG of a drawing, for a page that needs no other format."""
    letter_panels(drawing.figure)
    return _render_svg(drawing)


def _render_svg(drawing: Drawing) -> str:
    """SVG text of a drawing, with a fallback font of the same width."""
    # Verdana has the widths of DejaVu Sans where that is not installed
    return _FAMILY.sub("'DejaVu Sans', Verdana, sans-serif", _render_as("svg", drawing).decode("utf-8"))


def _render_as(form: Form, drawing: Drawing) -> bytes:
    """Bytes of a drawing in a file format; the layout is computed once for all formats."""
    content = io.BytesIO()
    engine = drawing.figure.get_layout_engine()
    if engine is not None:
        engine.execute(drawing.figure)
        # with any engine, even the one called "none", each file would be drawn twice
        with rc_context({"figure.constrained_layout.use": False, "figure.autolayout": False}):
            drawing.figure.set_layout_engine(None)
    drawing.figure.savefig(content, format=form, metadata=UNDATED[form])
    return content.getvalue()


_COLOUR_BAR = "<colorbar>"


def panels_of(figure: Figure) -> list[Axes]:
    """Visible axes with a cell of a grid, without colour scales and second axes over the same cell."""
    panels: dict[tuple[object, ...], Axes] = {}
    for axes in figure.axes:
        place = axes.get_subplotspec()
        if place is None or axes.get_label() == _COLOUR_BAR or not axes.get_visible():
            continue
        panels.setdefault((id(place.get_gridspec()), place.num1, place.num2), axes)
    return list(panels.values())


def letter_panels(figure: Figure) -> None:
    """Add (a), (b), … to the left title of each panel if there are several."""
    panels = panels_of(figure)
    if len(panels) < 2:
        return
    for letter, axes in zip(ascii_lowercase, panels, strict=False):
        title = left_title(axes)
        if title is None:
            axes.set_title(f"({letter})", loc="left")
        else:
            title.set_text(f"({letter}) {title.get_text()}")


def left_title(axes: Axes) -> Text | None:
    """Text object of the left title of axes; None without one."""
    text = axes.get_title(loc="left")
    if not text:
        return None
    titles = (artist for artist in axes.get_children() if isinstance(artist, Text) and artist.get_text() == text)
    return next(titles, None)


DIGITS: Final = 2  # decimals of a length in points: steps of 0.01 pt are 3.5 µm on paper
_LENGTH: Final = re.compile(r"-?\d+\.\d{3,}")
_PLACED: Final = re.compile(r' (?:d|x|y)="[^"]*"|translate\([^)]*\)')
_PATH: Final = re.compile(r' d="[^"]*"')
_STYLE: Final = re.compile(r' style="([^"]*)"')
_NAME: Final = re.compile(r'(?:id="|#)([mpc][0-9a-f]{8,})')
_FEW: Final = 2


def compact_svg(svg: str) -> str:
    r"""An SVG of Matplotlib in about half the bytes: rounded lengths, shared styles, no unused names.

    >>> compact_svg('<svg>\n <g id="a">\n  <path d="M 1.23456 2 \nL 3 4 \n" style="fill: none"/>\n </g>\n</svg>')
    '<svg><g><path d="M 1.23 2 L 3 4 " style="fill: none"/></g></svg>'
    """
    svg = _PLACED.sub(lambda match: _LENGTH.sub(_round_length, match[0]), svg)
    svg = _PATH.sub(lambda match: match[0].replace("\n", ""), svg)
    svg = re.sub(r'<g id="[^"]*"', "<g", re.sub(r">\s*\n\s*<", "><", svg)).replace("xlink:href", "href")
    for number, name in enumerate(dict.fromkeys(_NAME.findall(svg))):
        svg = svg.replace(name, f"i{number}")
    return _share_styles(svg)


def _round_length(match: re.Match[str]) -> str:
    """Matched number rounded to `DIGITS` decimals, without zeros at its end."""
    text = f"{float(match[0]):.{DIGITS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _share_styles(svg: str) -> str:
    """Replace styles that several elements have by classes."""
    often = [style for style, count in Counter(_STYLE.findall(svg)).most_common() if count > _FEW]
    if not often:
        return svg
    classes = {style: f"s{number}" for number, style in enumerate(often)}
    rules = "".join(f".{name}{{{style}}}" for style, name in classes.items())
    svg = _STYLE.sub(lambda match: f' class="{classes[match[1]]}"' if match[1] in classes else match[0], svg)
    return svg.replace("</svg>", f"<style>{rules}</style></svg>")


Progress: TypeAlias = Callable[[str], None]  # callback for progress messages


def silent(_message: str) -> None:
    """Do nothing: for callers who need no progress."""


def picture_files(names: Iterable[str]) -> list[str]:
    """Paths of all files of these figures in a report's folder."""
    return [f"figures/{name}.{ending}" for name in names for ending in FORMS]


def write_pictures(drawings: Iterable[Drawing], folder: Path, *, progress: Progress = silent) -> list[Picture]:
    """Render drawings, see `render_pictures`, and write each as PNG, SVG and PDF, with its data as CSV.

    Raises OutputError: a file cannot be written.
    """
    pictures = render_pictures(drawings, progress=progress)
    for picture in pictures:
        for ending, content in picture.files.items():
            write_file(folder / f"{picture.name}.{ending}", content)
    return pictures


def render_pictures(drawings: Iterable[Drawing], *, progress: Progress = silent) -> list[Picture]:
    """Render drawings in the house style and the current language; ``progress`` gets the name of each figure.

    drawings: an iterator that draws each figure when it is requested: a figure takes its style when it is created.
    """
    pictures = []
    with journal_style():
        for drawing in drawings:
            progress(Message("figure {name}", name=drawing.name))
            local_axes(drawing.figure)
            pictures.append(render(drawing))
    return pictures


PNG_WIDTH: Final = 1200  # width of a PNG in pixels
SUFFIXES: Final = (".png", ".svg", ".pdf", ".csv")


def require_drawable(path: Path) -> None:
    """Reject the path of a figure before long computations.

    Raises ParameterError: the suffix is not one of a figure.
    Raises OutputError: the folder cannot be created or written.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise ParameterError("{path}: a figure is a file that ends in {suffixes}. Change its ending").tag(
            "unknown_ending", path=path, suffixes=list(SUFFIXES)
        )
    require_writable(path.parent)


def write_figure(path: Path, draw: Callable[[], Figure], *, language: str = ENGLISH) -> None:
    """Draw in the house style and write a complete file; the same bytes for the same data.

    path: Path with the suffix .png (1200 pixels wide), .svg or .pdf, or .csv for the data of the figure.
    draw: function that draws the figure; it is called inside the house style.
    language: language of the figure (en, de).
    """
    require_drawable(path)
    kind = path.suffix.lower().removeprefix(".")
    with journal_style(), in_language(language):
        figure = draw()
        local_axes(figure)
        if kind == "csv":
            write_file(path, figure_data(figure))
            return
        content = io.BytesIO()
        options: dict[str, Any] = {"dpi": PNG_WIDTH / figure.get_figwidth()} if kind == "png" else {}
        figure.savefig(content, format=kind, metadata=UNDATED[kind], **options)
    write_file(path, content.getvalue())
