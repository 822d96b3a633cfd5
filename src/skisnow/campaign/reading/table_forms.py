"""Required and allowed columns of each table of a campaign, with the allowed numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Final

from ..._support.messages import Message
from ..._support.units import ICE_DENSITY
from ...parameters import Allowed, Quantity, own_quantities

if TYPE_CHECKING:
    pass


def allowed_words(column: Quantity) -> Message:
    """Allowed numbers in words.

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
    """The columns of one file.

    file: name of the file in the campaign's folder.
    key: the column that names an experiment, sample or test.
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
    def required(self) -> tuple[str, ...]:
        """Required columns."""
        return self.names + tuple(column.name for column in self.numbers if column.needed) + self.texts

    @property
    def known(self) -> tuple[str, ...]:
        """All known columns."""
        numbers = tuple(column.name for column in self.numbers)
        return tuple(dict.fromkeys(self.names + numbers + self.texts + self.optional + self.further))


_DENSITY: Final = Quantity("snow_density_kg_per_m3", "density of the snow", lowest=0.0, above=True, highest=ICE_DENSITY)
_DROP_CONE: Final = Quantity("drop_cone_depth_mm", "depth of the drop cone: larger where snow is *softer*", lowest=0.0)
_AIR: Final = Quantity("air_temperature_C", "temperature of the air")
_SNOW: Final = Quantity("snow_temperature_C", "temperature of the snow")
_DEPTH: Final = Quantity("depth_mm", "penetration depth", lowest=0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class PenetrationRow:
    """The numbers of a row of penetration.csv."""

    edge_angle: Annotated[
        float,
        Quantity("edge_angle_deg", "above 60 a warning; disc and cylinder: 0"),
        Allowed(0.0, 90.0, below=True),
    ]
    load: Annotated[float, Quantity("load_N", "load"), Allowed(0.0, above=True)]
    depth: Annotated[float, _DEPTH]
    depth_after: Annotated[
        float | None,
        Quantity("depth_after_mm", "depth read once more under the same load, after waiting: creep"),
        Allowed(0.0),
    ] = None
    snow_density: Annotated[float | None, _DENSITY] = None
    drop_cone_depth: Annotated[float | None, _DROP_CONE] = None
    air_temperature: Annotated[float | None, _AIR] = None
    snow_temperature: Annotated[float | None, _SNOW] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ShearRow:
    """The numbers of a row of shear.csv."""

    edge_angle: Annotated[float, Quantity("edge_angle_deg", "edge angle"), Allowed(0.0, 90.0, above=True)]
    depth: Annotated[float, _DEPTH]
    lever_arm: Annotated[float, Quantity("lever_arm_mm", "lever arm"), Allowed(0.0, above=True)]
    moment: Annotated[float, Quantity("moment_Nm", "moment"), Allowed(0.0)]
    turning_angle: Annotated[
        float | None,
        Quantity(
            "turning_angle_deg",
            "how far the device was turned under this moment, from any zero; an experiment may then have several rows",
        ),
        Allowed(-360.0, 360.0),
    ] = None
    snow_density: Annotated[float | None, _DENSITY] = None
    drop_cone_depth: Annotated[float | None, _DROP_CONE] = None
    air_temperature: Annotated[float | None, _AIR] = None
    snow_temperature: Annotated[float | None, _SNOW] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class DensityRow:
    """The numbers of a row of density.csv."""

    snow_density: Annotated[float, _DENSITY]
    sample_depth: Annotated[
        float | None,
        Quantity("sample_depth_mm", "depth of the sample's middle below the snow surface"),
        Allowed(0.0),
    ] = None
    sample_thickness: Annotated[
        float | None,
        Quantity("sample_thickness_mm", "vertical extent of the sample"),
        Allowed(0.0, above=True),
    ] = None
    drop_cone_depth: Annotated[float | None, _DROP_CONE] = None
    air_temperature: Annotated[float | None, _AIR] = None
    snow_temperature: Annotated[float | None, _SNOW] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class DropConeRow:
    """The numbers of a row of drop_cone.csv."""

    drop_cone_depth: Annotated[float, _DROP_CONE]
    snow_density: Annotated[float | None, _DENSITY] = None
    air_temperature: Annotated[float | None, _AIR] = None
    snow_temperature: Annotated[float | None, _SNOW] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingRow:
    """The numbers of a row of snow_micro_pen.csv."""

    surface: Annotated[
        float | None,
        Quantity("surface_mm", "where the snow begins, from the first sample; blank: estimated"),
        Allowed(0.0),
    ] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class CorrectionRow:
    """The number of a row of corrections.csv."""

    row: Annotated[float, Quantity("row", "line of the file"), Allowed(1.0)]


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
    numbers=own_quantities(PenetrationRow),
    optional=("spot", "status", BRANCH),
    further=_NOTES,
)
SHEAR: Final = TableForm(
    file="shear.csv",
    key="experiment",
    names=("experiment", "site", "plate"),
    numbers=own_quantities(ShearRow),
    optional=("spot", "status"),
    further=_NOTES,
)
DENSITY: Final = TableForm(
    file="density.csv",
    key="sample",
    names=("sample", "site"),
    numbers=own_quantities(DensityRow),
    optional=("status",),
    further=("spot", "drop_cone_depth_mm", *_NOTES),
)
DROP_CONE: Final = TableForm(
    file="drop_cone.csv",
    key="test",
    names=("test", "site", "repeat"),
    numbers=own_quantities(DropConeRow),
    optional=("status",),
    further=("spot", "snow_density_kg_per_m3", *_NOTES),
)
SNOW_MICRO_PEN: Final = TableForm(
    file="snow_micro_pen.csv",
    key="recording",
    names=("recording", "site", "file"),
    numbers=own_quantities(RecordingRow),
    optional=("spot", "status"),
    further=_NOTES,
)
CORRECTIONS: Final = TableForm(
    file="corrections.csv",
    key="experiment",
    names=("file", "experiment", "column"),
    numbers=own_quantities(CorrectionRow),
    texts=("old", "new", "who", "when", "why"),
    may_be_empty=True,
)

TABLES: Final = (PENETRATION, SHEAR, DENSITY, DROP_CONE, SNOW_MICRO_PEN)
"""The five tables of measurements, in the order in which they are read."""
