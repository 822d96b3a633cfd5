"""``skisnow replay`` and ``serve``: a written run as a page that plays; the web lab."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from .._support.errors import ParameterError
from .options import add_fall_line_azimuth, add_language, number, whole_number

if TYPE_CHECKING:
    from ..replay import Replay, ReplayTrack


def add_replay(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow replay`` to the program."""
    parser = commands.add_parser(
        "replay",
        help="a simulated run in three dimensions: a page that plays",
        description="Write replay.html of a run that was simulated with --out, with a second run or a measured track "
        "beside it.",
    )
    parser.add_argument("folder", type=Path, metavar="RUN", help="the folder of a run, with its run.nc")
    parser.add_argument("other", type=Path, nargs="?", metavar="OTHER", help="a second run, as its ghost")
    parser.add_argument("--track", type=Path, metavar="FILE", help="a measured track to compare with")
    add_fall_line_azimuth(parser, "for a track in latitude and longitude")
    parser.add_argument(
        "--starts-at-s",
        type=number("s", lowest=-36_000, highest=36_000),
        default=0.0,
        metavar="S",
        help="time of the run at the track's first point; default: 0",
    )
    parser.add_argument("--title", help="heading above it; default: the folder's name")
    add_language(parser, "the page")
    parser.add_argument("--out", type=Path, metavar="DIR", help="the folder to write into; default: the run's")
    parser.set_defaults(run=write_pages, parser=parser)


def write_pages(options: argparse.Namespace) -> int:
    """Read a run and write its replay; print the paths of the files."""
    if options.track is None and (options.fall_line_azimuth_deg is not None or options.starts_at_s):
        options.parser.error("--fall-line-azimuth-deg and --starts-at-s place a track: name it with --track")
    if options.out is not None and options.out.suffix.lower() == ".html":
        options.parser.error(f"--out names the folder of replay.html: write --out {options.out.parent}")
    from ..replay import replay_of_file, write_replay

    shown = replay_of_file(options.folder, title=options.title)
    if options.track is not None:
        shown = replay_of_file(options.folder, title=options.title, track=_read_measured_track(options, shown))
    ghost = None if options.other is None else replay_of_file(options.other)
    folder = options.out or (options.folder if options.folder.is_dir() else options.folder.parent)
    print(write_replay(shown, folder / "replay.html", ghost=ghost, language=options.language))
    return 0


def _read_measured_track(options: argparse.Namespace, shown: Replay) -> ReplayTrack:
    """Read the measured track of an option in the axes of the run."""
    from .._support.units import DEGREE
    from ..replay import measured_track
    from ..track.read import read_track
    from ..track.slope_frame import in_slope_frame

    track = replace(read_track(options.track), name=options.track.name)
    azimuth = options.fall_line_azimuth_deg
    if track.axes == "east_north_up":
        if azimuth is None:
            raise ParameterError(
                "{track} is in latitude and longitude: state with --fall-line-azimuth-deg the compass direction in "
                "which the slope falls"
            ).tag("missing", track=options.track)
        angle = shown.tilt if shown.profile is None else None
        track = in_slope_frame(track, fall_line_azimuth=azimuth * DEGREE, slope_angle=angle, missing_height="on_slope")
    elif azimuth is not None:
        raise ParameterError("{track} is already in the axes of the slope: remove the direction").tag(
            "contradiction", track=options.track
        )
    return measured_track(track, starts_at=options.starts_at_s)


def add_serve(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow serve`` to the program."""
    parser = commands.add_parser(
        "serve",
        help="open the web lab: enter a campaign, look at it, play with the turn",
        description="Serve the web lab. The first line printed is its address; Ctrl-C ends it. No network is used. "
        "With --host 0.0.0.0 phones in the same network can open it: addresses and a code for the camera are printed.",
    )
    parser.add_argument("--host", default="127.0.0.1", help="address to listen on (default: only this machine)")
    parser.add_argument(
        "--port", type=whole_number(0, 65_535), default=8765, help="port, 0 for a free one (default: 8765)"
    )
    parser.add_argument("--token", help="password of the pages; required with any other host")
    parser.add_argument(
        "--certificate",
        type=Path,
        metavar="FILE",
        help="PEM file with a certificate and its private key: pages and token are then encrypted on their way",
    )
    parser.add_argument("--certificate-key", type=Path, metavar="FILE", help="PEM file of the key, where it is another")
    parser.add_argument(
        "--store",
        metavar="PATH",
        help="file of the store, or postgresql://USER@HOST/DATABASE (default: the user's own file)",
    )
    parser.set_defaults(run=serve_lab)


def serve_lab(options: argparse.Namespace) -> int:
    """Serve the web lab until it is interrupted; returns exit status 1 if it is not installed."""
    try:
        from ..web.server import Certificate, require_allowed, serve
    except ModuleNotFoundError as missing:
        if missing.name is None or missing.name.split(".")[0] == "skisnow":
            raise
        text = f"skisnow: the web lab needs {missing.name}; install it with: pip install 'skisnow[web]'"
        print(text, file=sys.stderr)
        return 1
    from ..campaign.store import ServerAddress, Store, default_path, store_place
    from ..web.settings import Lab

    require_allowed(options.host, options.token)
    if options.certificate is None and options.certificate_key is not None:
        raise ParameterError("--certificate-key goes with --certificate").tag("contradiction")
    certificate = None if options.certificate is None else Certificate(options.certificate, options.certificate_key)
    place = store_place(options.store) if options.store is not None else default_path()
    beside = default_path() if isinstance(place, ServerAddress) else place  # runs stay here
    with Store.open(place) as store:
        serve(
            Lab(store, beside.parent / "lab"),
            host=options.host,
            port=options.port,
            token=options.token,
            tell=partial(print, flush=True),
            certificate=certificate,
        )
    return 0
