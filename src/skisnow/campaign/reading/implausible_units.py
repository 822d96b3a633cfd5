"""Checks of numbers that are probably in another unit than their column's name states: kN, metres, N mm, g/cm³.

The numbers are used unchanged, with a warning. A whole file in another unit is recognised by its median, single rows by
their distance from it.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ..._support.messages import Message
from ..._support.units import DEGREE, MM, N_PER_MM3
from ..problems import Problem, warning
from .campaign_file import CampaignFile
from .columns import Table, is_unloading
from .table_forms import BRANCH, PENETRATION, SHEAR

FAR: Final = 500.0
"""Factor from the median of its column beyond which a number is reported: loads of one campaign span less."""


@dataclass(frozen=True, slots=True)
class LikelyColumn:
    """Likely range of the median of a column's numbers above 0, and True if single rows are checked, too."""

    low: float
    high: float
    unit: str
    if_low: str
    if_high: str
    each_row: bool = True


LIKELY: Final = {
    "load_N": LikelyColumn(2.0, 20_000.0, "N", "kN", "mN or g"),
    "depth_mm": LikelyColumn(0.02, 500.0, "mm", "m", "µm", each_row=False),
    "lever_arm_mm": LikelyColumn(40.0, 5000.0, "mm", "m or cm", "µm"),
    "moment_Nm": LikelyColumn(0.1, 1000.0, "N m", "kN m", "N mm or N cm"),
    "snow_density_kg_per_m3": LikelyColumn(20.0, 917.0, "kg/m³", "g/cm³", "g/m³"),
    "drop_cone_depth_mm": LikelyColumn(0.5, 300.0, "mm", "m", "µm"),
}
"""Wide limits (assumption): what the paper measured lies well inside, with 12-492 N, 2-12 mm and 420-740 kg/m³."""


def check_likely_units(table: Table) -> Iterator[Problem]:
    """Warn of each column whose numbers, as a whole or in single rows, look like another unit.

    A whole column below a heading without a unit is an error of `check_missing_units`.
    """
    for name, likely in LIKELY.items():
        middle = _median(table, name)
        if middle is None:
            continue
        unlikely = unlikely_median(table, name)
        if unlikely is not None and name not in table.unstated:
            yield _warn_of_column(table, name, likely, *unlikely)
        elif unlikely is None and likely.each_row:
            values = table.numbers[name]
            above_zero = np.flatnonzero(values > 0)
            ratio = values[above_zero] / middle
            far = above_zero[(ratio > FAR) | (ratio < 1.0 / FAR)]
            if len(far):
                yield _warn_of_rows(table, name, likely, middle, far.tolist())


def unlikely_median(table: Table, name: str) -> tuple[float, str] | None:
    """Median of the numbers of a column of `LIKELY` above 0 and the unit they look like; None if it is likely."""
    middle, likely = _median(table, name), LIKELY[name]
    if middle is None or likely.low <= middle <= likely.high:
        return None
    return middle, likely.if_low if middle < likely.low else likely.if_high


def _median(table: Table, name: str) -> float | None:
    values = table.numbers.get(name, np.zeros(0))
    above_zero = values[values > 0]
    return float(np.median(above_zero)) if len(above_zero) else None


def _warn_of_column(table: Table, name: str, likely: LikelyColumn, middle: float, unit: str) -> Problem:
    allowed = Message(
        "numbers in {unit}; medians of {low:g} to {high:g} are usual",
        unit=likely.unit,
        low=likely.low,
        high=likely.high,
    )
    action = Message(
        "If these are {unit} convert them to {unit_2}; if they are {unit_2} no action is needed.",
        unit=unit,
        unit_2=likely.unit,
    )
    return warning(
        "unlikely_unit", table.form.file, column=name, value=f"a median of {middle:g}", allowed=allowed, action=action
    )


def _warn_of_rows(table: Table, name: str, likely: LikelyColumn, middle: float, rows: list[int]) -> Problem:
    value = table.numbers[name][rows[0]]
    more = f", and {len(rows) - 1} more like it" if len(rows) > 1 else ""
    allowed = Message(
        "numbers in {unit}, within a factor {far:g} of the column's median of {middle:g}",
        unit=likely.unit,
        far=FAR,
        middle=middle,
    )
    other = likely.if_low if value < middle else likely.if_high
    action = Message("Look whether this is {value} or a slip of the pen.", value=other)
    return table.warning(rows[0], "unlikely_unit", name, f"{value:g}{more}", allowed, action)


LARGEST_LOAD: Final = 80.0
"""A tool whose loads are whole or half numbers below it may have been loaded in kg: a person weighs about as much."""
LONGEST_LEVER_ARM: Final = 5000.0
"""In mm; no torque wrench is longer."""
SHORTEST_LEVER_ARM: Final = 100.0
"""In mm; a smaller median is the length of a torque wrench in cm or m (modelling assumption)."""
HARDEST: Final = 90.0
"""In N/mm³; the hardest snow that was measured. A tool with a harder median may have depths in cm."""
_METRES: Final = 5.0
"""Median below which the numbers are metres rather than centimetres."""


def check_missing_units(table: Table, described: CampaignFile | None) -> Iterator[Problem]:
    """Errors for columns whose heading states no unit and whose numbers suggest another unit."""
    if table.form == PENETRATION and "load_N" in table.unstated:
        yield from _loads_in_kg(table)
    if table.form == PENETRATION and "depth_mm" in table.unstated:
        yield from _depths_in_cm(table, described)
    if table.form == SHEAR and "lever_arm_mm" in table.unstated:
        yield from _lever_arms(table)
    for name in table.unstated:
        unlikely = unlikely_median(table, name) if name in LIKELY and name != "lever_arm_mm" else None
        if unlikely is not None:
            middle, unit = unlikely
            yield _missing_unit(table, name, f"with a median of {middle:g}", unit.split(" or ", 1)[0])


def _loads_in_kg(table: Table) -> Iterator[Problem]:
    """One error for each tool whose loads are all small and whole or half numbers, as discs in kg are."""
    tool, load = table.names["tool"], table.numbers["load_N"]
    for code, name in enumerate(tool.names):
        rows = np.flatnonzero((tool.code == code) & np.isfinite(load))
        if len(rows) and load[rows].max() < LARGEST_LOAD and not np.any(2.0 * load[rows] % 1.0):
            values = f"{load[rows].min():g} to {load[rows].max():g} with tool {name}"
            yield _missing_unit(table, "load_N", values, "kg", int(rows[0]))


def _depths_in_cm(table: Table, described: CampaignFile | None) -> Iterator[Problem]:
    """One error for each tool whose median H_V, with depths in mm, exceeds any measured one: they may be in cm."""
    tool, depth = table.names["tool"], table.numbers["depth_mm"]
    for code, name in enumerate(tool.names):
        rows = np.flatnonzero((tool.code == code) & np.isfinite(depth)).tolist()
        if described is None or name not in described.tools or not rows:
            continue
        largest = _largest_loads(table, rows)
        volume = described.tools[name].displaced_volume(
            depth[largest] * MM, table.numbers["edge_angle_deg"][largest] * DEGREE
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            hardness = table.numbers["load_N"][largest] / volume / N_PER_MM3
        hardness = np.sort(hardness[np.isfinite(hardness)])
        if len(hardness) and hardness[(len(hardness) - 1) // 2] > HARDEST:
            values = f"{depth[rows].min():g} to {depth[rows].max():g} with tool {name}"
            yield _missing_unit(table, "depth_mm", values, "cm", rows[0])


def _largest_loads(table: Table, rows: Sequence[int]) -> list[int]:
    """Row of each experiment's largest load, from the given rows that do not unload; the first row if all unload."""
    load, unloading, key = table.numbers["load_N"], is_unloading(table.names[BRANCH]), table.names[table.form.key].code
    largest: dict[int, int] = {}
    for row in rows:
        before = largest.get(int(key[row]))
        if not unloading[row] and (before is None or load[row] >= load[before]):
            largest[int(key[row])] = row
    return list(largest.values()) or list(rows[:1])


def _lever_arms(table: Table) -> Iterator[Problem]:
    """An error for lever arms above 5 m in mm, or of the size of torque wrenches in cm or m."""
    arm = table.numbers["lever_arm_mm"]
    rows = np.flatnonzero(np.isfinite(arm)).tolist()
    if not rows:
        return
    middle, longest = float(np.median(arm[rows])), float(arm[rows].max())
    if middle < SHORTEST_LEVER_ARM or longest > LONGEST_LEVER_ARM:
        unit = "µm" if longest > LONGEST_LEVER_ARM else "m" if middle < _METRES else "cm"
        yield _missing_unit(table, "lever_arm_mm", f"{arm[rows].min():g} to {longest:g}", unit, rows[0])


def _missing_unit(table: Table, column: str, values: str, unit: str, row: int = 0) -> Problem:
    heading = table.unstated[column]
    line = f'units.{json.dumps(heading, ensure_ascii=False)} = "{unit}"'
    allowed = Message("numbers whose unit is stated")
    action = Message(
        "They look like {unit}. State the unit: in the heading, such as {heading} [{unit}], or at the top of "
        "campaign.toml, such as {line}.",
        heading=heading,
        unit=unit,
        line=line,
    )
    return table.error(row, "unit_missing", column, f"{heading}: {values}", allowed=allowed, action=action)
