"""``skisnow track`` and ``compare``: distance, speed and turns of a track, and its distance from a simulated one."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from .._support.units import DEGREE
from .options import add_fall_line_azimuth, add_language, number
from .output import Progress, prepare_output, print_json, print_warnings

if TYPE_CHECKING:
    from .._support.messages import Message
    from ..comparison import Comparison
    from ..track.course.gates_table import GateGap
    from ..track.track import Track

    Gaps: TypeAlias = tuple[GateGap, ...] | None


def add_track(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow track`` to the program."""
    parser = commands.add_parser(
        "track",
        help="evaluation of a measured track: distance, speed, runs, lifts, turns and their radii",
        description="Read a track, flag what is doubtful in it, smooth it, and find its runs, lifts and turns.",
    )
    parser.add_argument("file", type=Path, metavar="FILE", help="CSV, GPX, TCX, FIT, NMEA, UBX or RTKLIB .pos")
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
        "--out", type=Path, metavar="DIR", help="write figures (PNG, SVG, PDF, data as CSV) and track.json"
    )
    add_language(parser)
    parser.add_argument("--json", action="store_true", help="print track.json alone to standard output")
    parser.set_defaults(run=summarise, parser=parser)


def summarise(options: argparse.Namespace) -> int:
    """Read a track, print its summary, and write its report if a folder is given."""
    prepare_output(options.out)
    from ..track.course import read_course
    from ..track.projection import GeodeticPoint
    from ..track.read import read_track

    course = None if options.course is None else read_course(options.course)
    origin = None
    if course is not None and course.latitude_deg is not None and course.longitude_deg is not None:
        origin = GeodeticPoint(course.latitude_deg, course.longitude_deg)
    track = read_track(options.file, origin=origin)
    from ..simulation.run_summary import time_gates
    from ..track.summary import summary_dict, track_summary

    summary = track_summary(track, window=options.window_s, place_noise=options.noise_m)
    values = summary_dict(summary)
    result = None if course is None else time_gates(course, track)
    if result is not None:
        from ..track.course.gates_table import gates_dict, time_warnings

        print_warnings(time_warnings(result))
        values |= gates_dict(result)
    if options.json:
        print_json(values)
    else:
        from ..report.track.summary import track_text
        from ..track.track import FLAGS

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


def add_compare(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow compare`` to the program."""
    parser = commands.add_parser(
        "compare",
        help="distances between a simulated and a measured track",
        description="Compare a simulated track with a measured one: largest, mean and rms distance by nearest place, "
        "at equal arc length and at equal time. Of two folders with a gates.csv of the same course also the time that "
        "was lost from gate to gate.",
    )
    track = "a track file, or the folder of a run with its track.csv"
    parser.add_argument("simulated", type=Path, metavar="SIMULATED", help=track)
    parser.add_argument("measured", type=Path, metavar="MEASURED", help=track)
    parser.add_argument(
        "--fit-offset",
        metavar="start,heading,time",
        help="fit what is unknown: one or several of start (place of the first point), heading, time; default: none",
    )
    parser.add_argument(
        "--time-from",
        choices=("clock", "first-point"),
        help="origin of equal times: the files' dates or seconds, or each track's first point; default: the "
        "clock, but the first points where only one file has a date",
    )
    _add_placement(parser)
    parser.add_argument("--from-above", action="store_true", help="leave the heights out")
    parser.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        help="write compare.json, report.html and figures (PNG, SVG, PDF, CSV); of gates their table, too",
    )
    add_language(parser)
    parser.add_argument("--json", action="store_true", help="print JSON alone to standard output")
    parser.set_defaults(run=compare, parser=parser)


def _add_placement(parser: argparse.ArgumentParser) -> None:
    """Add the options for the azimuth and angle of the slope and the uncertainty of places."""
    add_fall_line_azimuth(parser, "puts a track in latitude and longitude into a simulated run's frame")
    parser.add_argument(
        "--slope-angle-deg",
        type=number("degrees", lowest=0, highest=75),
        metavar="DEG",
        help="inclination of the plane slope, with --fall-line-azimuth-deg or --fit-offset start,heading (default: "
        "that of the run's folder; with a fit also that of the measured heights)",
    )
    parser.add_argument(
        "--known-to-m",
        type=number("metres", lowest=0),
        metavar="M",
        help="how exactly the places of both are known, which no printed digit goes below; 0: print all. Default: as "
        "the receiver states, else by its kind",
    )


def compare(options: argparse.Namespace) -> int:
    """Compare two tracks, print the distances, and write the comparison if a folder is given."""
    fitted = {"start", "heading"} <= set(_estimated_offsets(options))
    if options.slope_angle_deg is not None and options.fall_line_azimuth_deg is None and not fitted:
        options.parser.error(
            "--slope-angle-deg needs --fall-line-azimuth-deg, the direction in which the slope falls, or --fit-offset "
            "start,heading"
        )
    prepare_output(options.out)
    comparison, verdict = _compare_tracks(options)
    from ..comparison import comparison_dict
    from ..track.course.gates_table import read_gate_gaps

    gaps = read_gate_gaps(options.simulated, options.measured)
    answer = comparison_dict(comparison) | ({} if gaps is None else {"gates": [gap._asdict() for gap in gaps]})
    print_warnings(comparison.warnings)
    if options.json:
        print_json(answer)
    else:
        from ..report.track.summary import compare_summary

        if verdict is not None:
            print(f"{verdict}\n")
        print(compare_summary(answer), flush=True)
        if gaps is not None:
            from ..report.race.folder import gaps_text

            print(f"\n{gaps_text(gaps, comparison.names)}", flush=True)
    if options.out is not None:
        _write_comparison(options, comparison, answer, verdict, gaps)
    return 0


def _compare_tracks(options: argparse.Namespace) -> tuple[Comparison, Message | None]:
    """Comparison of the two tracks of the options, and the faster one in words if both were computed."""
    from ..comparison.alignment import require_offsets

    fit = _estimated_offsets(options)
    require_offsets(fit)
    from ..comparison import compare_tracks
    from ..report.summaries import read_compared, time_verdict

    measured = read_compared(options.measured)
    simulated = read_compared(options.simulated)
    if simulated.origin is not None and measured.origin is not None:
        simulated = simulated.at_origin(measured.origin)
    angle = None if options.slope_angle_deg is None else options.slope_angle_deg * DEGREE
    pairs = ((simulated, measured), (measured, simulated))
    tracks = [_in_slope(track, options, other.slope_angle if angle is None else angle) for track, other in pairs]
    time_from = options.time_from and options.time_from.replace("-", "_")
    compared = compare_tracks(
        *tracks,
        fit=fit,
        time_from=time_from,
        from_above=options.from_above,
        known_to=options.known_to_m,
        slope_angle=angle if options.fall_line_azimuth_deg is None else None,
    )
    return compared, time_verdict(simulated, measured)


def _estimated_offsets(options: argparse.Namespace) -> list[str]:
    """Names of the offsets to estimate, from the option --fit-offset."""
    return [word.strip() for word in options.fit_offset.split(",")] if options.fit_offset is not None else []


def _in_slope(track: Track, options: argparse.Namespace, slope_angle: float | None) -> Track:
    """Track from east, north, up to a slope's axes (angle: rad) if options state the fall line; otherwise unchanged."""
    from ..track.slope_frame import in_slope_frame

    azimuth = options.fall_line_azimuth_deg
    if azimuth is None or track.axes != "east_north_up":
        return track
    return in_slope_frame(
        track, fall_line_azimuth=azimuth * DEGREE, slope_angle=slope_angle or None, missing_height="on_slope"
    )


def _write_comparison(
    options: argparse.Namespace, comparison: Comparison, answer: dict[str, Any], verdict: Message | None, gaps: Gaps
) -> None:
    """Write the report, figures, gaps (if any) and compare.json of a comparison into the folder --out."""
    from .._support.messages import in_language
    from .._support.staging import staged, write_file
    from ..report.figures.drawing import write_pictures
    from ..report.formatting import json_text
    from ..report.race.folder import FILES, write_gaps
    from ..report.track.page import comparison_page
    from ..report.track.report import comparison_drawing

    with staged(options.out, last="compare.json") as stage:
        stage.stale += FILES
        with in_language(options.language):
            pictures = [] if gaps is None else write_gaps(gaps, comparison.names, stage.path)
            pictures += write_pictures(map(comparison_drawing, [comparison]), stage.path)
            write_file(stage.path / "report.html", comparison_page(answer, pictures, verdict=verdict, gaps=gaps))
        write_file(stage.path / "compare.json", f"{json_text(answer)}\n")
    print(f"Figure: {options.out / 'track_comparison.png'}, and as SVG, PDF and CSV", file=sys.stderr)
