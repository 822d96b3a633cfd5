"""A figure of a report with its caption, and its SVG, PNG, PDF and EPS."""

from __future__ import annotations

import base64
import io
import re
import warnings
from dataclasses import dataclass
from string import ascii_lowercase
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

import numpy as np
from matplotlib.artist import Artist
from matplotlib.collections import Collection
from matplotlib.colors import to_rgba_array
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

from ..symbols import html
from .compact import compact_svg
from .style import thinning_sentence

if TYPE_CHECKING:
    from markupsafe import Markup
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_UNDATED: Final[dict[str, dict[str, Any]]] = {
    "svg": {"Date": None, "Creator": None, "Format": None, "Type": None},
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
    "eps": {"Creator": "skisnow"},
}
_EPS_DPI: Final = 150
"""Of clouds of points inside an EPS, which holds them as text."""
_EPS_DATE: Final = re.compile(rb"^%%CreationDate:.*\n", re.MULTILINE)
_FAMILY: Final = re.compile(r"'DejaVu Sans'(?!,)")


@dataclass(frozen=True)
class Drawing:
    """A figure with its words. ``wide``: two columns of a journal; ``points``: how many the cloud has."""

    name: str
    caption: Markup
    alt: str
    figure: Figure
    wide: bool = False
    points: int = 0

    @property
    def whole_caption(self) -> Markup:
        """The caption, and what is said of a cloud that was thinned."""
        return self.caption + html(thinning_sentence(self.points))


@dataclass(frozen=True)
class LeftOut:
    """A figure that the campaign has no data for. ``what`` and ``reason`` make a sentence: what: reason."""

    name: str
    what: str
    reason: str


@dataclass(frozen=True)
class Picture:
    """A drawing as files."""

    name: str
    caption: Markup
    alt: str
    wide: bool
    svg: str
    png: bytes
    pdf: bytes = b""
    eps: bytes = b""

    @property
    def data_uri(self) -> str:
        """The SVG inside an attribute of the HTML, in fewer bytes than its file."""
        return data_uri(self.svg)

    @property
    def files(self) -> dict[str, str | bytes]:
        """Contents by the endings of file names."""
        return {"svg": self.svg, "png": self.png, "pdf": self.pdf, "eps": self.eps}


FORMS: Final = ("png", "svg", "pdf", "eps")
Form: TypeAlias = Literal["png", "svg", "pdf", "eps"]


def data_uri(svg: str) -> str:
    """Address of an SVG that contains the SVG itself, compacted, for an attribute of HTML."""
    return "data:image/svg+xml;base64," + base64.b64encode(compact_svg(svg).encode()).decode("ascii")


def pictured(drawing: Drawing) -> Picture:
    """Draw it, the same bytes for the same data."""
    letter_panels(drawing.figure)
    svg, png, pdf = _svg(drawing), _drawn_as("png", drawing), _drawn_as("pdf", drawing)
    make_opaque(drawing.figure)
    eps = _EPS_DATE.sub(b"", _drawn_as("eps", drawing))
    words = drawing.name, drawing.whole_caption, drawing.alt, drawing.wide
    return Picture(*words, svg, png, pdf, eps)


def drawing_svg(drawing: Drawing) -> str:
    """SVG of a drawing, for a page that needs no other format."""
    letter_panels(drawing.figure)
    return _svg(drawing)


def _svg(drawing: Drawing) -> str:
    # Verdana has the widths of DejaVu Sans where that is not installed
    return _FAMILY.sub("'DejaVu Sans', Verdana, sans-serif", _drawn_as("svg", drawing).decode("utf-8"))


def _drawn_as(form: Form, drawing: Drawing) -> bytes:
    content = io.BytesIO()
    options: dict[str, Any] = {"dpi": _EPS_DPI} if form == "eps" else {}
    with warnings.catch_warnings():
        # a site's name in a script that the font lacks: boxes in the PNG, right in the SVG, whose text is text
        warnings.filterwarnings("ignore", message=r"Glyph \d+ .* missing from font")
        _lay_out(drawing.figure)
        drawing.figure.savefig(content, format=form, metadata=_UNDATED[form], **options)
    return content.getvalue()


def _lay_out(figure: Figure) -> None:
    """Place the axes, once for both files: that takes as long as drawing them."""
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        _set_no_engine(figure)


def _set_no_engine(figure: Figure) -> None:
    """Leave the axes where they are. With any engine, the one called "none" too, each file is drawn twice."""
    from matplotlib import rc_context

    with rc_context({"figure.constrained_layout.use": False, "figure.autolayout": False}):
        figure.set_layout_engine(None)


_COLOUR_BAR = "<colorbar>"


def panels_of(figure: Figure) -> list[Axes]:
    """The visible axes that stand in a grid for themselves: no scale of colours, no second axis over another."""
    found: dict[tuple[object, ...], Axes] = {}
    for axes in figure.axes:
        place = axes.get_subplotspec()
        if place is None or axes.get_label() == _COLOUR_BAR or not axes.get_visible():
            continue
        found.setdefault((id(place.get_gridspec()), place.num1, place.num2), axes)
    return list(found.values())


def letter_panels(figure: Figure) -> None:
    """Put a letter before the title at the left of each panel, or in its place."""
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
    """The title at the left as it stands there; None where there is none."""
    text = axes.get_title(loc="left")
    if not text:
        return None
    own = (each for each in axes.get_children() if isinstance(each, Text) and each.get_text() == text)
    return next(own, None)


def make_opaque(figure: Figure) -> None:
    """Change the figure itself."""
    for artist in figure.findobj():
        _make_opaque(artist)


def _make_opaque(artist: Artist) -> None:
    alpha = artist.get_alpha()
    if isinstance(artist, Collection):
        faces, edges = _blended(artist.get_facecolor(), None), _blended(artist.get_edgecolor(), None)
        if artist.get_array() is None:  # else its colours come from a map
            artist.set_alpha(None)
            artist.set_facecolor(faces)
            artist.set_edgecolor(edges)
    elif alpha is None or np.ndim(alpha) or alpha >= 1.0:
        return
    elif isinstance(artist, Line2D):
        artist.set_color(_one(artist.get_color(), alpha))
        artist.set_alpha(None)
    elif isinstance(artist, Patch):
        face, edge = _one(artist.get_facecolor(), None), _one(artist.get_edgecolor(), None)
        artist.set_alpha(None)
        artist.set_facecolor(face)
        artist.set_edgecolor(edge)
    elif isinstance(artist, Text):
        artist.set_color(_one(artist.get_color(), alpha))
        artist.set_alpha(None)


def _one(colour: Any, alpha: float | None) -> tuple[float, float, float, float]:
    red, green, blue, share = _blended([colour], alpha)[0].tolist()
    return red, green, blue, share


def _blended(colours: Any, alpha: float | None) -> Any:
    """Over white; what is wholly transparent stays so."""
    found = to_rgba_array(colours, alpha)
    share = found[:, 3:]
    found[:, :3] = share * found[:, :3] + 1.0 - share
    found[:, 3] = np.where(share[:, 0] > 0.0, 1.0, 0.0)
    return found
