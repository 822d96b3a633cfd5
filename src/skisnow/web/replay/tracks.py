"""Measured tracks that were uploaded to stand beside a run: kept as they came, with what places them on the slope."""

from __future__ import annotations

import json
import secrets
import shutil
from dataclasses import asdict, dataclass, replace
from pathlib import Path, PurePosixPath
from tempfile import mkdtemp
from typing import IO, TYPE_CHECKING, Final

from ..._support.errors import FieldDataError, ParameterError
from ..._support.staging import cannot_write, write_file
from ..._support.units import DEGREE
from ..._support.user_files import read_record
from ...replay.replay import measured_track
from ...track.read import SUFFIXES, read_track
from ...track.slope_frame import in_slope_frame
from ..number_input import typed_number
from ..page_addresses import plain_stem

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    from ...replay.replay import Replay, ReplayTrack
    from ...track.track import Track

    Count: TypeAlias = Callable[[Path, "Placing"], int]
    Read: TypeAlias = Callable[[Path, "Placing", float | None], ReplayTrack]

FOLDER: Final = "tracks"
ABOUT: Final = "about.json"
LARGEST_BYTES: Final = 20_000_000
"""Of one track (modelling assumption): an hour at 100 points a second as GPX."""
MOST_POINTS: Final = 20_000
MOST: Final = 200
LONGEST_WAIT_S: Final = 36_000.0
_CHUNK: Final = 1 << 18
_FILE: Final = "track"


@dataclass(frozen=True, slots=True)
class Placing:
    """What puts a track beside a run.

    Attributes
    ----------
    called
        The name of the file that was uploaded.
    fall_line_azimuth_deg
        Compass direction of the fall line; None: the track is in the axes of the slope already.
    starts_at_s
        Time of the run at the track's first point.
    """

    called: str
    fall_line_azimuth_deg: float | None = None
    starts_at_s: float = 0.0


class TrackFolders:
    """The uploaded tracks of a lab, each in a folder of its own."""

    def __init__(self, runs: Path) -> None:
        self._folder = runs / FOLDER

    def names(self) -> list[str]:
        """Of all tracks, the newest first."""
        found = sorted(self._folder.glob(f"*/{ABOUT}"), key=lambda place: -place.stat().st_mtime)
        return [place.parent.name for place in found if not place.parent.name.startswith(".")]

    def keep(self, content: IO[bytes], placing: Placing, *, count: Count | None = None) -> tuple[str, int]:
        """Keep a track that can be read and placed; gives its name and how many points it has.

        Parameters
        ----------
        content
            The file.
        placing
            What puts it beside a run.
        count
            How it is looked at; None: `points_of_track`, here.

        Raises
        ------
        ParameterError
            It is too large, there are too many, a number is not allowed, or it cannot be placed on a slope.
        FieldDataError
            It cannot be read as a track.
        OutputError
            The folder cannot be written.
        """
        _require(placing)
        if len(self.names()) >= MOST:
            raise ParameterError(f"{MOST} tracks are kept already; take some out of the folder {FOLDER} of the lab")
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            made = Path(mkdtemp(prefix=".partial-", dir=self._folder))
        except OSError as error:
            raise cannot_write(self._folder, error) from error
        try:
            suffix = PurePosixPath(placing.called.lower()).suffix
            place = made / (_FILE + (suffix if suffix in SUFFIXES else ""))
            _copy(content, place)
            n_points = (count or points_of_track)(place, placing)
            write_file(made / ABOUT, json.dumps(asdict(placing), ensure_ascii=False, indent=1))
            name = f"{plain_stem(placing.called, 'track')}-{secrets.token_hex(2)}"
            made.rename(self._folder / name)
        finally:
            shutil.rmtree(made, ignore_errors=True)
        return name, n_points

    def beside(self, name: str, replay: Replay, *, read: Read | None = None) -> ReplayTrack:
        """A track in the axes of a run.

        Parameters
        ----------
        name
            One of `names`.
        replay
            The run.
        read
            How it is read; None: `track_on_slope`, here.

        Raises
        ------
        ParameterError
            There is no such track, or it cannot be placed.
        """
        if name not in self.names():
            raise ParameterError(f"there is no track {name!r} here. Choose one from the list")
        placing = read_record(self._folder / name / ABOUT, Placing)
        _require(placing)
        places = [each for each in (self._folder / name).iterdir() if each.name != ABOUT]
        if len(places) != 1:
            raise ParameterError(f"the folder of the track {name} is damaged. Remove it and upload the track again")
        angle = replay.tilt if replay.profile is None else None
        return (read or track_on_slope)(places[0], placing, angle)


def points_of_track(place: Path, placing: Placing) -> int:
    """The number of points of a track that can be drawn beside a run; errors as in `TrackFolders.keep`."""
    track = _placed(_read(place, placing), placing, slope_angle=0.0)
    _require_few(track)
    measured_track(track)  # it has places enough
    return len(track.time)


def track_on_slope(place: Path, placing: Placing, slope_angle: float | None) -> ReplayTrack:
    """A track in the axes of a slope; its angle (rad), None on a profile. Errors as in `TrackFolders.keep`."""
    track = _placed(_read(place, placing), placing, slope_angle=slope_angle)
    _require_few(track)
    return measured_track(track, starts_at=placing.starts_at_s)


def _require(placing: Placing) -> None:
    azimuth, start = placing.fall_line_azimuth_deg, placing.starts_at_s
    if azimuth is not None and not -360.0 <= azimuth <= 360.0:
        raise ParameterError(f"the fall line's direction is {azimuth:g}°; it must be from −360 to 360")
    if not abs(start) <= LONGEST_WAIT_S:
        raise ParameterError(
            f"the start of the track is {start:g} s; it must be within {LONGEST_WAIT_S:g} s of the run's"
        )


def _require_few(track: Track) -> None:
    if len(track.time) > MOST_POINTS:
        raise ParameterError(
            f"{track.name} has {len(track.time)} points; at most {MOST_POINTS} are drawn beside a run. Cut the turn out"
        )


def _copy(content: IO[bytes], place: Path) -> None:
    taken = 0
    with place.open("xb") as file:
        while piece := content.read(_CHUNK):
            taken += len(piece)
            if taken > LARGEST_BYTES:
                raise ParameterError(f"a track of more than {LARGEST_BYTES // 1_000_000} MB is not taken in")
            file.write(piece)


def _read(place: Path, placing: Placing) -> Track:
    """The track under the name that it was uploaded with."""
    try:
        return replace(read_track(place), name=placing.called)
    except FieldDataError as error:
        said = str(error).replace(str(place), placing.called).replace(place.name, placing.called)
        raise ParameterError(said) from error


def _placed(track: Track, placing: Placing, *, slope_angle: float | None) -> Track:
    """In the axes of a slope; a track in latitude and longitude has its first point at 0, where a run begins."""
    azimuth = placing.fall_line_azimuth_deg
    if azimuth is None:
        if track.axes == "east_north_up":
            raise ParameterError(
                f"{placing.called} is in latitude and longitude: say in which compass direction the slope falls"
            )
        return track
    if track.axes == "slope":
        raise ParameterError(f"{placing.called} is in the axes of the slope already: leave the direction out")
    return in_slope_frame(track, fall_line_azimuth=azimuth * DEGREE, slope_angle=slope_angle, missing_height="on_slope")


def number_of(text: str, words: str) -> float | None:
    """A number as it was typed into a form, None where nothing was.

    Raises
    ------
    ParameterError
        It is none.
    """
    return typed_number(words, text) if text.strip() else None
