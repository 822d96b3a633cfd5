"""A ski written to its file and table."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import OutputError
from ..files import write_file
from ..units import DEGREE, MM
from .file_keys import COLUMNS

if TYPE_CHECKING:
    from .ski import Ski


def write_ski(ski: Ski, path: str | Path) -> None:
    """Write a ski so that `read_ski` gives the same one, but for the last digits.

    Parameters
    ----------
    ski
        To write.
    path
        Of the TOML file. The table, a row for each station, goes beside it, with the same name and the ending .csv.

    Raises
    ------
    OutputError
        The path does not end in .toml, or cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() != ".toml":
        raise OutputError(f"{path} cannot be written: a ski file ends in .toml. Choose such a name.")
    table = path.with_suffix(".csv")
    write_file(table, _table_text(ski))
    write_file(path, _keys_text(ski, table.name))


def _keys_text(ski: Ski, table: str) -> str:
    values = {
        "name": ski.name,
        "source": ski.source,
        "table": table,
        "running_length_mm": _plain(ski.running_length / MM),
        "sidecut_length_mm": _plain(ski.sidecut_length / MM),
        "boot_position_mm": _plain(-ski.sidecut_middle / MM),
        "base_bevel_deg": _plain(ski.base_bevel / DEGREE),
        "edge_width_mm": _plain(ski.edge_width / MM),
    }
    return "".join(f"{key} = {_toml(value)}\n" for key, value in values.items())


def _table_text(ski: Ski) -> str:
    tables = (
        ski.station,
        ski.width,
        ski.base_height,
        ski.bending_stiffness,
        ski.torsional_stiffness,
        ski.mass_per_length,
    )
    columns = [table / key.unit for table, key in zip(tables, COLUMNS.values(), strict=True)]
    rows = (",".join(f"{value:.15g}" for value in row) for row in zip(*columns, strict=True))
    return "\n".join([",".join(COLUMNS), *rows, ""])


def _plain(value: float) -> float:
    """The number without the last digit or two, which the change of unit made up."""
    return float(f"{value:.14g}") + 0.0


def _toml(value: str | float) -> str:
    # a JSON text is a TOML text but for the character that JSON leaves as it is
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f") if isinstance(value, str) else repr(value)
