"""One case: read a mutated file, and name what went wrong."""

import contextlib
import io
import shutil
import time
import traceback
import warnings
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import skisnow
from skisnow._support import errors
from skisnow._support.errors import SkisnowError

from .reader import Reader

SLOW_S: Final = 5.0
MOST_GROWTH_MB: Final = 1000.0
_ROOT: Final = Path(skisnow.__file__).parent
OWN_WARNINGS: Final = tuple(
    each for each in vars(errors).values() if isinstance(each, type) and issubclass(each, Warning)
)


@dataclass(frozen=True, slots=True)
class Fault:
    """Fault of a case.

    Attributes
    ----------
    reader, number
        The case.
    kind
        traceback, warning (of a library), slow, memory, hang or crash.
    what
        Error and message, seconds, or megabytes.
    where
        The innermost line of skisnow.
    """

    reader: str
    number: int
    kind: str
    what: str
    where: str = ""

    def as_row(self) -> dict[str, Any]:
        """For the file of rows."""
        return {"row": "fault", **asdict(self)}


@dataclass(frozen=True, slots=True)
class Outcome:
    """Outcome of a case: faults, true if the file was read, the processor time (s)."""

    faults: tuple[Fault, ...]
    was_read: bool
    seconds: float


def run_case(reader: Reader, number: int, folder: Path) -> Outcome:
    """Lay the files of a case into an empty folder and read them, in this process."""
    reader.lay(folder, reader.mutated(number))
    try:
        return read_case(reader, number, folder)
    finally:
        clear(folder)


def read_case(reader: Reader, number: int, folder: Path) -> Outcome:
    """Read files that were laid."""
    faults: list[Fault] = []
    before = _resident_mb("VmRSS", reset=True)
    begin = time.process_time()
    was_read = False
    with warnings.catch_warnings(record=True) as caught, contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("always")
        try:
            reader.read(folder)
            was_read = True
        except SkisnowError as error:
            if not str(error).strip():
                faults.append(Fault(reader.name, number, "traceback", "an error without a message", _place(error)))
        except (Exception, RecursionError) as error:
            what = f"{type(error).__name__}: {error}"[:300]
            faults.append(Fault(reader.name, number, "traceback", what, _place(error)))
    seconds = time.process_time() - begin
    growth = _resident_mb("VmHWM") - before
    faults += [
        Fault(reader.name, number, "warning", f"{each.category.__name__}: {each.message}"[:200], _line(each))
        for each in {str(each.message): each for each in caught}.values()
        if not issubclass(each.category, (*OWN_WARNINGS, DeprecationWarning))
    ]
    if seconds > SLOW_S:
        faults.append(Fault(reader.name, number, "slow", f"{seconds:.1f} s"))
    if growth > MOST_GROWTH_MB:
        faults.append(Fault(reader.name, number, "memory", f"{growth:.0f} MB"))
    return Outcome(tuple(faults), was_read, seconds)


def clear(folder: Path) -> None:
    """Empty a folder, whatever a case has left in it."""
    for each in folder.iterdir():
        if each.is_dir() and not each.is_symlink():
            shutil.rmtree(each, ignore_errors=True)
        else:
            each.unlink(missing_ok=True)


def reproduced(reader: Reader, number: int) -> str:
    """The full traceback of a case, for a person who looks for the cause."""
    with TemporaryDirectory() as name:
        reader.lay(Path(name), reader.mutated(number))
        try:
            return f"read: {reader.read(Path(name))!r}"[:2000]
        except BaseException:
            return traceback.format_exc()


def _place(error: BaseException) -> str:
    """The innermost line of skisnow in a traceback; otherwise the deepest line."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [each for each in frames if Path(each.filename).is_relative_to(_ROOT)] or list(frames)
    last = own[-1]
    return f"{Path(last.filename).name}:{last.lineno} {last.name}"


def _line(caught: warnings.WarningMessage) -> str:
    return f"{Path(caught.filename).name}:{caught.lineno}"


def _resident_mb(key: str, *, reset: bool = False) -> float:
    """Of this process; 0 where the system does not say. `reset` clears the peak."""
    try:
        if reset:
            Path("/proc/self/clear_refs").write_text("5")
        words = Path("/proc/self/status").read_text().split()
        return int(words[words.index(f"{key}:") + 1]) / 1024
    except (OSError, ValueError):
        return 0.0
