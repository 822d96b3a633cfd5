"""What a new campaign's tables begin with: columns, and a row as an example that no estimate counts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from ...snow.published import moessner_2013
from ..reading.table_forms import DENSITY, DROP_CONE, PENETRATION, SHEAR, allowed_words
from ..reference import design

if TYPE_CHECKING:
    from ...parameters import Quantity
    from ..reading.table_forms import TableForm

EXAMPLE_STATUS: Final = "example: write over or delete this row"
"""A status cancels the experiment: the example is in no estimate even where it is left standing."""
TOOL: Final = design.TOOL
TOOL_LENGTHS_MM: Final = (moessner_2013.TOOL_LENGTH_MM, moessner_2013.TOOL_WIDTH_MM)
PLATE: Final = design.PLATE
PLATE_LENGTH_MM: Final = design.PLATE_LENGTH * 1e3
LOADS_N: Final = design.LOADS
"""Evenly spaced between the paper's 12 and 492 N."""
GAUGE_RESOLUTION_MM: Final = 0.01


@dataclass(frozen=True, slots=True)
class Template:
    """A table with one row; the cells by the names of the columns."""

    form: TableForm
    example: Mapping[str, str | float]

    @property
    def numbers(self) -> dict[str, Quantity]:
        """The columns of numbers."""
        return {quantity.name: quantity for quantity in self.form.numbers}

    def explained(self) -> Iterator[tuple[str, str]]:
        """Each column with what stands in it."""
        for name in self.example:
            quantity = self.numbers.get(name)
            yield name, WORDS.get(name, "") if quantity is None else f"{quantity.meaning}; {_unit(quantity)}"


def _unit(quantity: Quantity) -> str:
    return f"{allowed_words(quantity)} in {quantity.unit}"


WORDS: Final = {
    "experiment": "one name for all rows of an experiment, in their order",
    "sample": "a name for each sample",
    "test": "one name for all repeats of a test",
    "site": "where; sites are compared with each other",
    "spot": "may be blank: a spot of the site, which pairs penetration and shear tests",
    "tool": "a tool that the campaign describes",
    "plate": "a plate that the campaign describes",
    "repeat": "which repeat of the test",
    "time": "may be blank: day and time, such as 2026-11-23T09:10 or 23.11.2026 09:10",
    "status": "blank; a word cancels the experiment and says why",
    "remark": "may be blank",
}
_LAST: Final = {"time": "2026-11-23T09:10", "status": EXAMPLE_STATUS, "remark": ""}

TEMPLATES: Final = (
    Template(
        PENETRATION,
        {
            "experiment": "P1", "site": "site A", "spot": "1", "tool": TOOL, "edge_angle_deg": 30.0,
            "load_N": LOADS_N[0], "depth_mm": 1.25, **_LAST,
        },
    ),
    Template(
        SHEAR,
        {
            "experiment": "S1", "site": "site A", "spot": "1", "plate": PLATE, "edge_angle_deg": 90.0,
            "depth_mm": 5.5, "lever_arm_mm": 250.0, "moment_Nm": 12.25, **_LAST,
        },
    ),
    Template(DENSITY, {"sample": "D1", "site": "site A", "snow_density_kg_per_m3": 420.0, **_LAST}),
    Template(DROP_CONE, {"test": "C1", "site": "site A", "repeat": "1", "drop_cone_depth_mm": 13.5, **_LAST}),
)  # fmt: skip
