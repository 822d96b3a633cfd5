"""Addresses of the replay: scripts, data of runs, pages, and upload of measured tracks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial, wraps
from pathlib import Path
from typing import Any, Final
from urllib.parse import quote

from fastapi import FastAPI
from starlette.datastructures import FormData
from starlette.requests import Request
from starlette.responses import HTMLResponse, PlainTextResponse, Response

from .._support.errors import FieldDataError, ParameterError
from .._support.messages import ENGLISH, Message, joined, translations
from .._support.user_files.json_text import read_json, read_record
from .._support.user_files.text_files import ContentError
from ..replay.page import MODULES, STYLE, in_language, page_template, page_words, replay_bytes, static_text
from ..replay.replay import Replay
from ..replay.run_file import RUN_FILE, replay_of_file
from ..report.track.page import file_of_track, page_of_folders, page_of_track, page_of_tracks
from ..report.track.summary import GPX_FILE, TURNS_FILE
from ..ski import Ski, read_ski
from .elements import plain_page
from .lab_tracks import Placing, TrackFolders, check_track, number_of, track_on_slope
from .page_requests import add_upload, address, newest_first, uploaded_files
from .runs import JOB, Job
from .uploads import BOUNDS, confined
from .words import language_of_request

LIST: Final = "/replay"
SHOW: Final = f"{LIST}/show"
GATES: Final = f"{LIST}/gates"
TURNS: Final = f"{LIST}/turns"
TRACK_FILES: Final = {TURNS_FILE: "text/csv", GPX_FILE: "application/gpx+xml"}  # media type of each file of a track
FILES: Final = f"{LIST}/files"
DATA: Final = f"{LIST}/data"
FIRST: Final = f"{LIST}/first"
FIRST_SCRIPT: Final = "/first.js"
FIRST_FILE: Final = Path(__file__).with_name("first_replay.bin.gz")
"""Replay of the first page, which build_backend/write_first_replay.py writes."""
_TYPES: Final = {".js": "text/javascript", ".css": "text/css"}


@dataclass(frozen=True, slots=True)
class RunFolders:
    """Runs in a folder, each in a subfolder with run.nc whose name is that of the run."""

    folder: Path

    def names(self) -> list[str]:
        """Names of all runs, the newest first."""
        return [place.parent.name for place in newest_first(self.folder.glob(f"*/{RUN_FILE}"))]

    def title(self, name: str) -> str:
        """Name under which the lab shows a run, or that of its folder if the lab did not compute it."""
        try:
            return read_record(self.folder / name / JOB, Job).shown_name
        except ContentError:
            return name

    def folder_of(self, name: str) -> Path:
        """Folder of a run; only names of `names` are accepted. Raises ParameterError: the lab has no such run."""
        if name not in self.names():
            raise ParameterError("there is no run {name!r} here. Choose one from the list").tag(
                "unknown_run", name=name
            )
        return self.folder / name

    def replay(self, name: str, track: str = "") -> Replay:
        """Replay of a run, with a measured track if one is named; ParameterError if it cannot be shown."""
        place = self.folder_of(name)
        ski, title = _ski_of_job(place / JOB), self.title(name)
        alone = replay_of_file(place, title=title, ski=ski)
        if not track:
            return alone
        tracks = TrackFolders(self.folder)
        beside = tracks.beside(track, alone, read=lambda *what: confined(BOUNDS, track_on_slope, *what))
        return replay_of_file(place, title=title, ski=ski, track=beside)


def _ski_of_job(job: Path) -> Ski | None:
    """Ski file of a job; None if the run has a ski of the catalogue or no readable job."""
    try:
        word = read_json(job)["changes"]["ski.file"]
    except (ValueError, KeyError, TypeError):
        return None  # a run from the command line, or one with a ski of the catalogue
    return read_ski(Path(word))


def add_addresses(app: FastAPI, runs: RunFolders) -> None:
    """Add pages and data of the replays of these runs to the application."""

    def show(request: Request, run: str, ghost: str = "", track: str = "") -> Response:
        for name in (run, ghost) if ghost else (run,):
            runs.folder_of(name)
        language = language_of_request(request)
        return HTMLResponse(show_page(run, ghost or None, track, language, title=runs.title(run)))

    def data(request: Request, name: str, track: str = "") -> Response:
        content = replay_bytes(in_language(runs.replay(name, track), language_of_request(request)))
        return Response(content, media_type="application/octet-stream", headers={"cache-control": "no-cache"})

    def first() -> Response:
        headers = {"content-encoding": "gzip", "cache-control": "no-cache"}
        return Response(FIRST_FILE.read_bytes(), media_type="application/octet-stream", headers=headers)

    _add_route(app, SHOW, show)
    _add_route(app, FIRST, first)
    _add_route(app, f"{FILES}/{{name}}", program_file)
    _add_route(app, f"{DATA}/{{name}}", data)
    _add_tables(app, runs)


def _add_tables(app: FastAPI, runs: RunFolders) -> None:
    """Add the pages that compare runs or tracks, and the files of a track, to the application."""
    tracks = TrackFolders(runs.folder)

    def gates(request: Request, run: str, ghost: str = "") -> Response:
        folders, titles = map(runs.folder_of, (run, ghost)), (runs.title(run), runs.title(ghost))
        work = partial(page_of_folders, names=titles, back=LIST)
        return HTMLResponse(confined(BOUNDS, work, *folders, language_of_request(request)))

    def turns(request: Request, track: str, other: str = "") -> Response:
        files = map(tracks.file, (track, other) if other else (track,))
        named = [part for path, placing in files for part in (path, placing.called)]
        work: Callable[..., str] = partial(page_of_tracks if other else page_of_track, back=LIST)
        return HTMLResponse(confined(BOUNDS, work, *named, language_of_request(request)))

    def track_file(request: Request, track: str, file: str) -> Response:  # noqa: ARG001 -- of an error page
        if file not in TRACK_FILES:
            return PlainTextResponse("", 404)
        path, placing = tracks.file(track)
        text = confined(BOUNDS, file_of_track, path, placing.called, file)
        named = f"attachment; filename*=UTF-8''{quote(f'{track}-{file}', safe='')}"
        return Response(text, media_type=TRACK_FILES[file], headers={"content-disposition": named})

    _add_route(app, GATES, gates, is_page=True)
    _add_route(app, TURNS, turns, is_page=True)
    _add_route(app, f"{TURNS}/{{file}}", track_file, is_page=True)


def _add_route(app: FastAPI, place: str, answer: Callable[..., Response], *, is_page: bool = False) -> None:
    """Answer an address by a function; its errors are shown as plain text, or on a page in the request's language."""

    @wraps(answer)
    def answered(*arguments: Any, **options: Any) -> Response:
        try:
            return answer(*arguments, **options)
        except (FieldDataError, ParameterError) as error:
            if not is_page:
                return PlainTextResponse(str(error), 404)
            request = options["request"]
            message = joined(error.sentences) if isinstance(error, FieldDataError) else error.message
            sentence = message.text(language_of_request(request)) if isinstance(message, Message) else message
            return plain_page(Message("This cannot be shown"), f"{sentence[0].upper()}{sentence[1:]}.", 404, request)

    app.add_api_route(place, answered, include_in_schema=False, response_model=None)


def program_file(name: str) -> Response:
    """Answer with a script or style sheet of the replay; other files of the package are rejected."""
    if name not in (*MODULES, STYLE):
        return PlainTextResponse(Message("The replay has no such file."), 404)
    kind = _TYPES[name[name.rindex(".") :]]
    return Response(static_text(name), media_type=kind, headers={"cache-control": "no-cache"})


def show_page(run: str, ghost: str | None, track: str = "", language: str = ENGLISH, *, title: str = "") -> str:
    """HTML of the replay of a run, with a second run and a measured track if they are named."""
    return page_template("show.html").render(
        title=title or run,
        language=language,
        said=translations(language).gettext,
        words=page_words(language),
        files=FILES,
        list=LIST,
        run=address(f"{DATA}/{quote(run)}", track=track),
        ghost=f"{DATA}/{quote(ghost)}" if ghost else "",
    )


def show_address(run: str, ghost: str = "") -> str:
    """Address of the replay of a run, with a second run if it is named."""
    return address(SHOW, run=run, ghost=ghost)


TRACK_UPLOAD: Final = f"{LIST}/track"


def add_track_uploads(app: FastAPI, tracks: TrackFolders) -> None:
    """Add the address that receives measured tracks."""

    def store(form: FormData) -> str:
        upload = uploaded_files(form, "file", Message("no file was chosen; choose the file of a track"))[0]
        azimuth = number_of(str(form.get("azimuth", "")), Message("the direction of the fall line"))
        start = number_of(str(form.get("start", "")), Message("the time at the first point"))
        placing = Placing((upload.filename or "")[:200], azimuth, start or 0.0)
        name = tracks.keep(upload.file, placing, check=lambda *what: confined(BOUNDS, check_track, *what))
        return address(LIST, track=name)

    add_upload(app, TRACK_UPLOAD, store, max_fields=4)
