"""Skis of the lab: the catalogue, and skis that users edited, uploaded or measured, never overwritten."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import IO, Any, Final, NamedTuple

from .._support.errors import OutputError, ParameterError
from .._support.messages import Message
from .._support.staging import write_file
from .._support.user_files.text_files import ContentError, toml_text, toml_values
from ..ski import Ski, read_ski, ski_names, write_ski
from ..snow.measured_range import with_range_warnings
from .page_requests import hidden_folder
from .settings import Limits
from .uploads import SKI_BOUNDS, Unpacking, confined
from .words import replaced, typed_number

FOLDER: Final = "skis"
FILE: Final = "ski.toml"
TABLE: Final = "ski.csv"
NOTHING: Final = "nothing"
EDITED: Final = "the edited ski"
"""Entries of the lists of skis, which cannot be names of skis."""
_NAME: Final = re.compile(r"[A-Za-z0-9À-ž](?:[A-Za-z0-9À-ž _-]{0,38}[A-Za-z0-9À-ž])?")
_DEVICES: Final = re.compile(r"(?i)con|prn|aux|nul|com[0-9]|lpt[0-9]")
_NAME_LINE: Final = re.compile(r"(?m)^name\s*=.*$")


def menu_with_nothing(names: Iterable[str]) -> dict[str, str]:
    """Options of a menu of skis to compare with: nothing, and all names."""
    return {NOTHING: Message("nothing"), **{name: name for name in names}}


class LabSkis:
    """Skis of a lab: those of the catalogue, and saved ones, each a folder with a file and an optional table."""

    def __init__(self, runs: Path) -> None:
        self._folder = runs / FOLDER

    def saved(self) -> list[str]:
        """Names of the saved skis."""
        return sorted((place.parent.name for place in self._folder.glob(f"*/{FILE}")), key=str.casefold)

    def names(self) -> list[str]:
        """Names of all skis, first those of the catalogue."""
        return [*ski_names(), *(name for name in self.saved() if name not in ski_names())]

    def word(self, name: str) -> str:
        """Word for a ski in scenarios: its name in the catalogue, or its path; ParameterError for an unknown ski."""
        if name in ski_names():
            return name
        if name not in self.saved():
            raise ParameterError("the lab has no ski named {name!r}. Choose one from the list").tag(
                "unknown_ski", name=name
            )
        return str((self._folder / name / FILE).absolute())

    def texts(self, name: str) -> tuple[str, str]:
        """Texts of a ski's file and of its table ("" without one)."""
        place = Path(self.word(name))
        if name in ski_names():
            from importlib.resources import files

            return (files("skisnow.ski") / "catalogue" / f"{name}.toml").read_text(encoding="utf-8"), ""
        table = place.with_name(TABLE)
        return place.read_text(encoding="utf-8"), table.read_text(encoding="utf-8") if table.is_file() else ""

    def save_texts(self, name: str, text: str, table: str) -> None:
        """Save the texts of a ski's file and table under a new name; ParameterError if one of them is not valid."""
        self.require_new(name)
        line = f"name = {toml_text(name)}"
        named = _NAME_LINE.sub(lambda _: line, text, count=1) if _NAME_LINE.search(text) else f"{line}\n{text}"
        ski, _ = ski_of_texts(named, table)
        if ski.name != name:
            raise ParameterError("write the name into the file yourself, on a separate line: {line}").tag(
                "no_place_for_name", line=line
            )
        with hidden_folder(self._folder) as made:
            try:
                write_file(made / FILE, named)
                if table:
                    write_file(made / TABLE, table)
                made.chmod(0o755)
                made.rename(self._folder / name)  # complete or absent; fails if another request saved the name first
            except OSError as error:
                raise OutputError("the ski {name} cannot be saved: {error}. Try another name").tag(
                    "cannot_write", name=name, error=error.strerror or error
                ) from error

    def require_new(self, name: str) -> None:
        """Reject a name that exists or is not a valid name of a folder on every system."""
        if not _NAME.fullmatch(name) or _DEVICES.fullmatch(name):
            raise ParameterError("a ski's name has 1 to 40 letters, digits, blanks, - and _; give it another one").tag(
                "name_not_allowed"
            )
        if name.casefold() in (NOTHING, EDITED):
            raise ParameterError(
                "{name} already means something else in the lists of skis; give this one another name"
            ).tag("name_not_allowed", name=name)
        if name.casefold() in (other.casefold() for other in self.names()):
            raise ParameterError(
                "there is a ski {name} already, and none is overwritten; give this one another name"
            ).tag("already_there", name=name)


def ski_of_texts(text: str, table: str) -> tuple[Ski, str]:
    """Ski of the texts of a ski file and its table, and warnings of the reader; ParameterError if not valid."""
    with contextlib.suppress(ContentError):  # which the reader reports with its line
        if toml_values(text).get("table", TABLE) != TABLE:
            raise ParameterError(
                '{file}: the table of a ski of the lab is in the field below it: write table = "{table}"'
            ).tag("wrong_table", file=FILE, table=TABLE)
    with TemporaryDirectory(prefix="skisnow-ski-") as name:
        place = Path(name) / FILE
        place.write_text(text, encoding="utf-8", newline="")
        if table:
            place.with_name(TABLE).write_text(table, encoding="utf-8", newline="")
        return _read_in_folder(place)


def _read_in_folder(place: Path) -> tuple[Ski, str]:
    """Ski of the file in a temporary folder, and the reader's warnings as text, which do not name the folder."""
    folder = str(place.parent)
    try:
        ski, warned = with_range_warnings(lambda: read_ski(place))
    except ParameterError as error:
        raise ParameterError(_without_folder(folder, error.message)).tag(error.code) from error
    return ski, " ".join(_without_folder(folder, warning) for warning in warned)


def check_ski_texts(text: str, table: str) -> None:
    """Reject texts of a ski file and its table that are not a valid ski (ParameterError)."""
    ski_of_texts(text, table)


def texts_of_ski(ski: Ski) -> tuple[str, str]:
    """Text of a ski file for a ski, and of the CSV table that it names."""
    with TemporaryDirectory(prefix="skisnow-ski-") as name:
        place = Path(name) / FILE
        write_ski(ski, place)
        return place.read_text(encoding="utf-8"), place.with_name(TABLE).read_text(encoding="utf-8")


def _without_folder(folder: str, message: str) -> str:
    """Copy of a message without the path of a temporary folder, so that only file names are left."""
    return replaced(message, {f"{place / 'x'}"[:-1]: "" for place in (Path(folder), Path(folder).resolve())})


NAME: Final = "name"
LISTS: Final = ("EI_N_m2", "GJ_N_m2")
MEASURED: Final = {
    "length_mm": Message("Length (mm)"),
    "running_length_mm": Message("Running length (mm)"),
    "sidecut_length_mm": Message("Sidecut length (mm)"),
    "tip_width_mm": Message("Width at the tip (mm)"),
    "waist_width_mm": Message("Width at the waist (mm)"),
    "tail_width_mm": Message("Width at the tail (mm)"),
    "mass_kg": Message("Mass of one ski (kg)"),
    "camber_mm": Message("Camber (mm)"),
    "EI_N_m2": Message("EI (N m²) from tip to tail"),
    "GJ_N_m2": Message("GJ (N m²) from tip to tail"),
}
"""Labels of the measured quantities of a ski with three widths."""
OPTIONAL: Final = ("camber_mm",)


class SkiTexts(NamedTuple):
    """A ski as texts: name, ski file, and its table ("" without one)."""

    name: str
    text: str
    table: str


def measured_text(name: str, typed: Mapping[str, str]) -> str:
    """Text of the file of a ski with three measured widths. Raises ParameterError: a field is empty or not a number."""
    values: dict[str, Any] = {NAME: name, "source": "measured, entered in the lab"}
    for key, words in MEASURED.items():
        text = typed.get(key, "")
        if text.strip() or key not in OPTIONAL:
            values[key] = (_numbers if key in LISTS else typed_number)(words, text)
    return "".join(f"{key} = {toml_text(value)}\n" for key, value in values.items())


def _numbers(words: str, text: str) -> list[float]:
    """Numbers separated by blanks or semicolons, with a decimal point or comma."""
    parts = text.replace(";", " ").split()
    return [typed_number(words, part.removesuffix(",")) for part in parts or [""]]


def ski_of_uploads(uploads: Sequence[tuple[str, IO[bytes]]], limits: Limits) -> SkiTexts:
    """Ski of uploaded files by name and content, read in another process; ParameterError unless they are one ski."""
    with TemporaryDirectory(prefix="skisnow-ski-") as folder:
        unpacking = Unpacking(Path(folder) / "ski", limits)
        unpacking.folder.mkdir()
        for name, content in uploads:
            unpacking.take(PurePosixPath(name.replace("\\", "/")).name, content)
        names = sorted(path.name for path in unpacking.folder.iterdir())
        return confined(SKI_BOUNDS, read_ski_files, str(unpacking.folder), names)


def read_ski_files(folder: str, names: Sequence[str]) -> SkiTexts:
    """Ski of uploaded files in a folder, with its texts; rejects more or less than one .toml file."""
    files = [name for name in names if name.lower().endswith(".toml")]
    if len(files) != 1:
        raise ParameterError(
            "choose one ski: its .toml file with the table that it names. “Download the file” on the page gives a "
            "file to begin with"
        ).tag("not_one_ski")
    place = Path(folder) / files[0]
    _require_own_files(place, names)
    ski, _ = _read_in_folder(place)
    text, table = (place.read_text(encoding="utf-8-sig"), "") if len(names) == 1 else texts_of_ski(ski)
    return SkiTexts(ski.name, text, table)


def _require_own_files(place: Path, names: Sequence[str]) -> None:
    """Reject a file that names a file outside the upload."""
    keys = toml_values(place.read_text(encoding="utf-8-sig", errors="replace"))
    if (named := keys.get("table")) is not None and named not in names:
        raise ParameterError("{file}: {key} is {needed!r}; choose that file, too, and name it without a folder").tag(
            "missing_file", file=place.name, key="table", needed=named
        )
