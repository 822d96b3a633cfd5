"""Checks of the rows of a table: units, angles, branches, turning angles, and repeated rows.

Numbers that are probably in another unit than their column's name states (kN, metres, N mm, g/cm³) are used unchanged,
with a warning. A whole file in another unit is recognised by its median, single rows by their distance from it.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from ..._support.arrays import BoolArray
from ..._support.messages import Message
from ..._support.units import DEGREE, MM, N_PER_MM3
from ..problems import Problem, warning
from .campaign_file import CAMPAIGN_FILE, CampaignFile
from .columns import Table, is_unloading
from .experiments import Blocks, check_one_number, check_one_site, check_series, shear_blocks
from .table_forms import BRANCH, BRANCHES, DENSITY, DROP_CONE, LOADING, PENETRATION, SHEAR, UNLOADING


def check_rows(table: Table, described: CampaignFile | None) -> Iterator[Problem]:
    """Problems that follow from several rows of a table, or from the table and campaign.toml together."""
    yield from _check_likely_units(table)
    yield from _check_missing_units(table, described)
    if table.form in (DENSITY, DROP_CONE):
        yield from _check_repeated_rows(table)
    if table.form == PENETRATION:
        blocks = Blocks.of_runs(table.names["experiment"])
        yield from check_series(table, blocks)
        yield from _check_branches(table, blocks)
        yield from _check_angles(table, blocks, described)
        if described is not None:
            yield from _unknown_names(table, blocks, "tool", described.tool_names)
    elif table.form == SHEAR:
        blocks = shear_blocks(table)
        yield from check_series(table, blocks)
        yield from check_one_number(table, blocks, "depth_mm")
        yield from check_one_number(table, blocks, "lever_arm_mm")
        yield from _check_angles(table, blocks, described)
        if described is not None:
            yield from _unknown_names(table, blocks, "plate", described.plate_names)
    elif table.form == DROP_CONE:
        yield from check_one_site(table)


def _unknown_names(table: Table, blocks: Blocks, column: str, described_names: frozenset[str]) -> Iterator[Problem]:
    """Errors for tools or plates that are not in campaign.toml, one for each experiment."""
    names = table.names[column]
    unknown = np.array([bool(name) and name not in described_names for name in names.names], dtype=np.bool_)[names.code]
    pairs = np.stack([blocks.of_row, names.code], axis=1)[unknown]
    _, first = np.unique(pairs, axis=0, return_index=True)
    for row in np.flatnonzero(unknown)[np.sort(first)].tolist():
        words = {"column": column, "campaign_file": CAMPAIGN_FILE}
        allowed = Message("a {column} that {campaign_file} describes", **words)
        if described_names:
            allowed = Message("one of {names}", names=sorted(described_names))
        action = Message("Correct the cell, or describe the {column} in {campaign_file} under [[{column}]].", **words)
        yield table.error(row, f"unknown_{column}", column, names[row], allowed=allowed, action=action)


COLUMN: Final = "edge_angle_deg"
STEEPEST_MEASURED_DEG: Final = 60.0
"""Largest edge angle of the paper's penetration experiments (Mössner and others 2013)."""
SMALLEST_LIKELY_DEG: Final = 1.6
"""Just above π/2: a file with only smaller angles is probably in radians."""


def _check_angles(table: Table, blocks: Blocks, described: CampaignFile | None) -> Iterator[Problem]:
    """Warnings of angles that look like radians or exceed the measured ones; errors for tilted tools without edge."""
    angle = table.numbers[COLUMN]
    tilted = angle[angle > 0]
    if len(tilted) and float(tilted.max()) < SMALLEST_LIKELY_DEG:
        value, allowed = f"{tilted.min():g} to {tilted.max():g}", Message("degrees")
        action = Message("If these are radians multiply them by 57.29578; if they are degrees no action is needed.")
        radians = partial(warning, "angles_look_like_radians", table.form.file, column=COLUMN)
        yield radians(value=value, allowed=allowed, action=action)
    if table.form != PENETRATION:
        return
    for row in _once_per_block(angle > STEEPEST_MEASURED_DEG, blocks):
        allowed = Message("penetration was measured up to {angle:g} degrees so far", angle=STEEPEST_MEASURED_DEG)
        action = Message("The computation continues; check the angle.")
        yield table.warning(row, "angle_above_60", COLUMN, f"{angle[row]:g}", allowed, action)
    flat_tools = frozenset[str]() if described is None else described.flat_tools
    tool = table.names["tool"]
    is_flat = np.array([name in flat_tools for name in tool.names], dtype=np.bool_)[tool.code]
    for row in _once_per_block(is_flat & (angle > 0), blocks):
        allowed = Message("0 for the tool {tool!r}, which has no edge", tool=tool[row])
        action = Message("Write 0, or name the tool that was used.")
        yield table.error(row, "out_of_range", COLUMN, f"{angle[row]:g}", allowed, action)


def _once_per_block(chosen: BoolArray, blocks: Blocks) -> list[int]:
    """First chosen row of each block of rows."""
    rows = np.flatnonzero(chosen)
    _, first = np.unique(blocks.of_row[rows], return_index=True)
    numbers: list[int] = rows[first].tolist()
    return numbers


def _check_branches(table: Table, blocks: Blocks) -> Iterator[Problem]:
    """Errors for unknown branches, loading after unloading, and series without loading."""
    branch = table.names[BRANCH]
    unknown = np.array([name.casefold() not in BRANCHES for name in branch.names], dtype=np.bool_)[branch.code]
    taken_off = is_unloading(branch)
    same = blocks.of_row[1:] == blocks.of_row[:-1]
    words = Message("{loading}, {unloading} or nothing, which is {loading}", loading=LOADING, unloading=UNLOADING)
    later = Message("{branch}: a row of this experiment before it is", branch=UNLOADING)
    first = Message("{branch}: an experiment begins under its first load", branch=LOADING)
    action = Message(
        "Correct the cell; the rows are in the order of reading, and a second loading is another experiment."
    )
    for rows, code, allowed in (
        (np.flatnonzero(unknown), "out_of_range", words),
        (np.flatnonzero(same & taken_off[:-1] & ~taken_off[1:]) + 1, "branch_order", later),
        (blocks.start[taken_off[blocks.start]], "branch_order", first),
    ):
        for row in rows.tolist():
            yield table.error(row, code, BRANCH, branch[row], allowed, action)


MOST_LISTED: Final = 1000
"""Maximum number of repeated rows that are listed."""


def _check_repeated_rows(table: Table) -> Iterator[Problem]:
    """Warning of each row that equals an earlier one, up to `MOST_LISTED`."""
    names = [column.cells() for column in table.names.values()]
    numbers = [np.where(np.isfinite(column), column, -np.inf).tolist() for column in table.numbers.values()]
    first: dict[tuple[object, ...], int] = {}
    repeated = 0
    for index, row in enumerate(zip(*names, *numbers, *table.further.values(), strict=True)):
        earlier = first.setdefault(row, index)
        if earlier != index and repeated < MOST_LISTED:
            repeated += 1
            allowed = Message("each measurement once")
            action = Message("It counts again in the mean of its site: remove the row if it was pasted twice.")
            value = f"the same as row {int(table.row[earlier])}"
            yield table.warning(index, "repeated_row", None, value, allowed, action)


FAR: Final = 500.0
"""Factor from the median of its column beyond which a number is reported: loads of one campaign span less."""


@dataclass(frozen=True, slots=True)
class LikelyColumn:
    """Likely range of the median of a column's numbers above 0, and the units that other medians look like.

    each_row: True if single rows are also checked.
    """

    low: float
    high: float
    unit: str
    if_low: str
    if_high: str
    each_row: bool = True

    def other_unit(self, median: float) -> str:
        """Unit that numbers with this median look like, if it is not that of the column; "" within the range."""
        if self.low <= median <= self.high:
            return ""
        return self.if_low if median < self.low else self.if_high


LIKELY: Final = {
    "load_N": LikelyColumn(2.0, 20_000.0, "N", "kN", "mN or g"),
    "depth_mm": LikelyColumn(0.02, 500.0, "mm", "m", "µm", each_row=False),
    "lever_arm_mm": LikelyColumn(40.0, 5000.0, "mm", "m or cm", "µm"),
    "moment_Nm": LikelyColumn(0.1, 1000.0, "N m", "kN m", "N mm or N cm"),
    "snow_density_kg_per_m3": LikelyColumn(20.0, 917.0, "kg/m³", "g/cm³", "g/m³"),
    "drop_cone_depth_mm": LikelyColumn(0.5, 300.0, "mm", "m", "µm"),
}
"""Wide limits (assumption): what the paper measured lies well inside, with 12-492 N, 2-12 mm and 420-740 kg/m³."""


def _check_likely_units(table: Table) -> Iterator[Problem]:
    """Warn of each column whose numbers, as a whole or in single rows, look like another unit.

    A whole column below a heading without a unit is an error of `_check_missing_units`.
    """
    for name, likely in LIKELY.items():
        middle = _median(table, name)
        if middle is None:
            continue
        unit = likely.other_unit(middle)
        if unit and name not in table.unstated:
            words = {"unit": likely.unit, "low": likely.low, "high": likely.high}
            allowed = Message("numbers in {unit}; medians of {low:g} to {high:g} are usual", **words)
            action = Message(
                "If these are {unit} convert them to {unit_2}; if they are {unit_2} no action is needed.",
                unit=unit,
                unit_2=likely.unit,
            )
            value = f"a median of {middle:g}"
            yield warning("unlikely_unit", table.form.file, column=name, value=value, allowed=allowed, action=action)
        elif not unit and likely.each_row:
            values = table.numbers[name]
            above_zero = np.flatnonzero(values > 0)
            ratio = values[above_zero] / middle
            far = above_zero[(ratio > FAR) | (ratio < 1.0 / FAR)]
            if len(far):
                value = values[far[0]]
                more = f", and {len(far) - 1} more like it" if len(far) > 1 else ""
                words = {"unit": likely.unit, "far": FAR, "middle": middle}
                allowed = Message(
                    "numbers in {unit}, within a factor {far:g} of the column's median of {middle:g}", **words
                )
                other = likely.if_low if value < middle else likely.if_high
                action = Message("Look whether this is {value} or a slip of the pen.", value=other)
                yield table.warning(int(far[0]), "unlikely_unit", name, f"{value:g}{more}", allowed, action)


def _median(table: Table, name: str) -> float | None:
    """Median of a column's values above 0, in its unit; None if there are none."""
    values = table.numbers.get(name, np.zeros(0))
    above_zero = values[values > 0]
    return float(np.median(above_zero)) if len(above_zero) else None


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


def _check_missing_units(table: Table, described: CampaignFile | None) -> Iterator[Problem]:
    """Errors for columns whose heading states no unit and whose numbers suggest another unit."""
    if table.form == PENETRATION:
        yield from _loads_and_depths_of_tools(table, described)
    if table.form == SHEAR and "lever_arm_mm" in table.unstated:  # above 5 m in mm, or torque wrenches in cm or m
        arm = table.numbers["lever_arm_mm"]
        rows = np.flatnonzero(np.isfinite(arm)).tolist()
        middle, longest = (np.median(arm[rows]), arm[rows].max()) if rows else (SHORTEST_LEVER_ARM, 0.0)
        if middle < SHORTEST_LEVER_ARM or longest > LONGEST_LEVER_ARM:
            unit = "µm" if longest > LONGEST_LEVER_ARM else "m" if middle < _METRES else "cm"
            yield _missing_unit(table, "lever_arm_mm", f"{arm[rows].min():g} to {longest:g}", unit, rows[0])
    for name in table.unstated:
        median = _median(table, name) if name in LIKELY and name != "lever_arm_mm" else None
        if median is not None and (other := LIKELY[name].other_unit(median)):
            yield _missing_unit(table, name, f"with a median of {median:g}", other.split(" or ", 1)[0])


def _loads_and_depths_of_tools(table: Table, described: CampaignFile | None) -> Iterator[Problem]:
    """One error for each tool whose loads may be in kg, and for each whose depths may be in cm.

    Loads in kg are all small and whole or half numbers, as discs are. The median H_V of depths in cm, taken as mm,
    exceeds any measured one.
    """
    tool, load, depth = table.names["tool"], table.numbers["load_N"], table.numbers["depth_mm"]
    for code, name in enumerate(tool.names if "load_N" in table.unstated else ()):
        loaded = np.flatnonzero((tool.code == code) & np.isfinite(load))
        if len(loaded) and load[loaded].max() < LARGEST_LOAD and not np.any(2.0 * load[loaded] % 1.0):
            values = f"{load[loaded].min():g} to {load[loaded].max():g} with tool {name}"
            yield _missing_unit(table, "load_N", values, "kg", int(loaded[0]))
    for code, name in enumerate(tool.names if "depth_mm" in table.unstated else ()):
        rows = np.flatnonzero((tool.code == code) & np.isfinite(depth)).tolist()
        if described is None or name not in described.tools or not rows:
            continue
        largest = _largest_loads(table, rows)
        volume = described.tools[name].displaced_volume(
            depth[largest] * MM, table.numbers["edge_angle_deg"][largest] * DEGREE
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            hardness = load[largest] / volume / N_PER_MM3
        hardness = np.sort(hardness[np.isfinite(hardness)])
        if len(hardness) and hardness[(len(hardness) - 1) // 2] > HARDEST:
            values = f"{depth[rows].min():g} to {depth[rows].max():g} with tool {name}"
            yield _missing_unit(table, "depth_mm", values, "cm", rows[0])


def _largest_loads(table: Table, rows: Sequence[int]) -> list[int]:
    """Rows with the largest load of each experiment among the given rows; only the first row if all are unloading."""
    load, unloading, key = table.numbers["load_N"], is_unloading(table.names[BRANCH]), table.names[table.form.key].code
    largest: dict[int, int] = {}
    for row in rows:
        before = largest.get(int(key[row]))
        if not unloading[row] and (before is None or load[row] >= load[before]):
            largest[int(key[row])] = row
    return list(largest.values()) or list(rows[:1])


def _missing_unit(table: Table, column: str, values: str, unit: str, row: int = 0) -> Problem:
    """Error for a column whose unit is not stated, with the likely unit and where to write it."""
    heading = table.unstated[column]
    allowed = Message("numbers whose unit is stated")
    words = {"heading": heading, "unit": unit, "line": f'units.{json.dumps(heading, ensure_ascii=False)} = "{unit}"'}
    action = Message(
        "They look like {unit}. State the unit: in the heading, such as {heading} [{unit}], or at the top of "
        "campaign.toml, such as {line}.",
        **words,
    )
    return table.error(row, "unit_missing", column, f"{heading}: {values}", allowed=allowed, action=action)
