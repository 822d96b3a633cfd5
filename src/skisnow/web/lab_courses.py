"""Courses of the lab: those that come with skisnow, and those that were uploaded, never overwritten."""

from __future__ import annotations

import secrets
from pathlib import Path, PurePosixPath
from typing import IO, TYPE_CHECKING, Final
from urllib.parse import quote

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData, UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from .._support.errors import ParameterError, SkisnowError
from .._support.staging import cannot_write, write_file
from ..track.course import course_names, read_course
from .error_pages import error_sentence, plain_page
from .page_addresses import plain_stem
from .subprocesses import BOUNDS, confined

if TYPE_CHECKING:
    from fastapi import FastAPI

FOLDER: Final = "courses"
SUFFIXES: Final = (".csv", ".gpx")
UPLOAD: Final = "/simulate/course"
LARGEST_BYTES: Final = 1_000_000
"""Of one course (modelling assumption): ten thousand gates."""
MOST: Final = 200


class LabCourses:
    """Uploaded courses, each a file."""

    def __init__(self, runs: Path) -> None:
        self._folder = runs / FOLDER

    def kept(self) -> list[str]:
        """Names of the uploaded ones, the newest first."""
        found = [place for place in self._folder.glob("[!.]*") if place.suffix in SUFFIXES]
        return [place.name for place in sorted(found, key=lambda place: -place.stat().st_mtime)]

    def names(self) -> list[str]:
        """Names of all, those that come with skisnow first."""
        return [*course_names(), *self.kept()]

    def change(self, name: str) -> tuple[str, str]:
        """The key and the word that give a scenario this course.

        Raises
        ------
        ParameterError
            There is no such course.
        """
        if name in course_names():
            return "course.name", name
        if name not in self.kept():
            raise ParameterError(f"the lab has no course named {name!r}. Choose one from the list")
        return "course.file", str((self._folder / name).absolute())

    def keep(self, called: str, content: IO[bytes]) -> str:
        """Keep a course that can be read; gives its name.

        Raises
        ------
        ParameterError
            It is no course, too large, or there are too many.
        OutputError
            The folder cannot be written.
        """
        suffix = PurePosixPath(called.lower()).suffix
        if suffix not in SUFFIXES:
            raise ParameterError(f"{called} is no course: choose a .csv or .gpx file")
        if len(self.kept()) >= MOST:
            raise ParameterError(f"{MOST} courses are kept already; take some out of the folder {FOLDER} of the lab")
        data = content.read(LARGEST_BYTES + 1)
        if len(data) > LARGEST_BYTES:
            raise ParameterError(f"a course of more than {LARGEST_BYTES // 1_000_000} MB is not taken in")
        place = self._folder / f"{plain_stem(called, 'course')}-{secrets.token_hex(2)}{suffix}"
        made = place.with_name(f".partial-{place.name}")
        write_file(made, data)
        try:
            confined(BOUNDS, gates_of, made)
            made.rename(place)
        except OSError as error:
            raise cannot_write(place, error) from error
        except ParameterError as error:
            raise ParameterError(str(error).replace(str(made), called).replace(made.name, called)) from error
        finally:
            made.unlink(missing_ok=True)
        return place.name


def gates_of(place: Path) -> int:
    """How many gates a course has; errors as `skisnow.read_course`."""
    return len(read_course(place).gates)


def add_course_uploads(app: FastAPI, courses: LabCourses) -> None:
    """Let an application take courses in. Where a request may come from is held by the guard around it."""

    async def take_in(request: Request) -> Response:
        try:
            async with request.form(max_files=1, max_fields=2) as form:
                name = await run_in_threadpool(_kept, courses, form)
        except (SkisnowError, OSError) as error:
            return plain_page("This was not taken in", f"Nothing was stored: {error_sentence(error)}", 400, request)
        except HTTPException:
            return plain_page(
                "This was not taken in", "Nothing was stored: one file at a time is taken in.", 400, request
            )
        return RedirectResponse(f"/simulate?course={quote(name, safe='')}", 303)

    app.add_api_route(UPLOAD, take_in, methods=["POST"], include_in_schema=False, response_model=None)


def _kept(courses: LabCourses, form: FormData) -> str:
    upload = form.get("file")
    if not isinstance(upload, UploadFile) or not upload.filename:
        raise ParameterError("no file was chosen; choose the file of a course")
    return courses.keep(upload.filename[:200], upload.file)
