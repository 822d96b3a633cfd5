"""Numbers below headings without a unit that hardly are in the unit of their column: loads in kg, lever arms in cm.

Each is an error that gives the result for both readings. It ends when the unit is stated, which is then believed.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Final

import numpy as np

from ..._support.units import DEGREE, KILOGRAM_FORCE, MM, N_PER_MM2, N_PER_MM3
from ..problems import error
from .branches import is_unloading
from .heading_units import conversion
from .likely_units import LIKELY, unlikely_median
from .table_forms import BRANCH, PENETRATION, SHEAR

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from ..problems import Problem
    from ..records import FloatArray
    from .campaign_file import CampaignFile
    from .table import Table

LARGEST_LOAD: Final = 80.0
"""A tool whose loads are whole or half numbers below it may have been loaded in kg: a person weighs about as much."""
LONGEST_LEVER_ARM: Final = 5000.0
"""In mm; no torque wrench is longer."""
SHORTEST_LEVER_ARM: Final = 100.0
"""In mm; a smaller median is the length of a torque wrench in cm or m (modelling assumption)."""
_METRES: Final = 5.0
"""Median below which the numbers are metres rather than centimetres."""


def check_missing_units(table: Table, described: CampaignFile | None) -> Iterator[Problem]:
    """Find columns whose heading states no unit and whose numbers suggest another unit than the column's."""
    if table.form == PENETRATION and "load_N" in table.unstated:
        yield from _loads_in_kg(table, described)
    if table.form == SHEAR and "lever_arm_mm" in table.unstated:
        yield from _lever_arms(table, described)
    for name in table.unstated:
        found = unlikely_median(table, name) if name in LIKELY and name != "lever_arm_mm" else None
        if found is not None:
            middle, unit = found
            values = f"with a median of {middle:g}"
            yield _unstated(table, name, values, f"They look like {unit}.", unit.split(" or ", 1)[0])


def _loads_in_kg(table: Table, described: CampaignFile | None) -> Iterator[Problem]:
    """One error for each tool whose loads are all small and whole or half numbers, as discs in kg are."""
    tool, load = table.names["tool"], table.numbers["load_N"]
    for code, name in enumerate(tool.names):
        rows = np.flatnonzero((tool.code == code) & np.isfinite(load))
        if not len(rows) or load[rows].max() >= LARGEST_LOAD or np.any(2.0 * load[rows] % 1.0):
            continue
        values = f"{load[rows].min():g} to {load[rows].max():g} with tool {name}"
        largest = _largest_loads(table, rows.tolist())
        row, hardness = _middle(_hardness(table, name, largest, described), largest)
        both = f"H_V of this experiment is {hardness:.4g} N/mm³ if they are in N"
        yield _unstated(table, "load_N", values, f"{both}, {hardness * KILOGRAM_FORCE:.4g} in kg.", "kg", row)


def _largest_loads(table: Table, rows: Sequence[int]) -> list[int]:
    """Of the given rows, the one with the largest load in the loading of each experiment."""
    load, unloading, key = table.numbers["load_N"], is_unloading(table.names[BRANCH]), table.names[table.form.key].code
    largest: dict[int, int] = {}
    for row in rows:
        before = largest.get(int(key[row]))
        if not unloading[row] and (before is None or load[row] >= load[before]):
            largest[int(key[row])] = row
    return list(largest.values()) or list(rows[:1])


def _hardness(table: Table, tool: str, rows: list[int], described: CampaignFile | None) -> FloatArray:
    """H_V (N/mm³, Eqn 1) of rows with loads in N; NaN if it is unknown."""
    if described is None or tool not in described.tools:
        return np.full(len(rows), np.nan)
    depth, angle = table.numbers["depth_mm"][rows] * MM, table.numbers["edge_angle_deg"][rows] * DEGREE
    volume = described.tools[tool].displaced_volume(depth, angle)
    with np.errstate(divide="ignore", invalid="ignore"):
        hardness = table.numbers["load_N"][rows] / volume / N_PER_MM3
    return np.where(np.isfinite(hardness), hardness, np.nan)


def _lever_arms(table: Table, described: CampaignFile | None) -> Iterator[Problem]:
    """An error for lever arms above 5 m in mm, or of the size of torque wrenches in cm or m."""
    arm = table.numbers["lever_arm_mm"]
    rows = np.flatnonzero(np.isfinite(arm)).tolist()
    if not rows:
        return
    middle, longest = float(np.median(arm[rows])), float(arm[rows].max())
    if middle >= SHORTEST_LEVER_ARM and longest <= LONGEST_LEVER_ARM:
        return
    unit = "µm" if longest > LONGEST_LEVER_ARM else "m" if middle < _METRES else "cm"
    row, stress = _middle(_shear_stress(table, rows, described), rows)
    size = conversion(unit, "lever_arm_mm")
    other = stress / size.factor if size is not None else np.nan
    both = f"S_f of this experiment is {stress:.4g} N/mm² if they are in mm, {other:.4g} in {unit}."
    yield _unstated(table, "lever_arm_mm", f"{arm[rows].min():g} to {longest:g}", both, unit, row)


def _shear_stress(table: Table, rows: list[int], described: CampaignFile | None) -> FloatArray:
    """S_f (N/mm², Eqns 7 and 9) of rows with lever arms in mm; NaN if it is unknown."""
    plates = {} if described is None else described.plates
    length = np.array([plates.get(table.names["plate"][row], np.nan) for row in rows])
    force = table.numbers["moment_Nm"][rows] / (table.numbers["lever_arm_mm"][rows] * MM)
    with np.errstate(divide="ignore", invalid="ignore"):
        stress = force / (length * table.numbers["depth_mm"][rows] * MM) / N_PER_MM2
    return np.where(np.isfinite(stress), stress, np.nan)


def _middle(values: FloatArray, rows: list[int]) -> tuple[int, float]:
    """Row and value of the middle one of the known values; the first row and NaN if none is known."""
    known = sorted((value, row) for value, row in zip(values.tolist(), rows, strict=True) if np.isfinite(value))
    value, row = known[(len(known) - 1) // 2] if known else (float("nan"), rows[0])
    return row, value


def _unstated(table: Table, column: str, values: str, effect: str, unit: str, row: int = 0) -> Problem:
    heading = table.unstated[column]
    line = f'units.{json.dumps(heading, ensure_ascii=False)} = "{unit}"'
    return error(
        "unit_missing",
        table.form.file,
        row=int(table.row[row]),
        column=column,
        experiment=table.names[table.form.key][row] or None,
        value=f"{heading}: {values}",
        allowed="numbers whose unit is stated",
        action=f"{effect} State the unit: in the heading, such as {heading} [{unit}], or at the top of campaign.toml, "
        f"such as {line}.",
    )
