"""Required and allowed columns of each table of a campaign, with the allowed numbers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from ..._support.messages import Message
from ..._support.units import ICE_DENSITY
from ...parameters import Quantity


def allowed_words(column: Quantity) -> Message:
    """Allowed numbers of a column in words.

    >>> print(allowed_words(Quantity("edge_angle_deg", "edge angle", lowest=0, highest=90, below=True)))
    a number from 0 to below 90
    """
    if column.allowed == Message("any finite number"):
        return Message("a finite number")
    if column.allowed[0].isdigit():
        return Message("a number of {allowed}", allowed=column.allowed)
    return Message("a number {allowed}", allowed=column.allowed)


@dataclass(frozen=True, slots=True)
class TableForm:
    """Form of one table of a campaign: its required and known columns.

    file: name of the file in the campaign's folder.
    key: column with the name of an experiment, sample or test.
    names: required text columns that must not be blank, in order; the key is one of them.
    numbers: columns of numbers, required and optional.
    texts: required text columns that may be blank.
    optional: optional text columns that are interpreted.
    further: optional columns that are known and kept as text.
    may_be_empty: True if a table with only a header is valid.
    """

    file: str
    key: str
    names: tuple[str, ...]
    numbers: tuple[Quantity, ...] = ()
    texts: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    further: tuple[str, ...] = ()
    may_be_empty: bool = False

    @property
    def name(self) -> str:
        """Name of the table, such as of a sheet: that of the file without its ending."""
        return self.file.removesuffix(".csv")

    @property
    def required(self) -> tuple[str, ...]:
        """Names, required numbers and texts: the columns that a table must have."""
        return self.names + tuple(column.name for column in self.numbers if column.needed) + self.texts

    @property
    def known(self) -> tuple[str, ...]:
        """Names of all columns that skisnow knows."""
        numbers = tuple(column.name for column in self.numbers)
        return tuple(dict.fromkeys(self.names + numbers + self.texts + self.optional + self.further))


_ANGLE: Final = "edge_angle_deg"
_DENSITY: Final = Quantity("snow_density_kg_per_m3", "density of the snow", lowest=0.0, above=True, highest=ICE_DENSITY)
_DROP_CONE: Final = Quantity("drop_cone_depth_mm", "depth of the drop cone: larger where snow is *softer*", lowest=0.0)
_OPTIONAL_DENSITY: Final = replace(_DENSITY, needed=False)
_OPTIONAL_DROP_CONE: Final = replace(_DROP_CONE, needed=False)
_TEMPERATURES: Final = (
    Quantity("air_temperature_C", "temperature of the air", needed=False),
    Quantity("snow_temperature_C", "temperature of the snow", needed=False),
)
_DEPTH: Final = Quantity("depth_mm", "penetration depth", lowest=0.0)
BRANCH: Final = "branch"
"""Column with the branch: a disc was added (loading) or removed (unloading)."""
LOADING: Final = "loading"
UNLOADING: Final = "unloading"
BRANCHES: Final = ("", LOADING, UNLOADING)
"""Allowed values of the column; a blank cell means loading."""

_NOTES: Final = ("time", "air_temperature_C", "snow_temperature_C", "snow_type", "remark")

PENETRATION: Final = TableForm(
    file="penetration.csv",
    key="experiment",
    names=("experiment", "site", "tool"),
    numbers=(
        Quantity(_ANGLE, "above 60 a warning; disc and cylinder: 0", lowest=0.0, highest=90.0, below=True),
        Quantity("load_N", "load", lowest=0.0, above=True),
        _DEPTH,
        Quantity(
            "depth_after_mm", "depth read once more under the same load, after waiting: creep", lowest=0.0, needed=False
        ),
        _OPTIONAL_DENSITY,
        _OPTIONAL_DROP_CONE,
        *_TEMPERATURES,
    ),
    optional=("spot", "status", BRANCH),
    further=_NOTES,
)
SHEAR: Final = TableForm(
    file="shear.csv",
    key="experiment",
    names=("experiment", "site", "plate"),
    numbers=(
        Quantity(_ANGLE, "edge angle", lowest=0.0, above=True, highest=90.0),
        _DEPTH,
        Quantity("lever_arm_mm", "lever arm", lowest=0.0, above=True),
        Quantity("moment_Nm", "moment", lowest=0.0),
        Quantity(
            "turning_angle_deg",
            "how far the device was turned under this moment, from any zero; an experiment may then have several rows",
            lowest=-360.0,
            highest=360.0,
            needed=False,
        ),
        _OPTIONAL_DENSITY,
        _OPTIONAL_DROP_CONE,
        *_TEMPERATURES,
    ),
    optional=("spot", "status"),
    further=_NOTES,
)
DENSITY: Final = TableForm(
    file="density.csv",
    key="sample",
    names=("sample", "site"),
    numbers=(
        _DENSITY,
        Quantity("sample_depth_mm", "depth of the sample's middle below the snow surface", lowest=0.0, needed=False),
        Quantity("sample_thickness_mm", "vertical extent of the sample", lowest=0.0, above=True, needed=False),
        _OPTIONAL_DROP_CONE,
        *_TEMPERATURES,
    ),
    optional=("status",),
    further=("spot", "drop_cone_depth_mm", *_NOTES),
)
DROP_CONE: Final = TableForm(
    file="drop_cone.csv",
    key="test",
    names=("test", "site", "repeat"),
    numbers=(_DROP_CONE, _OPTIONAL_DENSITY, *_TEMPERATURES),
    optional=("status",),
    further=("spot", "snow_density_kg_per_m3", *_NOTES),
)
SNOW_MICRO_PEN: Final = TableForm(
    file="snow_micro_pen.csv",
    key="recording",
    names=("recording", "site", "file"),
    numbers=(
        Quantity(
            "surface_mm", "where the snow begins, from the first sample; blank: estimated", lowest=0.0, needed=False
        ),
    ),
    optional=("spot", "status"),
    further=_NOTES,
)
CORRECTIONS: Final = TableForm(
    file="corrections.csv",
    key="experiment",
    names=("file", "experiment", "column"),
    numbers=(Quantity("row", "line of the file", lowest=1.0),),
    texts=("old", "new", "who", "when", "why"),
    may_be_empty=True,
)

TABLES: Final = (PENETRATION, SHEAR, DENSITY, DROP_CONE, SNOW_MICRO_PEN)
"""The five tables of measurements, in the order in which they are read."""
