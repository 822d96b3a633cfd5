"""The figures of a report as files, PNG, SVG, PDF and EPS, and for its page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .._support.language import ENGLISH
from .._support.staging import write_file
from .figures.drawing import FORMS, pictured
from .figures.style import journal_style
from .figures.translated import translate_figure

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence, Set
    from pathlib import Path

    from .figures.drawing import Drawing, Picture


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
