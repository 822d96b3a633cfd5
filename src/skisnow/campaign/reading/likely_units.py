"""Numbers that hardly can be in the unit that their column's name says: kN, metres, N mm, g/cm³.

They are computed with as they stand; the warning names what was found. A whole file in another unit shows by its
median, single rows by their distance from it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from ..problems import warning

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..problems import Problem
    from .table import Table

FAR: Final = 500.0
"""Factor from the median of its column beyond which a number is reported: loads of one campaign span less."""


@dataclass(frozen=True, slots=True)
class LikelyColumn:
    """Between what limits the median of a column's numbers above 0 is likely, and whether single rows are judged."""

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
            yield _whole_column(table, name, likely, *unlikely)
        elif unlikely is None and likely.each_row:
            values = table.numbers[name]
            above_zero = np.flatnonzero(values > 0)
            ratio = values[above_zero] / middle
            far = above_zero[(ratio > FAR) | (ratio < 1.0 / FAR)]
            if len(far):
                yield _some_rows(table, name, likely, middle, far.tolist())


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


def _whole_column(table: Table, name: str, likely: LikelyColumn, middle: float, unit: str) -> Problem:
    return warning(
        "unlikely_unit",
        table.form.file,
        column=name,
        value=f"a median of {middle:g}",
        allowed=f"numbers in {likely.unit}; medians of {likely.low:g} to {likely.high:g} are usual",
        action=f"If these are {unit} convert them to {likely.unit}; if they are {likely.unit} nothing need be done.",
    )


def _some_rows(table: Table, name: str, likely: LikelyColumn, middle: float, rows: list[int]) -> Problem:
    value = table.numbers[name][rows[0]]
    more = f", and {len(rows) - 1} more like it" if len(rows) > 1 else ""
    return warning(
        "unlikely_unit",
        table.form.file,
        row=int(table.row[rows[0]]),
        column=name,
        experiment=table.names[table.form.key][rows[0]] or None,
        value=f"{value:g}{more}",
        allowed=f"numbers in {likely.unit}, within a factor {FAR:g} of the column's median of {middle:g}",
        action=f"Look whether this is {likely.if_low if value < middle else likely.if_high} or a slip of the pen.",
    )
