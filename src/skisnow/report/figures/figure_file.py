"""One figure as a file of its own: PNG, SVG or PDF by the file's ending."""

from __future__ import annotations

import io
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ..._support.errors import ParameterError
from ..._support.language import ENGLISH
from ..._support.staging import require_writable, write_file
from .style import journal_style
from .translated import translate_figure

if TYPE_CHECKING:
    from collections.abc import Callable, Set

    from matplotlib.figure import Figure

PNG_WIDTH: Final = 1200
"""Pixels."""
SUFFIXES: Final = (".png", ".svg", ".pdf")
_NO_DATE: Final[dict[str, dict[str, None]]] = {
    "png": {"Software": None},
    "svg": {"Date": None, "Creator": None, "Format": None, "Type": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}


def require_drawable(path: Path) -> None:
    """Refuse a place for a figure before long work is done for it.

    Raises
    ------
    ParameterError
        The file's ending is no kind of figure.
    OutputError
        The folder cannot be made or written.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise ParameterError(f"{path}: a figure is a file that ends in {', '.join(SUFFIXES)}. Change its ending")
    require_writable(path.parent)


def write_figure(
    path: Path, draw: Callable[[], Figure], *, language: str = ENGLISH, names: Set[str] = frozenset()
) -> None:
    """Draw in the house style and write in one piece; the same bytes for the same data.

    Parameters
    ----------
    path
        Ends in .png (1200 pixels wide), .svg or .pdf.
    draw
        Gives the figure; it is called inside the house style.
    language, names
        What its words are in: en, or a language that there is a catalogue of (de); names that users gave stay.
    """
    require_drawable(path)
    kind = path.suffix.lower().removeprefix(".")
    with journal_style(), warnings.catch_warnings():
        # a name in a script that the font lacks: boxes in the PNG, right in the SVG, whose text is text
        warnings.filterwarnings("ignore", message=r"Glyph \d+ .* missing from font")
        figure = draw()
        translate_figure(figure, language, names=names)
        content = io.BytesIO()
        options: dict[str, Any] = {"dpi": PNG_WIDTH / figure.get_figwidth()} if kind == "png" else {}
        figure.savefig(content, format=kind, metadata=_NO_DATE[kind], **options)
    write_file(path, content.getvalue())
