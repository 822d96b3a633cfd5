"""A ski written to its file and table."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .._support.errors import OutputError
from .._support.staging import write_file
from .._support.units import DEGREE, MM
from ..parameters import SMALLEST
from .file_keys import COLUMNS, RIGID

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
    values: dict[str, str | float] = {
        "name": ski.name,
        "source": ski.source,
        "table": table,
        "running_length_mm": _plain(ski.running_length / MM),
        "sidecut_length_mm": _plain(ski.sidecut_length / MM),
        "boot_position_mm": _plain(-ski.sidecut_middle / MM),
        "base_bevel_deg": _plain(ski.base_bevel / DEGREE),
        "edge_width_mm": _plain(ski.edge_width / MM),
    }
    if not ski.source.strip():
        del values["source"]
    rigid = "rigid = true\n" if _is_rigid(ski) else ""
    return "".join(f"{key} = {_toml(value)}\n" for key, value in values.items()) + rigid


def _table_text(ski: Ski) -> str:
    tables = {
        "station_m": ski.station,
        "width_mm": ski.width,
        "base_height_mm": ski.base_height,
        "EI_N_m2": ski.bending_stiffness,
        "GJ_N_m2": ski.torsional_stiffness,
        "mass_per_length_kg_per_m": ski.mass_per_length,
    }
    if _is_rigid(ski):
        del tables["EI_N_m2"], tables["GJ_N_m2"]
    columns = [table / COLUMNS[name].factor for name, table in tables.items()]
    rows = (",".join(f"{_plain(value):.15g}" for value in row) for row in zip(*columns, strict=True))
    return "\n".join([",".join(tables), *rows, ""])


def _is_rigid(ski: Ski) -> bool:
    return bool(np.all(ski.bending_stiffness == RIGID) and np.all(ski.torsional_stiffness == RIGID))


def _plain(value: float) -> float:
    """The number without the last digits, which the change of unit made up, and none that is no quantity."""
    return 0.0 if abs(value) < SMALLEST else float(f"{value:.15g}")


def _toml(value: str | float) -> str:
    # a JSON text is a TOML text but for the character that JSON leaves as it is
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f") if isinstance(value, str) else repr(value)
