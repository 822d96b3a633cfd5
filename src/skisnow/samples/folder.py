"""The folder of sample files that ``skisnow samples`` writes."""

from __future__ import annotations

from importlib.resources import as_file, files
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from .._support.errors import OutputError
from .._support.messages import Message
from .._support.staging import require_writable, staged, write_file
from ..campaign import write_reference
from .glides import photo_cell_times
from .runs import run_samples
from .snow import snow_samples
from .tracks import course_waypoints, gates_track, touring_day

if TYPE_CHECKING:
    from collections.abc import Iterator

CAMPAIGN: Final = "campaign"
LAST: Final = "README.txt"


def write_samples(folder: str | Path, *, seed: int = 1) -> list[Path]:
    """Write synthetic sample files: a campaign, tracks, gates, photo-cell times, pits, studies.

    Parameters
    ----------
    folder
        New or empty folder.
    seed
        Seed of the random numbers, 0 or more.

    Returns
    -------
    The files, sorted by path.

    Raises
    ------
    OutputError
        The folder is not empty or cannot be written.

    Notes
    -----
    All files are synthetic. No value in them was measured.
    """
    folder = Path(folder)
    if folder.exists() and any(folder.iterdir()):
        raise OutputError(
            Message("{folder} is not empty. Give a new or an empty folder.", folder=folder), code="wrong_kind"
        )
    require_writable(folder)
    with staged(folder, last=LAST) as stage:
        for name, content in _contents(np.random.default_rng(seed)):
            write_file(stage.path / name, content)
        write_reference(stage.path / CAMPAIGN, seed=seed)
    return sorted(path for path in folder.rglob("*") if path.is_file())


def _contents(random: np.random.Generator) -> Iterator[tuple[str, str | bytes]]:
    """Each file outside the reference campaign, by its path in the folder."""
    with as_file(files(__package__) / "files") as shipped:
        for path in sorted(path for path in shipped.rglob("*") if path.is_file()):
            yield path.relative_to(shipped).as_posix(), path.read_bytes()
    yield "day.gpx", touring_day(random)
    yield "run.gpx", gates_track(random)
    yield "course.gpx", course_waypoints()
    yield "cells.csv", photo_cell_times(random)
    yield from run_samples(random)
    yield from snow_samples(random)
