"""What was uploaded is read in a process of its own, with limits on time and memory; it may end that, not the lab."""

from __future__ import annotations

import contextlib
import logging
import multiprocessing
import sys
import traceback
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, ParamSpec, TypeVar

from .._support.errors import FieldDataError, OutputError, ParameterError, SkisnowError, StoreError
from .worker import end_with_the_server

if TYPE_CHECKING:
    from collections.abc import Callable
    from multiprocessing.connection import Connection

Given = ParamSpec("Given")
Answer = TypeVar("Answer")

_PLAIN: Final = (StoreError, OutputError)
_LOG: Final = logging.getLogger("skisnow.web")
_LAST_WORDS: Final = 4000


@dataclass(frozen=True, slots=True)
class Bounds:
    """What reading may take (assumption: the largest campaign foreseen takes 20 s and 1 GB on a field laptop)."""

    seconds: float = 120.0
    memory_bytes: int = 3_000_000_000


BOUNDS: Final = Bounds()
OF_A_SKI: Final = Bounds(seconds=60.0)  # most of it is the start of the process, on a busy laptop


def confined(bounds: Bounds, work: Callable[Given, Answer], *args: Given.args, **named: Given.kwargs) -> Answer:
    """Call a function of a module in a process of its own; arguments and answer are sent as copies.

    Raises
    ------
    ParameterError
        It takes more than the bounds allow, or ended its process. What it raises itself is raised here, too.
    """
    assert not named
    context = multiprocessing.get_context("spawn")  # never by fork: the server has threads
    hears, tells = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(tells, bounds, work, args), daemon=True)
    process.start()
    tells.close()
    try:
        if not hears.poll(bounds.seconds):
            raise ParameterError(f"it was not read within {bounds.seconds:g} s; give less of it, or check the file")
        kind, answer, trace = hears.recv()
    except EOFError as end:
        raise ParameterError(_ended(bounds)) from end
    finally:
        process.kill()
        process.join()
        hears.close()
    if trace:
        _LOG.error("an upload could not be read: %s", trace)
    if kind is not None:
        raise kind(answer)
    found: Answer = answer
    return found


def _ended(bounds: Bounds) -> str:
    allowed = f"{bounds.seconds:g} s and {bounds.memory_bytes // 1_000_000} MB"
    return f"reading it failed: it is damaged, nested too deep, or takes more than {allowed}; check the file"


def _work(tells: Connection, bounds: Bounds, work: Callable[..., object], args: tuple[object, ...]) -> None:
    """In the new process: bind it, do the work, tell what came of it."""
    end_with_the_server()
    _bind(bounds)
    answer: tuple[type[SkisnowError] | None, object, str]
    try:
        answer = (None, work(*args), "")
    except FieldDataError as error:
        answer = (FieldDataError, [str(error)], "")
    except SkisnowError as error:
        kind = type(error) if type(error) in _PLAIN else ParameterError
        answer = (kind, str(error), "")
    except Exception:  # told by the server, which has the log
        answer = (ParameterError, _ended(bounds), traceback.format_exc()[-_LAST_WORDS:])
    tells.send(answer)


def _bind(bounds: Bounds) -> None:
    """Limits of the system, where it has such; the time is watched from outside as well."""
    if sys.platform == "win32":
        return
    import resource

    seconds = int(bounds.seconds) + 1
    limits = ((resource.RLIMIT_CPU, seconds), (resource.RLIMIT_DATA, bounds.memory_bytes), (resource.RLIMIT_CORE, 0))
    for kind, most in limits:
        with contextlib.suppress(ValueError, OSError):  # lower already, or not known to this system
            resource.setrlimit(kind, (most, most))
