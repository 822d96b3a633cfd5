"""A figure with its caption, and its files: SVG, PNG and PDF."""

from __future__ import annotations

import base64
import io
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from string import ascii_lowercase
from typing import Any, Final, Literal, TypeAlias, get_args

from markupsafe import Markup
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from ..._support.errors import ParameterError
from ..._support.messages import ENGLISH, Message, in_language
from ..._support.staging import require_writable, write_file
from ..formatting import html
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

    @property
    def data_uri(self) -> str:
        """Address of the image that contains the SVG itself."""
        return data_uri(self.svg)

    @property
    def files(self) -> dict[str, str | bytes]:
        """Contents by file suffix without the point."""
        return {"svg": self.svg, "png": self.png, "pdf": self.pdf}


Form: TypeAlias = Literal["png", "svg", "pdf"]
FORMS: Final[tuple[Form, ...]] = get_args(Form)


def data_uri(svg: str) -> str:
    """Address of an SVG that contains the SVG itself, for an attribute of HTML."""
    return "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode("ascii")


def render(drawing: Drawing) -> Picture:
    """Render a drawing as SVG, PNG and PDF; the same bytes for the same data."""
    letter_panels(drawing.figure)
    svg, png, pdf = _render_svg(drawing), _render_as("png", drawing), _render_as("pdf", drawing)
    return Picture(drawing.name, drawing.whole_caption, drawing.alt, drawing.wide, svg, png, pdf)


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


Progress: TypeAlias = Callable[[str], None]  # callback for progress messages


def silent(_message: str) -> None:
    """Do nothing: for callers who need no progress."""


def picture_files(names: Iterable[str]) -> list[str]:
    """Paths of all files of these figures in a report's folder."""
    return [f"figures/{name}.{ending}" for name in names for ending in FORMS]


def write_pictures(drawings: Iterable[Drawing], folder: Path, *, progress: Progress = silent) -> list[Picture]:
    """Render drawings, see `render_pictures`, and write each as PNG, SVG and PDF.

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
SUFFIXES: Final = (".png", ".svg", ".pdf")


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

    path: Path with the suffix .png (1200 pixels wide), .svg or .pdf.
    draw: function that draws the figure; it is called inside the house style.
    language: language of the figure (en, de).
    """
    require_drawable(path)
    kind = path.suffix.lower().removeprefix(".")
    with journal_style(), in_language(language):
        figure = draw()
        local_axes(figure)
        content = io.BytesIO()
        options: dict[str, Any] = {"dpi": PNG_WIDTH / figure.get_figwidth()} if kind == "png" else {}
        figure.savefig(content, format=kind, metadata=UNDATED[kind], **options)
    write_file(path, content.getvalue())
