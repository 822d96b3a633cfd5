"""``skisnow track``: distance, speed, runs and turns of a track, printed and drawn."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .options import add_language, number
from .output import prepare_output, print_json, print_warnings
from .progress import Progress, announced

if TYPE_CHECKING:
    import argparse

    from ..track.course import Course, CourseResult
    from ..track.projection import GeodeticPoint
    from ..track.track import Track


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser(
        "track",
        help="evaluation of a measured track: distance, speed, runs, lifts, turns and their radii",
        description="Read a track, flag what is doubtful in it, smooth it, and find its runs, lifts and turns.",
    )
    parser.add_argument("file", type=Path, metavar="FILE", help="CSV, GPX, FIT, NMEA, UBX or RTKLIB .pos")
    parser.add_argument(
        "--window-s",
        type=number("s", lowest=0, highest=86_400, above=True),
        metavar="S",
        help="length of the smoothing's window; left out, eight intervals between points, at least 0.8 s",
    )
    parser.add_argument(
        "--noise-m",
        type=number("m", lowest=0, highest=1_000, above=True),
        metavar="M",
        help="standard deviation of a coordinate; left out, from the scatter about the smoothed track",
    )
    parser.add_argument(
        "--course",
        type=Path,
        metavar="FILE",
        help="gates, CSV or GPX: says which were passed, and when",
    )
    parser.add_argument(
        "--discipline",
        choices=("slalom", "giant-slalom"),
        help="with --course: check the course against the rules of this discipline",
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="write figures (PNG, SVG, PDF, EPS) and track.json")
    add_language(parser)
    parser.add_argument("--json", action="store_true", help="print track.json alone to standard output")
    parser.set_defaults(run=run, parser=parser)


def run(options: argparse.Namespace) -> int:
    """Read, look, print, draw."""
    if options.discipline is not None and options.course is None:
        options.parser.error("--discipline needs --course: name the file of the gates")
    if options.out is not None:
        prepare_output(options.out)
    course = None if options.course is None else _course(options)
    with announced(f"reading {options.file}"):
        from ..track.read import read_track

        track = read_track(options.file, origin=None if course is None else _origin(course))
    with announced(f"smoothing {len(track)} points"):
        from ..track.summary import summary_dict, track_summary

        summary = track_summary(track, window=options.window_s, place_noise=options.noise_m)
        values = summary_dict(summary)
        result = None if course is None else _timed(course, track)
    if result is not None:
        values |= _told(result)
    if options.json:
        print_json(values)
    else:
        from ..report.track.summary import track_text
        from ..track.flags import FLAGS

        print(track_text(values, flag_sentences={code: flag.sentence for code, flag in FLAGS.items()}), flush=True)
        if result is not None:
            from ..report.summaries import gates_text

            print(f"\n{gates_text(result)}", flush=True)
    if options.out is not None:
        from ..report.track.report import write_track_report

        with Progress() as progress:
            written = write_track_report(
                summary, options.out, values=values, gates=result, language=options.language, progress=progress
            )
        print(f"Figures: {written.parent / 'figures'}", file=sys.stderr)
    return 0


def _course(options: argparse.Namespace) -> Course:
    from ..track.course import course_warnings, read_course

    course = read_course(options.course, discipline=options.discipline)
    print_warnings((*course.warnings, *course_warnings(course)))
    return course


def _origin(course: Course) -> GeodeticPoint | None:
    """One plane for the track and a course in degrees."""
    from ..track.projection import GeodeticPoint

    if course.latitude_deg is None or course.longitude_deg is None:
        return None
    return GeodeticPoint(course.latitude_deg, course.longitude_deg)


def _timed(course: Course, track: Track) -> CourseResult:
    from ..simulation.run_summary import time_gates

    return time_gates(course, track)


def _told(result: CourseResult) -> dict[str, Any]:
    from ..track.course.gates_table import gates_dict, time_warnings

    print_warnings(time_warnings(result))
    return gates_dict(result)
