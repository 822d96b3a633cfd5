"""Skis of the lab: those of the catalogue, and those that were edited and saved beside the runs, never overwritten."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory, mkdtemp
from typing import TYPE_CHECKING, Final

from .._support.errors import OutputError, ParameterError
from .._support.staging import cannot_write, write_file
from .._support.user_files import GivenError, toml_values
from ..ski import read_ski, ski_names, write_ski
from ..snow.measured_range import with_range_warnings

if TYPE_CHECKING:
    from ..ski import Ski

FOLDER: Final = "skis"
FILE: Final = "ski.toml"
TABLE: Final = "ski.csv"
NOTHING: Final = "nothing"
EDITED: Final = "the edited ski"
"""What stands between the names of skis in the pages' lists, and so is none."""
_NAME: Final = re.compile(r"[A-Za-z0-9À-ž](?:[A-Za-z0-9À-ž _-]{0,38}[A-Za-z0-9À-ž])?")
_DEVICES: Final = re.compile(r"(?i)con|prn|aux|nul|com[0-9]|lpt[0-9]")
_NAME_LINE: Final = re.compile(r"(?m)^name\s*=.*$")


class LabSkis:
    """Saved skis, each a folder with its file, and a table where it has one."""

    def __init__(self, runs: Path) -> None:
        self._folder = runs / FOLDER

    def saved(self) -> list[str]:
        """Names of the saved ones."""
        return sorted((place.parent.name for place in self._folder.glob(f"*/{FILE}")), key=str.casefold)

    def names(self) -> list[str]:
        """Names of all, the catalogue's first."""
        return [*ski_names(), *(name for name in self.saved() if name not in ski_names())]

    def word(self, name: str) -> str:
        """What names a ski where a ski is asked for: its name, or the path of its file.

        Raises
        ------
        ParameterError
            There is no such ski.
        """
        if name in ski_names():
            return name
        if name not in self.saved():
            raise ParameterError(f"the lab has no ski named {name!r}. Choose one from the list")
        return str((self._folder / name / FILE).absolute())

    def texts(self, name: str) -> tuple[str, str]:
        """The text of a ski's file, and of its table or nothing."""
        place = Path(self.word(name))
        if name in ski_names():
            from importlib.resources import files

            return (files("skisnow.ski") / "catalogue" / f"{name}.toml").read_text(encoding="utf-8"), ""
        table = place.with_name(TABLE)
        return place.read_text(encoding="utf-8"), table.read_text(encoding="utf-8") if table.is_file() else ""

    def save_ski(self, name: str, ski: Ski) -> None:
        """Save a ski as a file with a table; its name must be the one given.

        Raises
        ------
        ParameterError
            The name cannot be a ski's, or there is one of that name.
        OutputError
            The folder cannot be written.
        """
        self._saved(name, lambda folder: write_ski(ski, folder / FILE))

    def save_texts(self, name: str, text: str, table: str) -> None:
        """Save a ski's file as it is written, under a new name; see `save_ski`."""
        line = f"name = {json.dumps(name, ensure_ascii=False)}"
        named = _NAME_LINE.sub(lambda _: line, text, count=1) if _NAME_LINE.search(text) else f"{line}\n{text}"
        ski, _ = ski_of_texts(named, table)
        if ski.name != name:
            raise ParameterError(f"write the name into the file yourself, on a line of its own: {line}")

        def write(folder: Path) -> None:
            write_file(folder / FILE, named)
            if table:
                write_file(folder / TABLE, table)

        self._saved(name, write)

    def require_new(self, name: str) -> None:
        """Refuse a name that is taken or that is no name of a folder everywhere."""
        if not _NAME.fullmatch(name) or _DEVICES.fullmatch(name):
            raise ParameterError("a ski's name has 1 to 40 letters, digits, blanks, - and _; give it another one")
        if name.casefold() in (NOTHING, EDITED):
            raise ParameterError(f"{name} stands for something else in the lists of skis; give this one another name")
        if name.casefold() in (other.casefold() for other in self.names()):
            raise ParameterError(f"there is a ski {name} already, and none is overwritten; give this one another name")

    def _saved(self, name: str, write: Writing) -> None:
        self.require_new(name)
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            made = Path(mkdtemp(prefix=".partial-", dir=self._folder))
        except OSError as error:
            raise cannot_write(self._folder, error) from error
        try:
            write(made)
            made.chmod(0o755)
            made.rename(self._folder / name)  # complete or not there; refused where somebody was quicker
        except OSError as error:
            raise OutputError(f"the ski {name} cannot be saved: {error.strerror or error}. Try another name") from error
        finally:
            shutil.rmtree(made, ignore_errors=True)


def ski_of_texts(text: str, table: str) -> tuple[Ski, str]:
    """The ski of a file's text, and what the reader warned of.

    Raises
    ------
    ParameterError
        As `read_ski`; or the text names a file other than its table, which a page has no business with.
    """
    _require_no_other_file(text)
    with TemporaryDirectory(prefix="skisnow-ski-") as name:
        place = Path(name) / FILE
        place.write_text(text, encoding="utf-8", newline="")
        if table:
            place.with_name(TABLE).write_text(table, encoding="utf-8", newline="")
        try:
            ski, warned = with_range_warnings(lambda: read_ski(place))
        except ParameterError as error:
            raise ParameterError(_without(name, str(error))) from error
    return ski, " ".join(_without(name, each) for each in warned)


def check_ski_texts(text: str, table: str) -> None:
    """Read a ski's file and forget it; errors as in `ski_of_texts`."""
    ski_of_texts(text, table)


def texts_of_ski(ski: Ski) -> tuple[str, str]:
    """A ski as the text of its file and of its table."""
    with TemporaryDirectory(prefix="skisnow-ski-") as name:
        place = Path(name) / FILE
        write_ski(ski, place)
        return place.read_text(encoding="utf-8"), place.with_name(TABLE).read_text(encoding="utf-8")


def _require_no_other_file(text: str) -> None:
    try:
        keys = toml_values(text)
    except GivenError:
        return  # said with its line by the reader
    if "shape" in keys:
        raise ParameterError(
            f"{FILE}: a shape of another program cannot be read here. Use read_ski or the command line"
        )
    if keys.get("table", TABLE) != TABLE:
        raise ParameterError(f'{FILE}: the table of a ski of the lab is in the field below it: write table = "{TABLE}"')


def _without(folder: str, said: str) -> str:
    """A sentence without a folder that is gone when it is read."""
    return said.replace(f"{Path(folder) / 'x'}"[:-1], "").replace(f"{Path(folder).resolve() / 'x'}"[:-1], "")


if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    Writing: TypeAlias = Callable[[Path], None]
