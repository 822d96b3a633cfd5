"""A figure of the report, or why there is none."""

from __future__ import annotations

import base64
import io
import re
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

from ..symbols import html
from .compact import compact_svg
from .opaque import make_opaque
from .panels import letter_panels
from .style import thinning_sentence

if TYPE_CHECKING:
    from markupsafe import Markup
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
