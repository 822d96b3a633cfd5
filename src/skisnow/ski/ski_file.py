"""A ski from its file, or by its name from the catalogue; skis and snows by the words that name them."""

from __future__ import annotations

import weakref
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any, Final

import numpy as np

from .._support.errors import OutputError, ParameterError
from .._support.staging import write_file
from .._support.units import DEGREE, MM
from .._support.user_files.text_files import is_file, toml_text
from ..parameters import SMALLEST, suggest_and_list
from ..snow import SnowProperties, published_snow, snow_from_results
from ..snow.measured_range import with_range_warnings
from .file_keys import COLUMNS, RIGID, SkiFile
from .file_parts import file_values, values_of_keys
from .ski import Ski
from .table_file import read_table

_CATALOGUE = files(__package__) / "catalogue"


def read_ski(name_or_path: str | Path) -> Ski:
    """Read a ski: one of the catalogue by its name, any other from its TOML file.

    Parameters
    ----------
    name_or_path
        A name of `ski_names`, or the path of a file. A path is whatever ends in .toml, has a folder or is a `Path`.

    Returns
    -------
    Ski
        As dense tables from tip to tail.

    Raises
    ------
    ParameterError
        The name is unknown (the message names the nearest). The file cannot be read, a key of it is unknown, missing,
        repeated or out of range, or the ski breaks a rule of `Ski`; the message names file, key, value, allowed values
        and fix.

    Warns
    -----
    RangeWarning
        A value is outside the usual range; the message names a likely mistake of unit.

    See Also
    --------
    skisnow.ski_names : the skis of the catalogue.
    skisnow.carve : the ski in snow.

    References
    ----------
    The page docs/files/ski.md.
    """
    path = Path(name_or_path)
    if str(name_or_path) in ski_names():
        return ski_named(str(name_or_path))
    if isinstance(name_or_path, Path) or path.suffix.lower() == ".toml" or path.name != str(path) or is_file(path):
        return _read_ski_file(path)
    raise _no_such_ski(str(name_or_path))


def ski_named(name: str) -> Ski:
    """Read a ski of the catalogue.

    Raises ParameterError: the name is unknown; the message names the nearest.

    >>> slalom = ski_named("slalom")
    >>> round(slalom.length, 4), round(slalom.mass, 4), round(slalom.sidecut_radius_of_three_widths, 2)
    (1.593, 2.231, 13.12)
    """
    if name not in ski_names():
        raise _no_such_ski(name)
    with as_file(_CATALOGUE / f"{name}.toml") as path:
        return _read_ski_file(path)


def ski_names() -> tuple[str, ...]:
    """Names of the skis of the catalogue.

    Returns
    -------
    tuple of str
        Names that `read_ski` accepts.

    See Also
    --------
    skisnow.read_ski : the ski of a name.

    References
    ----------
    The page docs/methods/ski.md.

    Examples
    --------
    >>> ski_names()
    ('carver', 'giant-slalom', 'paper-tool', 'slalom')
    """
    files_there = (entry.name for entry in _CATALOGUE.iterdir())
    return tuple(sorted(name.removesuffix(".toml") for name in files_there if name.endswith(".toml")))


def _no_such_ski(name: str) -> ParameterError:
    """Error for a name that the catalogue lacks, with a similar name."""
    return ParameterError("unknown ski {name!r}. {allowed} Any other ski is read from a file ending in .toml.").tag(
        "unknown_name", name=name, allowed=suggest_and_list(name, ski_names())
    )


def _read_ski_file(path: Path) -> Ski:
    """Ski from a file and its table; errors begin with the file's path."""
    values = file_values(path)
    table = values.table_file
    columns = read_table(table) if table else {}
    try:
        return replace(values, table=columns).ski()
    except ParameterError as error:
        raise (error if str(error).startswith(str(path)) else error.at(path)) from error


MADE_OF_KEYS: Final = weakref.WeakKeyDictionary[Ski, SkiFile]()
"""Skis whose tables are certainly those of their keys, with these in SI."""


def ski_of_keys(keys: Mapping[str, Any], *, path: Path = Path("ski.toml"), like: Ski | None = None) -> Ski:
    """Ski of the keys of a ski file, without a CSV table next to it.

    keys: as in the file, in its units.
    like: ski of nearly the same lengths, whose stations are used, so that its tables differ smoothly; None: own ones.
    """
    values = values_of_keys(dict(keys), path)
    try:
        ski = values.ski(like=like)
    except ParameterError as error:
        raise (error if str(error).startswith(str(path)) else error.at(path)) from error
    MADE_OF_KEYS[ski] = values.said
    return ski


def keys_text(keys: Mapping[str, Any]) -> str:
    """TOML text of a ski file from its keys, without a table; numbers have nine digits."""

    def text(value: Any) -> str:
        if isinstance(value, list | tuple):
            return f"[{', '.join(text(item) for item in value)}]"
        return toml_text(float(f"{value:.9g}") if isinstance(value, float) else value)

    return "".join(f"{key} = {text(value)}\n" for key, value in keys.items())


def write_ski(ski: Ski, path: str | Path) -> None:
    """Write a ski so that `read_ski` gives the same one, but for the last digits.

    ski: to write.
    path: Path of the TOML file. The table, with a row for each station, is written next to it with the same name and
        the ending .csv.
    Raises OutputError: the path does not end in .toml, or cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() != ".toml":
        raise OutputError("{path} cannot be written: a ski file ends in .toml. Choose such a name.").tag(
            "cannot_write", path=path
        )
    table = path.with_suffix(".csv")
    tables = {name: getattr(ski, column.field) for name, column in COLUMNS.items()}
    if _is_rigid(ski):
        del tables["EI_N_m2"], tables["GJ_N_m2"]
    columns = [values / COLUMNS[name].factor for name, values in tables.items()]
    rows = (",".join(f"{_plain(value):.15g}" for value in row) for row in zip(*columns, strict=True))
    write_file(table, "\n".join([",".join(tables), *rows, ""]))
    write_file(path, _keys_text(ski, table.name))


def _keys_text(ski: Ski, table: str) -> str:
    """TOML text with a ski's keys; `table`: name of the file with its columns."""
    values: dict[str, str | float] = {
        "name": ski.name,
        "source": ski.source,
        "table": table,
        "running_length_mm": _plain(ski.running_length / MM),
        "sidecut_length_mm": _plain(ski.sidecut_length / MM),
        "boot_position_mm": _plain(-ski.sidecut_middle / MM),
        "base_bevel_deg": _plain(ski.base_bevel / DEGREE),
        "edge_width_mm": _plain(ski.edge_width / MM),
        "side_edge_deg": _plain(ski.side_edge / DEGREE),
        "edge_radius_mm": _plain(ski.edge_radius / MM),
    }
    if not ski.source.strip():
        del values["source"]
    rigid = "rigid = true\n" if _is_rigid(ski) else ""
    return "".join(f"{key} = {toml_text(value)}\n" for key, value in values.items()) + rigid


def _is_rigid(ski: Ski) -> bool:
    """True if both stiffnesses are rigid everywhere."""
    return bool(np.all(ski.bending_stiffness == RIGID) and np.all(ski.torsional_stiffness == RIGID))


def _plain(value: float) -> float:
    """The number with 15 digits, without the rounding of a change of unit; 0 if it is too small for a quantity."""
    return 0.0 if abs(value) < SMALLEST else float(f"{value:.15g}")


@dataclass(slots=True)
class Sources:
    """Cache of skis with their reader's warnings, and of snows, by the words that name them; each file is read once.

    folder: where relative paths start; None: the current folder.
    """

    folder: Path | None = None
    _skis: dict[str, tuple[Ski, tuple[str, ...]]] = field(default_factory=dict)
    _snows: dict[tuple[str | None, str | None, str | None], SnowProperties] = field(default_factory=dict)

    def ski(self, word: str) -> tuple[Ski, tuple[str, ...]]:
        """The ski of a name or path, and the warnings of its reader."""
        if word not in self._skis:
            self._skis[word] = with_range_warnings(lambda: read_ski(self.ski_file(word) or word))
        return self._skis[word]

    def named_snow(self, words: Mapping[str, Any]) -> SnowProperties:
        """The snow of the words `published`, or `results` and `site`."""
        named = published, results, site = words.get("published"), words.get("results"), words.get("site")
        if named not in self._snows:
            from_file = None if results is None else snow_from_results(self.path(results), site=site)
            self._snows[named] = from_file or published_snow(published or "")
        return self._snows[named]

    def take_snow(self, snow: SnowProperties, *, results: str, site: str | None) -> None:
        """Use an existing snow for the words `results` and `site`, instead of reading the results file."""
        self._snows[None, results, site] = snow

    def take_ski(self, word: str, keys: Mapping[str, Any]) -> None:
        """Use the ski of these keys for a word, instead of reading the file that the word names."""
        self._skis[word] = with_range_warnings(lambda: ski_of_keys(keys))

    def path(self, word: str) -> Path:
        """Path of a file that a word names, relative to `folder`."""
        return (self.folder or Path()) / word

    def ski_file(self, word: str) -> Path | None:
        """The file that a ski's word names, None for a name of the catalogue."""
        if word in ski_names():
            return None
        place = self.path(word)
        looks_like_one = Path(word).suffix.lower() == ".toml" or Path(word).name != word
        return place if looks_like_one or is_file(place) else None
