"""Uploaded files: checked names, counted sizes, and reading in separate processes with limits; a worker process."""

from __future__ import annotations

import asyncio
import contextlib
import io
import logging
import multiprocessing
import os
import signal
import stat
import sys
import threading
import traceback
import zipfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection, wait
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import IO, Final, ParamSpec, TypeVar

from starlette.responses import Response

from .._support.errors import FieldDataError, OutputError, ParameterError, SkisnowError, StoreError
from .._support.messages import Message, joined
from .._support.processes.starting import worker_context
from .._support.user_files.text_files import shown
from ..campaign.reading.campaign_file import CAMPAIGN_FILE
from ..campaign.reading.campaign_files import CampaignFiles
from ..campaign.reading.workbook_files import unfold_workbooks
from ..campaign.store import Store
from ..campaign.store.folder import unsafe_because
from ..campaign.store.server import StorePlace
from .settings import Limits

CHUNK_BYTES: Final = 1 << 18

_METHODS: Final = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_DAMAGED: Final = Message("the zip file is damaged or of a kind that is not read; pack the folder again")


class Unpacking:
    """Writer of uploaded files to a folder, within the limits and never outside of the folder."""

    def __init__(self, folder: Path, limits: Limits) -> None:
        self.folder = folder
        self.limits = limits
        self._bytes = 0
        self._files = 0

    def take(self, name: str, content: IO[bytes]) -> None:
        """Write one uploaded file; ParameterError if its name is unsafe or exists, or a limit is exceeded."""
        self._write_file(name, iter(lambda: content.read(CHUNK_BYTES), b""))

    def take_zip(self, packed: IO[bytes]) -> None:
        """Unpack an uploaded zip file; errors as in `take`, and for a damaged or encrypted file or one with links."""
        with _damage_errors():
            archive = zipfile.ZipFile(packed)
        with archive:
            members = [member for member in archive.infolist() if not member.filename.endswith("/")]
            if len(members) > self.limits.files:
                raise self._too_many_files()
            if not all(map(_is_plain, members)):
                raise ParameterError(_DAMAGED).tag("damaged")
            for member in members:
                self._write_file(member.filename, _unpacked_pieces(archive, member))

    def _write_file(self, name: str, pieces: Iterable[bytes]) -> None:
        """Write an uploaded file; ParameterError if its name is unsafe or exists, or a limit is exceeded."""
        path = name.replace("\\", "/")
        if (why := unsafe_because(path, for_windows=True)) is not None:
            raise ParameterError("the file {file} is not accepted: {why}").tag(
                "not_taken_in", file=repr(shown(name, 79)), why=why
            )
        place = self.folder.joinpath(*PurePosixPath(path).parts)
        self._files += 1
        if self._files > self.limits.files:
            raise self._too_many_files()
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            with place.open("xb") as file:
                for piece in pieces:
                    self._bytes += len(piece)
                    if self._bytes > self.limits.unpacked_bytes:
                        raise ParameterError("more than {most} bytes at once are not accepted").tag(
                            "too_large", most=self.limits.unpacked_bytes
                        )
                    file.write(piece)
        except (FileExistsError, NotADirectoryError) as error:
            raise ParameterError("two files of the upload are called {file}").tag(
                "same_name", file=repr(shown(name, 79))
            ) from error

    def _too_many_files(self) -> ParameterError:
        """Error for more files than are accepted at once."""
        most = self.limits.files
        return ParameterError("more than {most} files at once are not accepted").tag("too_many_files", most=most)


def _is_plain(member: zipfile.ZipInfo) -> bool:
    """True if a member of a zip is a file, no link, not encrypted, and packed without compression or by deflate."""
    is_file = stat.S_IFMT(member.external_attr >> 16) in (0, stat.S_IFREG)
    return is_file and not member.flag_bits & 1 and member.compress_type in _METHODS


def _unpacked_pieces(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> Iterator[bytes]:
    """Bytes of a zip's member piece by piece; damage becomes a ParameterError."""
    with _damage_errors():
        content = archive.open(member)
    with content:
        while True:
            with _damage_errors():
                piece = content.read(CHUNK_BYTES)
            if not piece:
                return
            yield piece


@contextmanager
def _damage_errors() -> Iterator[None]:
    """Convert errors of zipfile for a damaged file, of many types, to a ParameterError."""
    try:
        yield
    except Exception as error:
        raise ParameterError(_DAMAGED).tag("damaged") from error


def campaign_folder(folder: Path) -> Path:
    """Folder with the campaign's files: the unpacked folder, or the only folder in it."""
    inside = list(folder.iterdir())
    while len(inside) == 1 and inside[0].is_dir():
        folder = inside[0]
        inside = list(folder.iterdir())
    return folder


def zip_of(files: Iterable[tuple[str, bytes]]) -> bytes:
    """Bytes of a zip of files, given by name and content."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files:
            archive.writestr(name, content)
    return packed.getvalue()


def zip_of_campaign(write: Callable[[Path], None], *, report: Path | None = None) -> bytes:
    """Bytes of a zip of a campaign, which ``write`` writes into a folder, and of the files in the folder ``report``."""
    with TemporaryDirectory(prefix="skisnow-export-") as name:
        folder = Path(name) / "campaign"
        write(folder)
        return zip_of(files_below(folder, under="campaign") + (files_below(report, under="analysis") if report else []))


def zip_download(content: bytes, name: str) -> Response:
    """Answer with a zip that the browser saves under a name."""
    headers = {"content-disposition": f'attachment; filename="{name}"'}
    return Response(content, media_type="application/zip", headers=headers)


def files_below(folder: Path, *, under: str = "") -> list[tuple[str, bytes]]:
    """Paths and contents of all files below a folder, for a zip."""
    paths = sorted(path for path in folder.rglob("*") if path.is_file())
    prefix = f"{under}/" if under else ""
    return [(prefix + path.relative_to(folder).as_posix(), path.read_bytes()) for path in paths]


UNDESCRIBED: Final = Message(
    "there is no campaign.toml in it, nor a workbook (.xlsx) with the sheets campaign, tools and plates; choose the "
    "folder of a campaign, a zip of it, or such a workbook. For existing tables, skisnow new campaign FOLDER "
    "writes a campaign.toml to be filled in"
)


def add_uploaded(store: StorePlace, place: str, names: Sequence[str], limits: Limits) -> str:
    """Store a campaign of uploaded files, numbered in a folder; returns its id. ParameterError if it is not valid."""
    unpacking = Unpacking(Path(place) / "campaign", limits)
    unpacking.folder.mkdir()
    for number, name in enumerate(names):
        with (Path(place) / str(number)).open("rb") as file:
            (unpacking.take_zip if name.lower().endswith(".zip") else partial(unpacking.take, name))(file)
    folder = campaign_folder(unpacking.folder)
    files = unfold_workbooks(CampaignFiles(folder))
    if CAMPAIGN_FILE not in files.names():
        problems = files.problems
        raise ParameterError(joined([problems[0].value, problems[0].action], ". ") if problems else UNDESCRIBED).tag(
            "no_campaign"
        )
    with Store.open(store) as opened:
        return opened.add(folder).id


Given = ParamSpec("Given")
Answer = TypeVar("Answer")


_LOG: Final = logging.getLogger("skisnow.web")
_LAST_WORDS: Final = 4000


@dataclass(frozen=True, slots=True)
class Bounds:
    """Limits on time and memory; a campaign with a million readings takes 20 s and 1 GB on a laptop."""

    seconds: float = 120.0
    memory_bytes: int = 3_000_000_000


BOUNDS: Final = Bounds()
SKI_BOUNDS: Final = Bounds(seconds=60.0)  # most of it is the start of the process, on a busy laptop


def confined(bounds: Bounds, work: Callable[Given, Answer], *args: Given.args, **named: Given.kwargs) -> Answer:
    """Call a function of a module in a separate process with limits; arguments and result are copies.

    Raises ParameterError: the function exceeds the limits or ends its process. Errors of the function are raised here,
        too.
    """
    assert not named
    context = worker_context()
    hears, tells = context.Pipe(duplex=False)
    process = context.Process(target=_run_confined, args=(tells, bounds, work, args), daemon=True)
    process.start()
    tells.close()
    try:
        if not hears.poll(bounds.seconds):
            raise ParameterError("it was not read within {seconds:g} s; give less of it, or check the file").tag(
                "too_slow", seconds=bounds.seconds
            )
        answer, trace = hears.recv()
    except EOFError as end:
        raise _limit_error(bounds) from end
    finally:
        process.kill()
        process.join()
        hears.close()
    if trace:
        _LOG.error("an upload could not be read: %s", trace)
    if isinstance(answer, SkisnowError):
        raise answer
    result: Answer = answer
    return result


def _limit_error(bounds: Bounds) -> ParameterError:
    """Error that reading an upload ended its process, or took more time or memory than allowed."""
    return ParameterError(
        "reading it failed: it is damaged, nested too deep, or takes more than {seconds:g} s and {megabytes} MB; "
        "check the file"
    ).tag("cannot_read", seconds=bounds.seconds, megabytes=bounds.memory_bytes // 1_000_000)


def _run_confined(tells: Connection, bounds: Bounds, work: Callable[..., object], args: tuple[object, ...]) -> None:
    """Function of the new process: set limits, call the function, send the result."""
    end_with_server()
    _set_limits(bounds)
    answer: tuple[object, str]
    try:
        answer = (work(*args), "")
    except (FieldDataError, StoreError, OutputError) as error:
        answer = (error, "")
    except SkisnowError as error:
        answer = (ParameterError(error.message).tag(error.code), "")
    except Exception:  # logged by the server
        answer = (_limit_error(bounds), traceback.format_exc()[-_LAST_WORDS:])
    tells.send(answer)


def _set_limits(bounds: Bounds) -> None:
    """Set the limits of the operating system if it has them; the caller limits the time as well."""
    if sys.platform == "win32":
        return
    import resource

    seconds = int(bounds.seconds) + 1
    limits = ((resource.RLIMIT_CPU, seconds), (resource.RLIMIT_DATA, bounds.memory_bytes), (resource.RLIMIT_CORE, 0))
    for kind, most in limits:
        with contextlib.suppress(ValueError, OSError):  # already lower, or not supported
            resource.setrlimit(kind, (most, most))


class Worker:
    """Worker process for one task after another, started for the first one."""

    def __init__(self) -> None:
        self._pool: ProcessPoolExecutor | None = None

    async def do(self, work: Callable[Given, Answer], *args: Given.args, **named: Given.kwargs) -> Answer:
        """Call a function of a module in the worker process; arguments and result are copies."""
        if self._pool is None:
            self._pool = ProcessPoolExecutor(1, mp_context=worker_context(), initializer=end_with_server)
        return await asyncio.wrap_future(self._pool.submit(work, *args, **named))

    def end(self) -> None:
        """End the process after its current task; waiting tasks are cancelled."""
        if self._pool is not None:
            self._pool.shutdown(wait=True, cancel_futures=True)


def end_with_server() -> None:
    """Prepare a worker process: it ignores Ctrl-C, which the server handles, and ends with the server."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    assert parent is not None

    def watch() -> None:
        wait([parent.sentinel])
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
