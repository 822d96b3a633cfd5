"""A measured ski comes into the lab: from its files, from a design of MonkeyCAM, or from three widths."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import IO, TYPE_CHECKING, Final

from .._support.errors import ParameterError
from .._support.user_files import toml_values
from ..ski import read_ski
from .confined import OF_A_SKI, confined
from .lab_skis import FILE, texts_of_ski
from .typed import typed_number
from .unpacking import Unpacking

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .lab_skis import LabSkis
    from .settings import Limits

NAME: Final = "name"
LISTS: Final = ("EI_N_m2", "GJ_N_m2")
STIFFNESS: Final = {
    "mass_kg": "Mass of one ski (kg)",
    "camber_mm": "Camber (mm)",
    "EI_N_m2": "EI (N m²) from tip to tail",
    "GJ_N_m2": "GJ (N m²) from tip to tail",
}
"""What the design of a shape does not know, in words."""
MEASURED: Final = {
    "length_mm": "Length (mm)",
    "running_length_mm": "Running length (mm)",
    "sidecut_length_mm": "Sidecut length (mm)",
    "tip_width_mm": "Width at the tip (mm)",
    "waist_width_mm": "Width at the waist (mm)",
    "tail_width_mm": "Width at the tail (mm)",
    **STIFFNESS,
}
"""What three widths leave to be measured, in words."""
OPTIONAL: Final = ("camber_mm",)


@dataclass(frozen=True, slots=True)
class SkiTexts:
    """A ski that was read: the name that it has, the text of its file and of its table, what the reader warned of."""

    name: str
    text: str
    table: str
    warned: str


def measured_text(name: str, typed: Mapping[str, str]) -> str:
    """The file of a ski of which three widths were measured.

    Raises
    ------
    ParameterError
        A field is empty or holds no number.
    """
    return _text({NAME: name, "source": "measured, entered in the lab"}, {key: typed.get(key, "") for key in MEASURED})


def _text(texts: Mapping[str, str], typed: Mapping[str, str]) -> str:
    lines = [f"{key} = {json.dumps(text, ensure_ascii=False)}" for key, text in texts.items()]
    for key, text in typed.items():
        if text.strip() or key not in OPTIONAL:
            lines.append(
                f"{key} = {_numbers(MEASURED[key], text) if key in LISTS else typed_number(MEASURED[key], text)}"
            )
    return "\n".join([*lines, ""])


def _numbers(words: str, text: str) -> list[float]:
    """Several numbers with blanks or semicolons between; a comma between digits is a decimal one."""
    parts = text.replace(";", " ").split()
    return [typed_number(words, part.removesuffix(",")) for part in parts or [""]]


def add_ski(skis: LabSkis, name: str, texts: SkiTexts) -> str:
    """Save a ski that was read, under a name or its own; gives that name.

    Raises
    ------
    ParameterError, OutputError
        See `LabSkis.save_ski`.
    """
    called = " ".join((name or texts.name).split())
    skis.save_texts(called, texts.text, texts.table)
    return called


def ski_of_uploads(uploads: Sequence[tuple[str, IO[bytes]]], further: Mapping[str, str], limits: Limits) -> SkiTexts:
    """Read the files of a ski in a process of its own.

    Parameters
    ----------
    uploads
        Names and contents: a TOML file and what it names, or a design of MonkeyCAM.
    further
        What was typed for a design, by the keys of `STIFFNESS`.
    limits
        Of the upload.

    Raises
    ------
    ParameterError
        There is no ski in them, or not one.
    """
    with TemporaryDirectory(prefix="skisnow-ski-") as folder:
        unpacking = Unpacking(Path(folder) / "ski", limits)
        unpacking.folder.mkdir()
        for name, content in uploads:
            unpacking.take(PurePosixPath(name.replace("\\", "/")).name, content)
        names = sorted(each.name for each in unpacking.folder.iterdir())
        return confined(OF_A_SKI, read_ski_files, str(unpacking.folder), names, dict(further))


def read_ski_files(folder: str, names: Sequence[str], further: Mapping[str, str]) -> SkiTexts:
    """Read what `ski_of_uploads` has put into a folder."""
    files = [name for name in names if name.lower().endswith(".toml")]
    designs = [name for name in names if name.lower().endswith(".json")]
    if not files and len(designs) == 1:
        place = Path(folder) / FILE
        text = _text({"shape": designs[0]}, {key: further.get(key, "") for key in STIFFNESS})
        place.write_text(text, encoding="utf-8", newline="")
    elif len(files) == 1:
        place = Path(folder) / files[0]
        _require_own_files(place, names)
    elif not files and not designs and names:
        raise ParameterError(
            "a table alone tells neither length nor mass of a ski; choose it together with a .toml file that names it "
            f"(table = '{names[0]}'): “Download the file” on the page gives one to begin with"
        )
    else:
        raise ParameterError(
            "choose one ski: its .toml file with the table that it names, or the ski-def.json of MonkeyCAM"
        )
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            ski = read_ski(place)
        except ParameterError as error:
            raise ParameterError(str(error).replace(f"{folder}/", "")) from error
    warned = " ".join(str(each.message).replace(f"{folder}/", "") for each in caught)
    is_whole = len(names) == 1 and files
    text, table = (place.read_text(encoding="utf-8-sig"), "") if is_whole else texts_of_ski(ski)
    return SkiTexts(ski.name, text, table, warned)


def _require_own_files(place: Path, names: Sequence[str]) -> None:
    """Refuse a file that names another one than was uploaded: the lab's own files are nobody's business."""
    keys = toml_values(place.read_text(encoding="utf-8-sig", errors="replace"))
    for key in ("table", "shape"):
        if (named := keys.get(key)) is not None and named not in names:
            raise ParameterError(
                f"{place.name}: {key} is {named!r}; choose that file, too, and name it without a folder"
            )
