"""track.csv: where the sledge and the loaded edges of its skis were, a row for each time that was stored."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.staging import write_file
from .._support.units import DEGREE, MM
from .run import Run

COLUMNS: Final = (
    "time_s",
    "x_m",
    "y_m",
    "z_m",
    "speed_m_per_s",
    "heading_deg",
    "turn_radius_m",
    "left_x_m",
    "left_y_m",
    "left_depth_mm",
    "right_x_m",
    "right_y_m",
    "right_depth_mm",
    "left_total_force_N",
    "right_total_force_N",
    "left_normal_force_N",
    "right_normal_force_N",
)
SKIER_COLUMNS: Final = ("lean_deg", "edge_angle_deg")
"""Columns that a skier's run has besides."""


def track_columns(run: Run) -> tuple[str, ...]:
    """Names of the columns of a run's track.csv."""
    return COLUMNS if run.scenario.skier is None else (*COLUMNS, *SKIER_COLUMNS)


def track_table(run: Run) -> npt.NDArray[np.float64]:
    """The rows of track.csv under `track_columns`, (n, 17) or more; the turn radius of a straight path is infinite."""
    skis = [
        column
        for ski in (0, 1)
        for column in (run.skis.track[:, ski, 0], run.skis.track[:, ski, 1], run.skis.depth[:, ski] / MM)
    ]
    skis += [*run.skis.total_force.T, *run.skis.normal_force.T]
    if run.scenario.skier is not None:
        balance = run.balance
        skis += [balance.lean / DEGREE, (balance.lean + balance.angulation) / DEGREE]
    return np.column_stack([run.time, run.place, run.speed, run.heading / DEGREE, run.turn_radius, *skis])


def track_csv(run: Run) -> str:
    """The table as text: numbers with all their digits, nothing where a number does not exist."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(track_columns(run))
    writer.writerows([repr(cell) if math.isfinite(cell) else "" for cell in row] for row in track_table(run).tolist())
    return stream.getvalue()


def write_track(run: Run, path: str | Path) -> None:
    """Write track.csv in one piece.

    Raises
    ------
    OutputError
        The place cannot be written.
    """
    write_file(path, track_csv(run))
