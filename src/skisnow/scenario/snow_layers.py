"""Layers of the snow of a run from a CSV file, such as the depths and forces of a SnowMicroPen."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.spreadsheet_text import csv_rows
from .._support.units import MM

MOST_LAYERS: Final = 100
"""Rows of a profile; a run evaluates the pressure between each two."""
_ACTION: Final = Message(
    "Write depth_mm, the top of each layer from 0 on, and hardness_share (of H_V) or force_N (of a SnowMicroPen)."
)


@dataclass(frozen=True, slots=True)
class SnowLayers:
    """Tops (m), rising from 0, and hardness over H_V of each layer, with the file."""

    tops: tuple[float, ...]
    shares: tuple[float, ...]
    source: str


def read_snow_layers(path: str | Path) -> SnowLayers:
    """Read the hardness over the depth.

    path: CSV with ``depth_mm``, the top of each layer, the first 0, and ``hardness_share`` (hardness over H_V) or
        ``force_N``, whose mean over the depth of the file stands for H_V.
    """
    rows = list(csv_rows(path, ("depth_mm",), further=("hardness_share", "force_N"), action=_ACTION))
    names = [name for name in ("hardness_share", "force_N") if rows and name in rows[0].cells]
    if len(names) != 1 or len(rows) > MOST_LAYERS:
        raise ParameterError(
            "{path}: {count} rows with the columns {columns}; allowed are 1 to {most} rows with one of hardness_share "
            "and force_N. {action}",
            code="wrong_kind",
            path=path,
            count=len(rows),
            columns=names,
            most=MOST_LAYERS,
            action=_ACTION,
        )
    tops = np.array([row.number("depth_mm") for row in rows]) * MM
    values = np.array([row.number(names[0]) for row in rows])
    for row, step, value in zip(rows, np.diff(tops, prepend=-1.0), values, strict=True):
        if not value > 0.0:
            raise row.refused(names[0], Message("A number above 0 is needed."), code="out_of_range")
        if step <= 0.0 or (row is rows[0] and step != 1.0):
            raise row.refused("depth_mm", Message("Depths rise from 0."), code="not_rising", action=_ACTION)
    if names[0] == "force_N":
        values = values / (np.average(values[:-1], weights=np.diff(tops)) if len(rows) > 1 else values[0])
    return SnowLayers(tuple(tops.tolist()), tuple(values.tolist()), str(path))
