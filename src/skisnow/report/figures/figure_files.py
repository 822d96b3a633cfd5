"""Files of figures: all figures of a report, or one figure by the ending of its file."""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Final, TypeAlias

from matplotlib.figure import Figure

from ..._support.errors import ParameterError
from ..._support.messages import ENGLISH, Message, in_language
from ..._support.staging import require_writable, write_file
from .drawing import FORMS, UNDATED, Drawing, Picture, render
from .figure_data import figure_data
from .style import journal_style, local_axes

Progress: TypeAlias = Callable[[str], None]  # callback for progress messages


def silent(_message: str) -> None:
    """Progress callback that ignores the message."""


def picture_files(names: Iterable[str]) -> list[str]:
    """Paths of all files of these figures in a report's folder."""
    return [f"figures/{name}.{ending}" for name in names for ending in FORMS]


def write_pictures(drawings: Iterable[Drawing], folder: Path, *, progress: Progress = silent) -> list[Picture]:
    """Render drawings, see `render_pictures`, and write each as PNG, SVG, PDF and EPS, with its data as CSV.

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
    with journal_style(), in_language(language), warnings.catch_warnings():
        # a name in a script that the font lacks: boxes in the PNG, right in the SVG, whose text is text
        warnings.filterwarnings("ignore", message=r"Glyph \d+ .* missing from font")
        figure = draw()
        local_axes(figure)
        if kind == "csv":
            write_file(path, figure_data(figure))
            return
        content = io.BytesIO()
        options: dict[str, Any] = {"dpi": PNG_WIDTH / figure.get_figwidth()} if kind == "png" else {}
        figure.savefig(content, format=kind, metadata=UNDATED[kind], **options)
    write_file(path, content.getvalue())
