"""Addresses of the replay: program, bytes of a run, model, page, and upload of a measured track."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final
from urllib.parse import quote

from jinja2 import Environment, PackageLoader, StrictUndefined
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData, UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, PlainTextResponse, RedirectResponse, Response

from ..._support.errors import ParameterError, SkisnowError
from ..._support.language import ENGLISH, catalogue
from ..._support.user_files import read_json
from ...replay.binary import replay_bytes
from ...replay.model import moving_replay_model, replay_model
from ...replay.page import MODULES, STYLE, in_language, page_words, static_text
from ...replay.run_file import RUN_FILE, replay_of_file
from ...report.race.folder import gaps_of_folders
from ...ski import read_ski
from ..error_pages import error_sentence, plain_page
from ..language import language_of_request
from ..runs import JOB
from ..subprocesses import BOUNDS, confined
from .tracks import Placing, TrackFolders, number_of, points_of_track, track_on_slope

if TYPE_CHECKING:
    from fastapi import FastAPI

    from ...replay.replay import Replay
    from ...ski import Ski

LIST: Final = "/replay"
SHOW: Final = f"{LIST}/show"
GATES: Final = f"{LIST}/gates"
FILES: Final = f"{LIST}/files"
DATA: Final = f"{LIST}/data"
MODEL: Final = f"{LIST}/model"
MOVING_MODEL: Final = f"{LIST}/moving-model"
_TYPES: Final = {".js": "text/javascript", ".css": "text/css"}
_LARGEST_FACTOR: Final = 20.0


@dataclass(frozen=True, slots=True)
class RunFolders:
    """Runs kept in a folder, each in a folder of its own with a run.nc in it, known by that folder's name."""

    folder: Path

    def names(self) -> list[str]:
        """Of all runs, the newest first."""
        if not self.folder.is_dir():
            return []
        found = [place for place in self.folder.iterdir() if (place / RUN_FILE).is_file()]
        return [place.name for place in sorted(found, key=lambda place: -(place / RUN_FILE).stat().st_mtime)]

    def place(self, name: str) -> Path:
        """The folder of a run; a name that is none of `names` is refused, wherever it would lead.

        Raises
        ------
        ParameterError
            There is no such run.
        """
        if name not in self.names():
            raise ParameterError(f"there is no run {name!r} here. Choose one from the list")
        return self.folder / name

    def replay(self, name: str, track: str = "") -> Replay:
        """The replay of a run, with a measured track beside it where one is named.

        The ski of a run of the lab is where its job says: the run itself knows the name alone. The track, which was
        uploaded, is read in a process of its own.

        Raises
        ------
        ParameterError
            There is no such run, or it cannot be shown.
        """
        place = self.place(name)
        ski = _ski_of_job(place / JOB)
        alone = replay_of_file(place, title=name, ski=ski)
        if not track:
            return alone
        beside = TrackFolders(self.folder).beside(
            track, alone, read=lambda *what: confined(BOUNDS, track_on_slope, *what)
        )
        return replay_of_file(place, title=name, ski=ski, track=beside)


def _ski_of_job(job: Path) -> Ski | None:
    try:
        word = read_json(job)["changes"]["ski.file"]
    except (ValueError, KeyError, TypeError):
        return None  # a run from the command line, or one with a ski of the catalogue
    return read_ski(Path(word))


def add_addresses(app: FastAPI, runs: RunFolders) -> None:
    """Let an application answer for the replays of these runs."""

    def show(request: Request, run: str, ghost: str = "", track: str = "") -> Response:
        try:
            for name in (run, ghost) if ghost else (run,):
                runs.place(name)
        except ParameterError as error:
            return PlainTextResponse(str(error), 404)
        return HTMLResponse(show_page(run, ghost or None, track, language_of_request(request)))

    def data(request: Request, name: str, track: str = "") -> Response:
        try:
            content = replay_bytes(in_language(runs.replay(name, track), language_of_request(request)))
        except ParameterError as error:
            return PlainTextResponse(str(error), 404)
        return Response(content, media_type="application/octet-stream", headers={"cache-control": "no-cache"})

    def model(name: str, time: float = 0.0, exaggeration: float = 1.0) -> Response:
        try:
            content = replay_model(runs.replay(name), time, exaggeration=_possible(exaggeration))
        except ParameterError as error:
            return PlainTextResponse(str(error), 404)
        return _model_file(content, f"{name}-{time:.2f}s")

    def moving_model(name: str, exaggeration: float = 1.0) -> Response:
        try:
            content = moving_replay_model(runs.replay(name), exaggeration=_possible(exaggeration))
        except ParameterError as error:
            return PlainTextResponse(str(error), 404)
        return _model_file(content, name)

    def gates(request: Request, run: str, ghost: str = "") -> Response:
        try:
            page = confined(BOUNDS, gaps_of_folders, runs.place(run), runs.place(ghost), language_of_request(request))
        except ParameterError as error:
            return plain_page("This cannot be shown", f"{str(error)[0].upper()}{str(error)[1:]}.", 404, request)
        return HTMLResponse(page)

    for address, answer in ((SHOW, show), (GATES, gates), (f"{FILES}/{{name}}", program_file)):
        app.add_api_route(address, answer, include_in_schema=False, response_model=None)
    models = ((f"{MODEL}/{{name}}.glb", model), (f"{MOVING_MODEL}/{{name}}.glb", moving_model))
    for address, of_run in ((f"{DATA}/{{name}}", data), *models):
        app.add_api_route(address, of_run, include_in_schema=False, response_model=None)


def _possible(exaggeration: float) -> float:
    """The nearest factor that the page's slider has; 1 for what is no number."""
    return min(max(1.0, exaggeration), _LARGEST_FACTOR)  # in this order: of 1 and nan the first is taken


def _model_file(content: bytes, name: str) -> Response:
    named = f"attachment; filename*=UTF-8''{quote(name, safe='')}.glb"
    return Response(content, media_type="model/gltf-binary", headers={"content-disposition": named})


def program_file(name: str) -> Response:
    """A file of the program in the browser; nothing else of the package is given out."""
    if name not in (*MODULES, STYLE):
        return PlainTextResponse("The replay has no such file.", 404)
    kind = _TYPES[name[name.rindex(".") :]]
    return Response(static_text(name), media_type=kind, headers={"cache-control": "no-cache"})


def show_page(run: str, ghost: str | None, track: str = "", language: str = ENGLISH) -> str:
    """The HTML that fetches a run, a second one to lay over it and a track beside it, by their names."""
    environment = Environment(
        loader=PackageLoader("skisnow.replay", "static"), autoescape=True, undefined=StrictUndefined
    )
    return environment.get_template("show.html").render(
        title=run,
        language=language,
        said=catalogue(language).translated,
        words=page_words(language),
        files=FILES,
        list=LIST,
        run=f"{DATA}/{quote(run)}" + (f"?track={quote(track, safe='')}" if track else ""),
        ghost=f"{DATA}/{quote(ghost)}" if ghost else "",
        model=f"{MODEL}/{quote(run)}.glb",
        moving_model=f"{MOVING_MODEL}/{quote(run)}.glb",
    )


def show_address(run: str, ghost: str | None = None) -> str:
    """Where a run is shown, with a second one over it."""
    return f"{SHOW}?run={quote(run, safe='')}" + (f"&ghost={quote(ghost, safe='')}" if ghost else "")


UPLOAD: Final = "/replay/track"
_BACK: Final = "/replay"


def add_uploads(app: FastAPI, tracks: TrackFolders) -> None:
    """Let an application take tracks in. Where a request may come from is held by the guard around it."""

    async def take_in(request: Request) -> Response:
        try:
            async with request.form(max_files=1, max_fields=4) as form:
                name, _ = await run_in_threadpool(_kept, tracks, form)
        except (SkisnowError, OSError) as error:
            return plain_page("This was not taken in", f"Nothing was stored: {error_sentence(error)}", 400, request)
        except HTTPException:
            text = "Nothing was stored: one file at a time is taken in."
            return plain_page("This was not taken in", text, 400, request)
        return RedirectResponse(f"{_BACK}?track={quote(name, safe='')}", 303)

    app.add_api_route(UPLOAD, take_in, methods=["POST"], include_in_schema=False, response_model=None)


def _kept(tracks: TrackFolders, form: FormData) -> tuple[str, int]:
    upload = form.get("file")
    if not isinstance(upload, UploadFile) or not upload.filename:
        raise ParameterError("no file was chosen; choose the file of a track")
    azimuth = number_of(str(form.get("azimuth", "")), "the direction of the fall line")
    start = number_of(str(form.get("start", "")), "the time at the first point")
    placing = Placing(upload.filename[:200], azimuth, start or 0.0)
    return tracks.keep(upload.file, placing, count=lambda *what: confined(BOUNDS, points_of_track, *what))
