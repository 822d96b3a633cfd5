"""Courses that come with the package."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import Final

_FOLDER: Final = files(__package__) / "catalogue"


def course_names() -> tuple[str, ...]:
    """Names of the courses that come with skisnow.

    Returns
    -------
    tuple of str
        What `skisnow.read_course` takes beside a path.

    See Also
    --------
    skisnow.read_course

    References
    ----------
    The page docs/files/course.md.

    Examples
    --------
    >>> course_names()
    ('giant-slalom-20-gates', 'slalom-20-gates')
    """
    return tuple(sorted(entry.name.removesuffix(".csv") for entry in _FOLDER.iterdir() if entry.name.endswith(".csv")))


def course_place(name: str) -> Path:
    """Where such a course lies."""
    return Path(str(_FOLDER / f"{name}.csv"))


def name_in_catalogue(source: str) -> str | None:
    """The source of a course, if it is one of these."""
    return source if source in course_names() else None


def file_of_course(source: str) -> str | None:
    """The source of a course, if it is none of these."""
    return None if source in course_names() else source
