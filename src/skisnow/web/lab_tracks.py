"""Uploaded tracks and courses of the lab, kept as files that are never overwritten."""

from __future__ import annotations

import contextlib
import json
import shutil
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path, PurePosixPath
from typing import IO, Final

from .._support.errors import FieldDataError, ParameterError
from .._support.messages import joined, template
from .._support.staging import cannot_write, write_file
from .._support.units import DEGREE
from .._support.user_files.json_text import read_record
from .._support.user_files.text_files import ContentError
from ..replay.replay import Replay, ReplayTrack, measured_track
from ..track.course import course_names, read_course
from ..track.read import SUFFIXES, read_track
from ..track.slope_frame import in_slope_frame
from ..track.track import Track
from .page_requests import free_place, hidden_folder, newest_first, plain_stem
from .uploads import BOUNDS, confined
from .words import replaced, typed_number

TRACKS_FOLDER: Final = "tracks"
ABOUT: Final = "about.json"
LARGEST_TRACK_BYTES: Final = 20_000_000  # maximum size of a track: an hour at 100 points per second as GPX
MOST_POINTS: Final = 20_000
MOST_TRACKS: Final = 200
LONGEST_WAIT_S: Final = 36_000.0
_FILE: Final = "track"


@dataclass(frozen=True, slots=True)
class Placing:
    """Placing of an uploaded track next to a run.

    called: name of the uploaded file.
    fall_line_azimuth_deg: compass direction of the fall line; None for a track in the axes of the slope, or if it is
        unknown.
    starts_at_s: time of the run at the first point of the track (s).
    is_geodetic: True for a track in latitude and longitude.
    """

    called: str
    fall_line_azimuth_deg: float | None = None
    starts_at_s: float = 0.0
    is_geodetic: bool = False

    @property
    def is_on_slope(self) -> bool:
        """True if the track can be drawn next to a run."""
        return not self.is_geodetic or self.fall_line_azimuth_deg is not None


class TrackFolders:
    """Uploaded tracks of a lab, each in a separate folder."""

    def __init__(self, runs: Path) -> None:
        self._folder = runs / TRACKS_FOLDER

    def names(self) -> list[str]:
        """Names of all tracks, the newest first."""
        paths = newest_first(self._folder.glob(f"*/{ABOUT}"))
        return [place.parent.name for place in paths if not place.parent.name.startswith(".")]

    def keep(
        self, content: IO[bytes], placing: Placing, *, check: Callable[[Path, Placing], Placing] | None = None
    ) -> str:
        """Store a track that can be read; returns its name.

        check: function that checks the file (default: `check_track` in this process).
        Raises ParameterError: the track is too large, there are too many, a number is not allowed, or it cannot be
            placed on a slope.
        Raises FieldDataError: the file cannot be read as a track.
        Raises OutputError: the folder cannot be written.
        """
        _require_allowed(placing)
        if len(self.names()) >= MOST_TRACKS:
            raise ParameterError("{most} tracks are stored already; remove some on the page Replay").tag(
                "too_many_files", most=MOST_TRACKS
            )
        with hidden_folder(self._folder) as made:
            suffix = PurePosixPath(placing.called.lower()).suffix
            place = made / (_FILE + (suffix if suffix in SUFFIXES else ""))
            words = template("a track of more than {most} MB is not accepted")
            write_file(place, _limited(content, LARGEST_TRACK_BYTES, words))
            placing = (check or check_track)(place, placing)
            write_file(made / ABOUT, json.dumps(asdict(placing), ensure_ascii=False, indent=1))
            place = free_place(self._folder, plain_stem(placing.called, "track"))
            made.rename(place)
        return place.name

    def placings(self) -> dict[str, Placing]:
        """Placing of each undamaged track by its name, the newest first."""
        placings = {}
        for name in self.names():
            with contextlib.suppress(ContentError):
                placings[name] = read_record(self._folder / name / ABOUT, Placing)
        return placings

    def file(self, name: str) -> tuple[Path, Placing]:
        """File of a track, and its placing; ParameterError if there is no such track or its folder is damaged."""
        if name not in self.names():
            raise ParameterError("there is no track {name!r} here. Choose one from the list").tag(
                "unknown_track", name=name
            )
        placing = read_record(self._folder / name / ABOUT, Placing)
        _require_allowed(placing)
        places = [path for path in (self._folder / name).iterdir() if path.name != ABOUT]
        if len(places) != 1:
            raise ParameterError("the folder of the track {name} is damaged. Remove it and upload the track again").tag(
                "damaged", name=name
            )
        return places[0], placing

    def remove(self, name: str) -> None:
        """Remove a track; ParameterError if there is no such track, OutputError if it cannot be removed."""
        place = self.file(name)[0].parent
        try:
            shutil.rmtree(place)
        except OSError as error:
            raise cannot_write(place, error) from error

    def beside(self, name: str, replay: Replay, *, read: Callable[..., ReplayTrack] | None = None) -> ReplayTrack:
        """Track in the axes of a run, by `read` (default: in this process); ParameterError if it cannot be placed."""
        place, placing = self.file(name)
        angle = replay.tilt if replay.profile is None else None
        return (read or track_on_slope)(place, placing, angle)


def check_track(place: Path, placing: Placing) -> Placing:
    """Placing of a track with `is_geodetic` set; ParameterError if it is unreadable, too long or cannot be drawn."""
    track = _read_named(place, placing)
    _require_few_points(track)
    placing = replace(placing, is_geodetic=track.axes == "east_north_up")
    drawable = placing if placing.is_on_slope else replace(placing, fall_line_azimuth_deg=0.0)
    measured_track(_to_slope_axes(track, drawable, slope_angle=0.0))  # rejects a track with too few places
    return placing


def track_on_slope(place: Path, placing: Placing, slope_angle: float | None) -> ReplayTrack:
    """Track in the axes of a slope with an angle (rad; None for a profile); rejects one with too many points."""
    track = _to_slope_axes(_read_named(place, placing), placing, slope_angle=slope_angle)
    _require_few_points(track)
    return measured_track(track, starts_at=placing.starts_at_s)


def _require_allowed(placing: Placing) -> None:
    """Reject a fall line's azimuth beyond ±360° or a start (s) beyond the maximum."""
    azimuth, start = placing.fall_line_azimuth_deg, placing.starts_at_s
    if azimuth is not None and not -360.0 <= azimuth <= 360.0:
        raise ParameterError("the fall line's direction is {azimuth:g}°; it must be from −360 to 360").tag(
            "out_of_range", azimuth=azimuth
        )
    if not abs(start) <= LONGEST_WAIT_S:
        raise ParameterError("the start of the track is {start:g} s; it must be within {longest:g} s of the run's").tag(
            "out_of_range", start=start, longest=LONGEST_WAIT_S
        )


def _require_few_points(track: Track) -> None:
    """Reject a track with more points than can be drawn next to a run."""
    if len(track.time) > MOST_POINTS:
        raise ParameterError(
            "{track} has {points} points; at most {most} are drawn next to a run. Cut the turn out"
        ).tag("too_many_points", track=track.name, points=len(track.time), most=MOST_POINTS)


def _limited(content: IO[bytes], most: int, sentence: str) -> bytes:
    """Read a file of at most `most` bytes; a larger one raises a ParameterError with the sentence."""
    data = content.read(most + 1)
    if len(data) > most:
        raise ParameterError(sentence).tag("too_large", most=most // 1_000_000)
    return data


def _read_named(place: Path, placing: Placing) -> Track:
    """Read an uploaded track; the track and errors have the name of the uploaded file instead of `place`."""
    try:
        return replace(read_track(place), name=placing.called)
    except FieldDataError as error:
        sentences, name = joined(error.sentences), placing.called
        raise ParameterError(replaced(sentences, {str(place): name, place.name: name})).tag(error.code) from error


def _to_slope_axes(track: Track, placing: Placing, *, slope_angle: float | None) -> Track:
    """Track in the axes of a slope; one in latitude and longitude begins at the start of the run."""
    azimuth = placing.fall_line_azimuth_deg
    if azimuth is None:
        if track.axes == "east_north_up":
            raise ParameterError(
                "{track} is in latitude and longitude: add it again with the direction of the fall line"
            ).tag("no_direction", track=placing.called)
        return track
    if track.axes == "slope":
        raise ParameterError("{track} is already in the axes of the slope: remove the direction").tag(
            "needless_direction", track=placing.called
        )
    return in_slope_frame(track, fall_line_azimuth=azimuth * DEGREE, slope_angle=slope_angle, missing_height="on_slope")


def number_of(text: str, words: str) -> float | None:
    """Number in the text of a field; None if it is empty. Raises ParameterError, with `words`: it is not a number."""
    return typed_number(words, text) if text.strip() else None


COURSES_FOLDER: Final = "courses"
COURSE_SUFFIXES: Final = (".csv", ".gpx")
LARGEST_COURSE_BYTES: Final = 1_000_000  # maximum size of a course: ten thousand gates
MOST_COURSES: Final = 200


class LabCourses:
    """Courses of a lab: built-in and uploaded ones, each of which is a file."""

    def __init__(self, runs: Path) -> None:
        self._folder = runs / COURSES_FOLDER

    def kept(self) -> list[str]:
        """Names of the uploaded courses, the newest first."""
        paths = newest_first(self._folder.glob("[!.]*"))
        return [place.name for place in paths if place.suffix in COURSE_SUFFIXES]

    def names(self) -> list[str]:
        """Names of all courses, first the built-in ones."""
        return [*course_names(), *self.kept()]

    def change(self, name: str) -> tuple[str, str]:
        """Key of a scenario and its value that select a course. Raises ParameterError: the lab has no such course."""
        if name in course_names():
            return "course.name", name
        if name not in self.kept():
            raise ParameterError("the lab has no course named {name!r}. Choose one from the list").tag(
                "unknown_course", name=name
            )
        return "course.file", str((self._folder / name).absolute())

    def keep(self, called: str, content: IO[bytes]) -> str:
        """Store a course; returns its name. ParameterError: it is not a course, too large, or there are too many."""
        suffix = PurePosixPath(called.lower()).suffix
        if suffix not in COURSE_SUFFIXES:
            raise ParameterError("{file} is not a course: choose a .csv or .gpx file").tag(
                "unknown_ending", file=called
            )
        if len(self.kept()) >= MOST_COURSES:
            raise ParameterError(
                "{most} courses are stored already; remove some from the folder {folder} of the lab"
            ).tag("too_many_files", most=MOST_COURSES, folder=COURSES_FOLDER)
        data = _limited(content, LARGEST_COURSE_BYTES, template("a course of more than {most} MB is not accepted"))
        place = free_place(self._folder, plain_stem(called, "course"), suffix)
        made = place.with_name(f".partial-{place.name}")
        write_file(made, data)
        try:
            confined(BOUNDS, gates_of, made)
            made.rename(place)
        except OSError as error:
            raise cannot_write(place, error) from error
        except ParameterError as error:
            message = replaced(error.message, {str(made): called, made.name: called})
            raise ParameterError(message).tag(error.code) from error
        finally:
            made.unlink(missing_ok=True)
        return place.name


def gates_of(place: Path) -> int:
    """Number of gates of a course file; ParameterError if it is not a valid course."""
    return len(read_course(place).gates)
