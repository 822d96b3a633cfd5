"""Reader of campaign.toml, its plates, tools and quality flags, and the JSON Schema of the file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, Final

from ..._support.messages import Message
from ..._support.units import MM
from ..._support.user_files.text_files import ContentError, toml_values
from ...geometry import Disc, LyingCylinder, SkiPiece, Tool
from ...geometry.tools import LIKELY_LENGTH_MM
from ...parameters import Allowed, Quantity, own_quantities
from ...parameters.json_schema import DRAFT, Schema, table_schema
from ..problems import ALWAYS_EXCLUDE, QUALITY_FLAGS, Problem, error, warning
from ..smet import WeatherSettings
from ..snow_micro_pen import SnowMicroPenSettings
from .headings import KEY as COLUMNS_KEY
from .headings import UNITS_KEY, Headings, parse_headings
from .toml_values import TomlValues

CAMPAIGN_FILE: Final = "campaign.toml"


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Description:
    """Values in campaign.toml, in SI, that a campaign has as they are.

    name, place, observers: texts; the default name is that of the folder.
    gauge_resolution: step of the depth gauge (m), or None if not stated.
    load_uncertainty, moment_uncertainty, lever_arm_uncertainty: standard uncertainties (N, N m, m); None counts as 0.
    seating: standard deviation of the depth zero from series to series (m); None where not stated.
    pole_stiffness: moment over twist of the shear device between angle and plate (N m/rad); None: rigid.
    load_steps: loads of the campaign's discs (N), for entry; can be empty.
    tools, plates: tools by name; plate lengths L (m) by name.
    excluding: codes of the quality flags that keep an experiment out of the estimates.
    """

    name: Annotated[str | None, Quantity("name", "name of the campaign; left out or blank: the folder's", blank=True)]
    place: Annotated[str, Quantity("place", "where", blank=True)] = ""
    observers: tuple[str, ...] = ()
    gauge_resolution: Annotated[
        float | None,
        Quantity(
            "gauge_resolution_mm",
            "step of the depth gauge; a reading's standard uncertainty is step/√12. Default: no depth uncertainty and "
            "no `below_resolution` flag, with a note in the report",
        ),
        Allowed(0.0, above=True, usual=(0.0005, 5.0)),
    ] = None
    load_uncertainty: Annotated[
        float | None,
        Quantity(
            "load_uncertainty_N",
            "standard uncertainty of a load; default: 0, with a note in the report, as for the next two",
        ),
        Allowed(0.0),
    ] = None
    seating: Annotated[
        float | None,
        Quantity(
            "seating_mm",
            "standard deviation of the depth zero from series to series, where it is known, for example from repeated "
            "seating on a plate; optional: 0.05 mm, which the series of the campaign correct",
        ),
        Allowed(0.0, above=True, usual=(0.001, 1.0)),
    ] = None
    moment_uncertainty: Annotated[
        float | None, Quantity("moment_uncertainty_Nm", "standard uncertainty of a moment"), Allowed(0.0)
    ] = None
    lever_arm_uncertainty: Annotated[
        float | None, Quantity("lever_arm_uncertainty_mm", "standard uncertainty of a lever arm"), Allowed(0.0)
    ] = None
    pole_stiffness: Annotated[
        float | None,
        Quantity(
            "pole_stiffness_Nm_per_deg",
            "moment that twists the shear device's pole by a degree between where its turning angle is read and the "
            "plate; default: rigid, or read at the plate",
        ),
        Allowed(0.0, above=True),
    ] = None
    load_steps: Annotated[
        tuple[float, ...], Quantity("load_steps_N", "the campaign's own discs, for entry"), Allowed(0.0, above=True)
    ] = ()
    tools: Mapping[str, Tool]
    plates: Mapping[str, float]
    excluding: frozenset[str]


@dataclass(frozen=True, slots=True, kw_only=True)
class CampaignFile(Description):
    """Content of campaign.toml in SI.

    ``tool_names`` and ``plate_names`` include tools and plates with invalid lengths. ``flat_tools`` are the tools
    without an edge, whose edge angle must be 0.
    """

    tool_names: frozenset[str]
    plate_names: frozenset[str]
    flat_tools: frozenset[str]
    headings: Headings
    snow_micro_pen: SnowMicroPenSettings
    weather: WeatherSettings


CAMPAIGN_KEYS: Final = {key.name: key for key in own_quantities(CampaignFile)}
"""Keys with one value or a list of numbers."""
_PLATE_LENGTH: Final = Quantity("length_mm", "length of the blade", lowest=0.0, above=True, usual=LIKELY_LENGTH_MM)
IMPORT_ANSWERS: Final = ("table", "column", "unit", "site", "tool", "plate", "cells", "ignore")
"""Tables of ``[import]``: answers of an import by option."""
IMPORT_KEYS: Final = ("template", "file", "sha256", "notes", *IMPORT_ANSWERS)
_SECTIONS: Final = ("tool", "plate", "screening", COLUMNS_KEY, UNITS_KEY, "snow_micro_pen", "weather", "import")
TOP_KEYS: Final = ("name", "place", "observers", *list(CAMPAIGN_KEYS)[2:], *_SECTIONS)


def read_campaign_file(text: str, problems: list[Problem]) -> CampaignFile | None:
    """Content of the text of campaign.toml, or None if it is not TOML.

    Invalid values are missing, with an error that is added to ``problems``.
    """
    try:
        parsed = toml_values(text.replace("\r\n", "\n").replace("\r", "\n"))
    except ContentError as failure:
        allowed = Message("TOML (toml.io)")
        action = Message(
            "Correct the line: write texts in quotes, numbers with a decimal point, and lists in brackets."
        )
        problems.append(
            error("bad_toml", CAMPAIGN_FILE, row=failure.line, value=failure.what, allowed=allowed, action=action)
        )
        return None
    top = TomlValues(CAMPAIGN_FILE, parsed, "", problems)
    top.refuse_misspelt(TOP_KEYS)
    top.table("import").refuse_misspelt(IMPORT_KEYS)
    tools, tool_names, flat_tools = _read_tools(top)
    plates: dict[str, float] = {}
    plate_names: set[str] = set()
    for entry in top.tables("plate"):
        name = _new_name(entry, plate_names)
        entry.refuse_misspelt(("name", "length_mm"))
        length = _required_length(entry, _PLATE_LENGTH)
        if name is not None and length is not None:
            plates[name] = length
    pen = top.table("snow_micro_pen")
    settings = pen.declared(SnowMicroPenSettings)
    if settings.from_depth >= settings.to_depth:
        allowed = Message("a depth above from_depth_mm, {from_depth:g}", from_depth=settings.from_depth / MM)
        pen.refuse("to_depth_mm", allowed, Message("Correct one of the two."), value=f"{settings.to_depth / MM:g}")
    return CampaignFile(
        name=top.text("name", blank_allowed=True),
        place=top.text("place", blank_allowed=True) or "",
        observers=top.texts("observers"),
        **{key.field: _in_si(top, key) for key in CAMPAIGN_KEYS.values() if key.kind == "number"},
        load_steps=top.numbers(CAMPAIGN_KEYS["load_steps_N"]),
        tools=tools,
        plates=plates,
        tool_names=tool_names,
        plate_names=frozenset(plate_names),
        flat_tools=flat_tools,
        excluding=_excluding(top),
        headings=parse_headings(top),
        snow_micro_pen=settings,
        weather=top.table("weather").declared(WeatherSettings),
    )


def _read_tools(top: TomlValues) -> tuple[dict[str, Tool], frozenset[str], frozenset[str]]:
    """Tools with valid lengths by name, names of all tools, and names of tools without an edge."""
    tools: dict[str, Tool] = {}
    names: set[str] = set()
    flat: set[str] = set()
    for entry in top.tables("tool"):
        name = _new_name(entry, names)
        allowed = Message("one of {shapes}", shapes=list(SHAPES))
        if "shape" not in entry.values:
            entry.refuse("shape", allowed, Message("Add the shape."))
        shape_name = entry.text("shape")
        shape = SHAPES.get(shape_name or "")
        if shape is None:
            if shape_name is not None:
                entry.refuse_unknown("shape", shape_name, SHAPES, allowed, Message("Correct the shape."))
            continue
        entry.refuse_misspelt(("name", "shape", *shape.lengths))
        lengths = {length.field: _required_length(entry, length) for length in shape.lengths.values()}
        if name is not None and all(length is not None for length in lengths.values()):
            tools[name] = shape.tool(**lengths)
        if name is not None and not shape.has_edge:
            flat.add(name)
    return tools, frozenset(names), frozenset(flat)


def _new_name(entry: TomlValues, names: set[str]) -> str | None:
    """Read a name and add it to `names`; None, with an error, if it is missing or repeated."""
    if "name" not in entry.values:
        entry.refuse("name", Message("a name"), Message("Add the name that the tables use."))
    name = entry.text("name")
    if name in names:
        entry.refuse("name", Message("each name once"), Message("Rename or remove one of the two."))
        return None
    if name is not None:
        names.add(name)
    return name


def _required_length(entry: TomlValues, quantity: Quantity) -> float | None:
    """Length (m) of a required key; None, with an error added, if it is missing or invalid."""
    if quantity.name not in entry.values:
        entry.refuse(quantity.name, Message("a length in mm above 0"), Message("Add {name}.", name=quantity.name))
    return _in_si(entry, quantity)


def _in_si(entry: TomlValues, quantity: Quantity) -> float | None:
    """Number of a key in SI, None if missing or invalid; adds a warning for a length that is probably not in mm."""
    value = entry.number(quantity)
    if value is not None and quantity.usual is not None and not quantity.usual[0] <= value <= quantity.usual[1]:
        low, high = quantity.usual
        unit = "m" if value < low else "µm"
        path = entry.path_of(quantity.name)
        allowed = Message("a number in mm; {low:g} to {high:g} is usual", low=low, high=high)
        action = Message("If this is in {unit} convert it to mm; if it is in mm no action is needed.", unit=unit)
        entry.problems.append(
            warning("unlikely_unit", CAMPAIGN_FILE, column=path, value=f"{value:g}", allowed=allowed, action=action)
        )
    return None if value is None else quantity.in_si(value)


def _excluding(top: TomlValues) -> frozenset[str]:
    """Codes of the quality flags that exclude experiments: those of the file or the default, and `ALWAYS_EXCLUDE`."""
    screening = top.table("screening")
    screening.refuse_misspelt(("exclude",))
    if "exclude" not in screening.values:
        return frozenset(code for code, flag in QUALITY_FLAGS.items() if flag.excludes_by_default)
    codes = screening.texts("exclude")
    for code in codes:
        if code not in QUALITY_FLAGS:
            allowed = Message("codes among {quality_flags}", quality_flags=list(QUALITY_FLAGS))
            screening.refuse_unknown("exclude", code, QUALITY_FLAGS, allowed, Message("Correct the code."))
    return (frozenset(codes) & frozenset(QUALITY_FLAGS)) | ALWAYS_EXCLUDE


@dataclass(frozen=True, slots=True)
class Shape:
    """Shape of a tool: class of its geometry, and True if it has an edge, so that it can be tilted."""

    tool: type[Tool]
    has_edge: bool

    @property
    def lengths(self) -> dict[str, Quantity]:
        """Quantities of the shape's lengths by their keys in campaign.toml."""
        return {length.name: length for length in own_quantities(self.tool)}


SHAPES: Final[Mapping[str, Shape]] = MappingProxyType(
    {
        "ski": Shape(SkiPiece, has_edge=True),
        "disc": Shape(Disc, has_edge=False),
        "cylinder": Shape(LyingCylinder, has_edge=False),
    }
)
"""Every shape by its name in campaign.toml."""


_NAME: Final[Schema] = {"type": "string", "pattern": "\\S", "description": "Unique in its list."}


def campaign_schema() -> Schema:
    """JSON Schema of a parsed campaign.toml."""
    words = "Codes of the quality flags that exclude an experiment; replaces the default."
    exclude = {"description": words, **_one_or_several({"$ref": "#/$defs/mark"})}
    shapes = {name: table_schema(shape.lengths.values()) for name, shape in SHAPES.items()}
    return {
        "$schema": DRAFT,
        "$id": "urn:skisnow:schema:campaign:1",
        "title": "campaign.toml of a skisnow campaign, parsed",
        "description": "Units are part of the keys. Keys that are not listed here are ignored with a warning; keys "
        "that are nearly one of these are refused as misspelt.",
        "type": "object",
        "properties": {
            **table_schema(CAMPAIGN_KEYS.values())["properties"],
            "observers": {"description": "who", **_one_or_several({"type": "string"})},
            "tool": {"type": "array", "items": {"$ref": "#/$defs/tool"}},
            "plate": {"type": "array", "items": {"$ref": "#/$defs/plate"}},
            "columns": _by_heading("Column of the numbers or texts below a heading"),
            "units": _by_heading("Unit of the numbers below a heading that names none"),
            "import": {"type": "object", "description": "File, answers and notes of skisnow import."},
            "snow_micro_pen": {
                "description": "How the recordings that snow_micro_pen.csv names are evaluated.",
                **table_schema(own_quantities(SnowMicroPenSettings)),
            },
            "weather": {
                "description": "Readings of a weather station, in SMET.",
                **table_schema(own_quantities(WeatherSettings)),
            },
            "screening": {"type": "object", "properties": {"exclude": exclude}},
        },
        "$defs": {
            "mark": {"enum": list(QUALITY_FLAGS)},
            "tool": {
                "type": "object",
                "properties": {"name": _NAME, "shape": {"enum": list(SHAPES)}},
                "required": ["name", "shape"],
                "oneOf": [
                    {"properties": {"shape": {"const": name}, **keys["properties"]}, "required": keys["required"]}
                    for name, keys in shapes.items()
                ],
            },
            "plate": {
                "type": "object",
                "properties": {"name": _NAME, **table_schema([_PLATE_LENGTH])["properties"]},
                "required": ["name", "length_mm"],
            },
        },
    }


def _one_or_several(item: Schema) -> Schema:
    """Schema of one item or a list of them."""
    return {"anyOf": [item, {"type": "array", "items": item}]}


def _by_heading(words: str) -> Schema:
    """Schema of a mapping from headings to texts, for all tables or nested for one table; ``words`` describe it."""
    pairs = {"type": "object", "additionalProperties": {"type": "string"}}
    either: Schema = {"anyOf": [{"type": "string"}, pairs]}
    words = f"{words}; in a table of a table's name, such as penetration, for that one."
    return {"description": words, "type": "object", "additionalProperties": either}
