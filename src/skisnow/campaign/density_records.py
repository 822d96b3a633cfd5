"""Densities of snow pits: one row per sample, with the layer that it was cut from.

Columns: ID (the pit), TOP and BOTTOM (height of the layer's limits in cm above the ice), RHO (kg/m³), NOTES (-9999 is
none) and TYPE (a letter for the kind of snow), as in the data of King and others (2020, doi 10.5194/tc-14-4323-2020).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from .._support.errors import FieldDataError
from .._support.units import CM, ICE_DENSITY
from ..parameters import Quantity
from .problems import error
from .reading.campaign_files import FilesOfFolder, RawFiles
from .reading.table_forms import TableForm
from .reading.tables import read_table
from .reading.text import UnreadableTextError, inspect_csv

if TYPE_CHECKING:
    from .problems import Problem
    from .reading.columns import Table
    from .records import FloatArray, IntArray

_NO_NOTE: Final = "-9999"


@dataclass(frozen=True, slots=True)
class DensityLayers:
    """Density samples of snow pits, in the order of the file.

    Attributes
    ----------
    pit
        Name of the pit.
    top, bottom
        Limits of the layer, heights above the ground or ice that the snow lies on (m); top > bottom.
    snow_density
        ρ in kg/m³.
    note
        The column NOTES, ``""`` where there is none.
    kind
        Kind of snow as the file writes it, ``""`` where it does not say.
    row
        Line of the file; the header is line 1.
    problems
        Warnings of reading, such as columns that are not known.
    """

    pit: tuple[str, ...]
    top: FloatArray
    bottom: FloatArray
    snow_density: FloatArray
    note: tuple[str, ...]
    kind: tuple[str, ...]
    row: IntArray
    problems: tuple[Problem, ...] = field(default=(), repr=False)

    def __len__(self) -> int:
        """Count the samples."""
        return len(self.pit)

    @property
    def thickness(self) -> FloatArray:
        """Of each layer (m)."""
        return self.top - self.bottom


def read_density_layers(path: Path) -> DensityLayers:
    """Read a CSV of pit densities.

    Raises
    ------
    FieldDataError
        With every problem of the file, each with its row and column.
    """
    path = Path(path)
    files = RawFiles(FilesOfFolder(path.parent))
    table = _read(path.name, files)
    if table is not None and not table.absent:
        files.found.extend(_layers_upside_down(path.name, table))
    errors = [problem for problem in files.found if problem.severity == "error"]
    if errors or table is None:
        raise FieldDataError(errors)
    notes = table.names["NOTES"].cells()
    return DensityLayers(
        pit=table.names["ID"].cells(),
        top=table.numbers["TOP"] * CM,
        bottom=table.numbers["BOTTOM"] * CM,
        snow_density=table.numbers["RHO"],
        note=tuple("" if note == _NO_NOTE else note for note in notes),
        kind=table.names["TYPE"].cells(),
        row=table.row,
        problems=tuple(files.found),
    )


def _read(name: str, files: RawFiles) -> Table | None:
    data = files.read(name)
    if data is None:
        if name in files.absent:
            action = "Check the file's name and folder."
            files.found.append(error("unreadable_file", name, allowed="a file of this name", action=action))
        return None
    try:
        text = inspect_csv(data)
    except UnreadableTextError as failure:
        files.report_unreadable(name, failure)
        return None
    files.report_encoding(name, text.foreign_encoding)
    return read_table(_form(name), text, corrections={}, files=files)


def _form(file: str) -> TableForm:
    return TableForm(
        file=file,
        key="ID",
        names=("ID",),
        numbers=(
            Quantity("TOP", "height of the layer's top, cm", lowest=0.0, above=True),
            Quantity("BOTTOM", "height of its bottom, cm", lowest=0.0),
            Quantity("RHO", "density, kg/m³", lowest=0.0, above=True, highest=ICE_DENSITY),
        ),
        optional=("NOTES", "TYPE"),
    )


def _layers_upside_down(file: str, table: Table) -> list[Problem]:
    top, bottom = table.numbers["TOP"], table.numbers["BOTTOM"]
    return [
        error(
            "out_of_range",
            file,
            row=int(table.row[index]),
            column="TOP",
            experiment=table.names["ID"][index],
            value=f"{top[index]:g}",
            allowed=f"a height above the layer's BOTTOM, {bottom[index]:g} cm",
            action="Heights count upwards; exchange the two if the file counts from the surface down.",
        )
        for index in np.flatnonzero(top <= bottom).tolist()
    ]
