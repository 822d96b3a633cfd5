"""``skisnow track``: what a track says, printed and drawn."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from .announced import announced
from .out_folder import ready
from .progress import Progress
from .words import number

if TYPE_CHECKING:
    import argparse


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser(
        "track",
        help="what a measured track says: distance, speed, runs, lifts, turns and their radii",
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
    parser.add_argument("--out", type=Path, metavar="DIR", help="write figures (PNG, SVG) and track.json")
    parser.add_argument("--json", action="store_true", help="print track.json alone to standard output")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Read, look, print, draw."""
    if options.out is not None:
        ready(options.out)
    with announced(f"reading {options.file}"):
        from ..track.read import read_track

        track = read_track(options.file)
    with announced(f"smoothing {len(track)} points"):
        from ..track.summary import summary_dict, track_summary

        summary = track_summary(track, window=options.window_s, place_noise=options.noise_m)
        values = summary_dict(summary)
    if options.json:
        print(json.dumps(values, ensure_ascii=False, allow_nan=False, indent=1), flush=True)
    else:
        from ..report.track_summary import track_text
        from ..track.flags import FLAGS

        print(track_text(values, flag_sentences={code: flag.sentence for code, flag in FLAGS.items()}), flush=True)
    if options.out is not None:
        from ..report.track_report import write_track_report

        with Progress() as progress:
            written = write_track_report(summary, options.out, values=values, progress=progress)
        print(f"Figures: {written.parent / 'figures'}", file=sys.stderr)
    return 0
