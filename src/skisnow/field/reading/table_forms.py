"""What each table of a campaign must and may have: columns, and the numbers that are allowed in them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from ...constants import ICE_DENSITY

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..records import FloatArray


@dataclass(frozen=True, slots=True)
class NumberColumn:
    """A column of finite numbers between two limits, in the unit that its name says.

    >>> NumberColumn("edge_angle_deg", low=0, high=90, high_allowed=False).allowed
    'a number of at least 0 and below 90'
    """

    name: str
    low: float = -math.inf
    high: float = math.inf
    low_allowed: bool = True
    high_allowed: bool = True
    required: bool = True

    @property
    def allowed(self) -> str:
        """Say in words which numbers are allowed."""
        low = f"{'of at least' if self.low_allowed else 'above'} {self.low:g}" if self.low > -math.inf else ""
        high = f"{'at most' if self.high_allowed else 'below'} {self.high:g}" if self.high < math.inf else ""
        limits = " and ".join(filter(None, (low, high)))
        return f"a number {limits}" if limits else "a finite number"

    def is_outside(self, values: FloatArray) -> npt.NDArray[np.bool_]:
        """Tell which values are outside the limits; NaN is not."""
        below = values < self.low if self.low_allowed else values <= self.low
        above = values > self.high if self.high_allowed else values >= self.high
        return below | above


@dataclass(frozen=True, slots=True)
class TableForm:
    """The columns of one file.

    Attributes
    ----------
    file
        Its name in the campaign's folder.
    key
        The column that names an experiment, sample or test.
    names
        Required text columns that may not be blank, in order; the key is one of them.
    numbers
        Columns of numbers, required and optional.
    texts
        Required text columns that may be blank.
    optional
        Optional text columns that are interpreted.
    further
        Optional columns that are known and kept as text.
    may_be_empty
        Whether a header alone is fine.
    """

    file: str
    key: str
    names: tuple[str, ...]
    numbers: tuple[NumberColumn, ...] = ()
    texts: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    further: tuple[str, ...] = ()
    may_be_empty: bool = False

    @property
    def required(self) -> tuple[str, ...]:
        """Columns that the file must have."""
        return self.names + tuple(column.name for column in self.numbers if column.required) + self.texts

    @property
    def known(self) -> tuple[str, ...]:
        """Every column that this file may have without being asked about it."""
        numbers = tuple(column.name for column in self.numbers)
        return tuple(dict.fromkeys(self.names + numbers + self.texts + self.optional + self.further))


def _density(*, required: bool) -> NumberColumn:
    return NumberColumn("snow_density_kg_per_m3", low=0, low_allowed=False, high=ICE_DENSITY, required=required)


def _drop_cone(*, required: bool) -> NumberColumn:
    return NumberColumn("drop_cone_depth_mm", low=0, required=required)


_TEMPERATURES: Final = (
    NumberColumn("air_temperature_C", required=False),
    NumberColumn("snow_temperature_C", required=False),
)
_REMARKS: Final = ("time", "air_temperature_C", "snow_temperature_C", "snow_type", "remark")

PENETRATION: Final = TableForm(
    file="penetration.csv",
    key="experiment",
    names=("experiment", "site", "tool"),
    numbers=(
        NumberColumn("edge_angle_deg", low=0, high=90, high_allowed=False),
        NumberColumn("load_N", low=0, low_allowed=False),
        NumberColumn("depth_mm", low=0),
        _density(required=False),
        _drop_cone(required=False),
        *_TEMPERATURES,
    ),
    optional=("spot", "status"),
    further=_REMARKS,
)
SHEAR: Final = TableForm(
    file="shear.csv",
    key="experiment",
    names=("experiment", "site", "plate"),
    numbers=(
        NumberColumn("edge_angle_deg", low=0, low_allowed=False, high=90),
        NumberColumn("depth_mm", low=0),
        NumberColumn("lever_arm_mm", low=0, low_allowed=False),
        NumberColumn("moment_Nm", low=0),
        _density(required=False),
        _drop_cone(required=False),
        *_TEMPERATURES,
    ),
    optional=("spot", "status"),
    further=_REMARKS,
)
DENSITY: Final = TableForm(
    file="density.csv",
    key="sample",
    names=("sample", "site"),
    numbers=(_density(required=True), _drop_cone(required=False), *_TEMPERATURES),
    optional=("status",),
    further=("spot", "drop_cone_depth_mm", *_REMARKS),
)
DROP_CONE: Final = TableForm(
    file="drop_cone.csv",
    key="test",
    names=("test", "site", "repeat"),
    numbers=(_drop_cone(required=True), _density(required=False), *_TEMPERATURES),
    optional=("status",),
    further=("spot", "snow_density_kg_per_m3", *_REMARKS),
)
CORRECTIONS: Final = TableForm(
    file="corrections.csv",
    key="experiment",
    names=("file", "experiment", "column"),
    numbers=(NumberColumn("row", low=1),),
    texts=("old", "new", "who", "when", "why"),
    may_be_empty=True,
)

TABLES: Final = (PENETRATION, SHEAR, DENSITY, DROP_CONE)
"""The four tables of measurements, in the order in which they are read."""
