"""Work of a worker, wherever it is: some points at once, their rows as text, and how long a point took."""

from __future__ import annotations

import os
import pickle
import platform
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple, Protocol, TypeAlias, runtime_checkable

from ...compiled import core
from ..errors import SkisnowError
from .kept_rows import NumberedText, Row, row_text

PointFunction: TypeAlias = Callable[[Any], Row | list[Any]]
Numbered: TypeAlias = tuple[int, Any]
"""A point and its number."""


@dataclass(frozen=True, slots=True)
class Done:
    """Rows of a chunk.

    Attributes
    ----------
    rows
        Numbers and rows.
    seconds_per_point
        Wall time (s).
    """

    rows: list[NumberedText]
    seconds_per_point: float


class Identity(NamedTuple):
    """Version of skisnow and machine of a worker: two equal identities give the same bits on one kind of machine."""

    version: str
    core: str

    def __str__(self) -> str:
        """In words."""
        return f"skisnow {self.version} with the core {self.core}"


@runtime_checkable
class NeedsFiles(Protocol):
    """A function that reads files, which a worker on another machine may not have."""

    def require_files(self) -> None:
        """Raise an error if the files of a worker differ."""
        ...


@lru_cache(maxsize=1)
def own_identity() -> Identity:
    """Identity of this process, cached: reading the version takes milliseconds, too long for each chunk."""
    return Identity(version("skisnow"), core.SOURCE_HASH)


def compute_rows(function: PointFunction, points: Sequence[Numbered]) -> Done:
    """The rows of some points."""
    start = time.perf_counter()
    rows = [(number, row_text(function(point))) for number, point in points]
    return Done(rows, (time.perf_counter() - start) / max(len(rows), 1))


def computed_elsewhere(packed: bytes, identity: Identity, folder: str, points: Sequence[Numbered]) -> Done:
    """The rows of some points by a function that was sent; a worker keeps the last few that it was sent.

    Parameters
    ----------
    packed
        The function, pickled.
    asked
        Which skisnow sent it.
    folder
        Where relative paths start there; where there is such a folder it becomes the worker's, too.
    points
        With their numbers.

    Raises
    ------
    SkisnowError
        Another skisnow is installed here, or the function's files are others here.
    """
    if identity != own_identity():
        raise SkisnowError(
            "The worker on {node} has {installed}, this computer has {expected}. Install the same on both.",
            code="different_versions",
            node=platform.node(),
            installed=own_identity(),
            expected=identity,
        )
    return compute_rows(_unpacked(packed, folder), points)


@lru_cache(maxsize=4)
def _unpacked(packed: bytes, folder: str) -> Any:
    if Path(folder).is_dir() and folder != str(Path.cwd()):
        os.chdir(folder)
    function = pickle.loads(packed)
    if isinstance(function, NeedsFiles):
        function.require_files()
    return function
