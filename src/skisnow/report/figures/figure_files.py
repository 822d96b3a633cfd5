"""Files of figures: all figures of a report, or one figure by the ending of its file."""

from __future__ import annotations

import io
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ..._support.errors import ParameterError
from ..._support.language import ENGLISH
from ..._support.staging import require_writable, write_file
from .drawing import FORMS, pictured
from .style import journal_style
from .translated import translate_figure

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence, Set
    from pathlib import Path

    from matplotlib.figure import Figure

    from .drawing import Drawing, Picture


def picture_files(names: Iterable[str]) -> list[str]:
    """The files of these figures below a report's folder."""
    return [f"figures/{name}.{ending}" for name in names for ending in FORMS]


def write_pictures(
    drawings: Iterator[Drawing],
    folder: Path,
    *,
    every: Sequence[str],
    language: str = ENGLISH,
    names: Set[str] = frozenset(),
    progress: Callable[[str], None] | None = None,
) -> list[Picture]:
    """Draw one after the other in the house style, and write each as PNG, SVG, PDF and EPS.

    Parameters
    ----------
    drawings
        Made as they are asked for: a figure takes its style when it is made.
    folder
        Of the files; it is made where it is missing.
    every
        Names that such a report may have; files of those that are not drawn now are removed.
    language, names
        Of the figures, and what users wrote in them.
    progress
        Called with the name of each figure.

    Returns
    -------
    list of Picture
        For a page.

    Raises
    ------
    OutputError
        A file cannot be written.
    """
    pictures = []
    with journal_style():
        for drawing in drawings:
            if progress is not None:
                progress(f"figure {drawing.name}")
            translate_figure(drawing.figure, language, names=names)
            pictures.append(pictured(drawing))
    for picture in pictures:
        write_picture(picture, folder)
    for name in set(every) - {picture.name for picture in pictures}:
        for ending in FORMS:
            (folder / f"{name}.{ending}").unlink(missing_ok=True)
    return pictures


def write_picture(picture: Picture, folder: Path) -> None:
    """Write all files of a picture.

    Raises
    ------
    OutputError
        A file cannot be written.
    """
    for ending, content in picture.files.items():
        write_file(folder / f"{picture.name}.{ending}", content)


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
