"""track.csv: where the sledge and the loaded edges of its skis were, a row for each time that was stored."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from itertools import chain
from pathlib import Path
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.spreadsheet_text import csv_text
from .._support.staging import require_ending, write_file
from .._support.units import DEGREE, MM
from ..scenario.boots import ANGLES, OF_SLOPE, SIDES
from .run import Run
from .run_forces import boots_of

COLUMNS: Final = (
    "time_s", "x_m", "y_m", "z_m", "speed_m_per_s", "heading_deg", "turn_radius_m", "left_x_m", "left_y_m",
    "left_depth_mm", "right_x_m", "right_y_m", "right_depth_mm", "left_total_force_N", "right_total_force_N",
    "left_normal_force_N", "right_normal_force_N",
)  # fmt: skip
SKIER_COLUMNS: Final = ("lean_deg", "edge_angle_deg")
"""Columns that a skier's run has besides."""


def track_columns(run: Run) -> tuple[str, ...]:
    """Names of the columns of a run's track.csv."""
    return COLUMNS if run.scenario.skier is None else (*COLUMNS, *SKIER_COLUMNS)


def track_table(run: Run) -> FloatArray:
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
    """Text of track.csv: numbers with all their digits, empty cells for numbers that do not exist."""
    rows = ([repr(cell) if math.isfinite(cell) else "" for cell in row] for row in track_table(run).tolist())
    return csv_text(chain([track_columns(run)], rows))


def write_track(run: Run, path: str | Path) -> None:
    """Write track.csv in one piece."""
    write_file(path, track_csv(run))


ENDINGS: Final = (".csv", ".mot", ".sto")
_OWN: Final = ("ahead", "left", "up")
_TO_OPENSIM: Final = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""From the slope's axes to those of OpenSim's ground: x ahead, y up, z to the right."""


def boots_columns(run: Run) -> dict[str, FloatArray]:
    """Columns by name, (n,) each: time, and of each boot pose, forces and moments in the slope's and its own axes."""
    boots = boots_of(run)
    columns = {"time_s": run.time}
    for k, side in enumerate(SIDES):
        values = {name: boots.place[:, k, axis] for axis, name in enumerate(OF_SLOPE)}
        values |= {name: boots.angles[:, k, axis] / DEGREE for axis, name in enumerate(ANGLES)}
        for what, unit, slope, own in (
            ("force", "N", boots.force, boots.own_force),
            ("moment", "N_m", boots.moment, boots.own_moment),
        ):
            values |= {f"{what}_{axis}_{unit}": slope[:, k, i] for i, axis in enumerate("xyz")}
            values |= {f"{what}_{axis}_{unit}": own[:, k, i] for i, axis in enumerate(_OWN)}
        columns |= {f"{side}_{name}": column for name, column in values.items()}
    return columns


def opensim_columns(run: Run) -> dict[str, FloatArray]:
    """Columns of `boots_columns` with ``time``, then force, its place and moment of each ski in OpenSim's axes.

    ``left_ski_force_vx``, ``left_ski_force_px`` and ``left_ski_moment_mx`` and so on: external loads for OpenSim.
    """
    columns = boots_columns(run)
    columns = {"time": columns.pop("time_s"), **columns}
    boots = boots_of(run)
    for k, side in enumerate(SIDES):
        for name, values in (("force_v", boots.force), ("force_p", boots.place), ("moment_m", boots.moment)):
            turned = values[:, k] @ _TO_OPENSIM.T
            columns |= {f"{side}_ski_{name}{axis}": turned[:, i] for i, axis in enumerate("xyz")}
    return columns


def boots_text(run: Run, ending: str, *, name: str = "boots") -> str:
    """Text of a file with the boots' poses and loads over time, with all digits.

    ending: one of `ENDINGS`.
    name: first line of the header of a .mot or .sto file.
    """
    columns = boots_columns(run) if ending == ".csv" else opensim_columns(run)
    rows = np.column_stack(list(columns.values())).tolist()
    if ending == ".csv":
        return csv_text(chain([columns], (map(repr, row) for row in rows)))
    head = f"{name}\nversion=1\nnRows={len(rows)}\nnColumns={len(columns)}\ninDegrees=yes\nendheader\n"
    return head + "".join("\t".join(cells) + "\n" for cells in (columns, *(map(repr, row) for row in rows)))


def external_loads(motion: str) -> str:
    """OpenSim's external loads of both skis on the feet of its usual models, in XML.

    motion: name of the .mot or .sto file with the columns of `opensim_columns`, in the same folder.
    """
    document = ET.Element("OpenSimDocument", Version="40000")
    loads = ET.SubElement(document, "ExternalLoads", name="skis")
    objects = ET.SubElement(loads, "objects")
    for side in SIDES:
        force = ET.SubElement(objects, "ExternalForce", name=f"{side}_ski")
        for tag, text in (
            ("applied_to_body", f"calcn_{side[0]}"),
            ("force_expressed_in_body", "ground"),
            ("point_expressed_in_body", "ground"),
            ("force_identifier", f"{side}_ski_force_v"),
            ("point_identifier", f"{side}_ski_force_p"),
            ("torque_identifier", f"{side}_ski_moment_m"),
        ):
            ET.SubElement(force, tag).text = text
    ET.SubElement(loads, "datafile").text = motion
    ET.indent(document)
    return ET.tostring(document, encoding="unicode") + "\n"


def write_boots(run: Run, path: str | Path) -> None:
    """Write the boots of a run in one piece: a .csv, .mot or .sto file, which boots.file reads again.

    Next to NAME.mot or NAME.sto, NAME_external_loads.xml names its columns for OpenSim.
    """
    path = Path(path)
    require_ending(path, *ENDINGS)
    ending = path.suffix.lower()
    write_file(path, boots_text(run, ending, name=path.stem))
    if ending != ".csv":
        write_file(path.with_name(f"{path.stem}_external_loads.xml"), external_loads(path.name))
