"""Folder of a measured track: figures and summary.json."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from markupsafe import Markup

from ..._support.language import ENGLISH
from ..._support.staging import require_writable, staged, write_file
from ...track.course.gates_table import gates_csv
from ...track.summary import summary_dict
from ..figures.course import course_line
from ..figures.drawing import Drawing
from ..figures.figure_files import picture_files, write_pictures
from ..symbols import figure_text, prose
from .figures import track_along, track_map

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from ...track.course import CourseResult
    from ...track.summary import TrackSummary

FIGURES: Final = ("map", "along")
"""Names of a track's figures, in figures/ as .png and .svg."""
OF_COURSE: Final = "course"
"""The one that is there beside them where gates were given."""


def write_track_report(
    summary: TrackSummary,
    folder: str | Path,
    *,
    values: Mapping[str, Any] | None = None,
    gates: CourseResult | None = None,
    language: str = ENGLISH,
    progress: Callable[[str], None] | None = None,
) -> Path:
    """Write figures/map, figures/along (each .png and .svg) and track.json.

    Parameters
    ----------
    summary
        What `skisnow.track.summary.track_summary` gave.
    folder
        Made where it is missing. Other files in it stay.
    values
        What goes into track.json; left out, what `summary_dict` gives.
    gates
        Of a course: then gates.csv and figures/course, the line over the gates with the speed as colour, too.
    language
        Of the figures: en, or a language that there is a catalogue of (de).
    progress
        Called with a line of text now and then.

    Returns
    -------
    Path
        Of track.json, which is written last.

    Raises
    ------
    OutputError
        A file cannot be written.
    """
    folder = Path(folder)
    require_writable(folder)
    text = json.dumps(
        summary_dict(summary) if values is None else values, ensure_ascii=False, allow_nan=False, indent=1
    )
    with staged(folder, last="track.json") as stage:
        stage.stale += [*picture_files((*FIGURES, OF_COURSE)), "gates.csv"]
        if gates is not None:
            write_file(stage.path / "gates.csv", gates_csv(gates))
        names = frozenset({figure_text(summary.track.name)})
        drawings, every = track_drawings(summary, gates), (*FIGURES, OF_COURSE)
        write_pictures(drawings, stage.path / "figures", every=every, language=language, names=names, progress=progress)
        write_file(stage.path / "track.json", f"{text}\n")
    return folder / "track.json"


def _estimates(summary: TrackSummary) -> Markup:
    """Highest speed and length with their intervals; nothing if the device recorded them."""
    if summary.max_speed_interval is None or summary.distance_interval is None:
        return Markup()
    return prose(
        " Highest speed: {speed} m/s (95 % interval {slow} to {fast} m/s); length: {length} m ({short} to {long} m).",
        speed=f"{summary.max_speed:.4g}",
        slow=f"{summary.max_speed_interval[0]:.4g}",
        fast=f"{summary.max_speed_interval[1]:.4g}",
        length=f"{summary.distances['places']:.5g}",
        short=f"{summary.distance_interval[0]:.5g}",
        long=f"{summary.distance_interval[1]:.5g}",
    )


def track_drawings(summary: TrackSummary, gates: CourseResult | None = None) -> Iterator[Drawing]:
    """Draw one after the other, inside the house style."""
    name = summary.track.name
    yield Drawing(
        "map",
        prose("{name} from above, the same scale along both axes.", name=name),
        f"{name} from above.",
        track_map(summary),
        wide=True,
    )
    yield Drawing(
        "along",
        prose(
            "Speed, height and turn radius along {name}. The axis of the radius is even in 1/radius: straight lies in "
            "the middle. The smoothing leaves half of a swing of the curvature that takes {half} s.",
            name=name,
            half=f"{summary.motion.smoothed.resolution.half_period:.2g}",
        )
        + _estimates(summary),
        f"Speed, height and turn radius along {name}.",
        track_along(summary),
        wide=True,
    )
    if gates is not None:
        usable = summary.track.usable
        yield Drawing(
            "course",
            prose("The line of {name} over the course, from above; colour: speed.", name=name),
            f"Line of {name} over the gates, coloured by speed.",
            course_line(
                gates, summary.track.place[usable], summary.motion.speed[usable], label="speed (m/s)", diverging=False
            ),
            wide=True,
        )
