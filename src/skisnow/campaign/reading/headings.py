"""Headings of tables: mapping to columns by ``[columns]`` in campaign.toml, synonyms, units and conversions."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Final

from ..._support.arrays import FloatArray
from ..._support.messages import Message
from ..._support.units import DEGREE, KILOGRAM_FORCE, ZERO_CELSIUS
from .table_forms import CORRECTIONS, TABLES, TableForm
from .toml_values import TomlValues

KEY: Final = "columns"
UNITS_KEY: Final = "units"
FORMS: Final = {form.name: form for form in (*TABLES, CORRECTIONS)}
"""Tables by the names that ``[columns.NAME]`` and sheets of a workbook have."""


@dataclass(frozen=True, slots=True)
class Headings:
    """Mapping of headings in campaign.toml: columns and units of the numbers, by file and `plain_heading`.

    The file "" is for all tables; entries of a table's file override them.
    """

    columns: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    units: Mapping[str, Mapping[str, str]] = field(default_factory=dict)

    def name(self, form: TableForm, heading: str) -> str:
        """Column of a heading, or the heading itself if it is not mapped."""
        name = _entry(self.columns, form, heading)
        return name if name in form.known else heading

    def unit(self, form: TableForm, heading: str) -> str:
        """Unit that campaign.toml states for a heading of a table, otherwise ""."""
        return _entry(self.units, form, heading)

    def without_heading(self, headings: Mapping[str, Sequence[str]]) -> Iterator[str]:
        """Paths in campaign.toml of units whose heading is in no table; `headings`: those of the tables by file."""
        there = {file: {plain_heading(heading) for heading in names} for file, names in headings.items()}
        there[""] = set().union(*there.values())
        for file, units in self.units.items():
            section = ".".join(filter(None, (UNITS_KEY, file.removesuffix(".csv"))))
            yield from (f"{section}.{name}" for name in units if name not in there.get(file, set()))


def _entry(entries: Mapping[str, Mapping[str, str]], form: TableForm, heading: str) -> str:
    """Entry for a heading, first of its table, then of all tables; "" without one."""
    plain = plain_heading(heading)
    return next((entries[file][plain] for file in (form.file, "") if plain in entries.get(file, {})), "")


def plain_heading(heading: str) -> str:
    r"""Heading with normalised case, white space and Unicode form, for comparisons.

    >>> plain_heading(" Kantwinkel\n[°] ")
    'kantwinkel [°]'
    """
    return " ".join(unicodedata.normalize("NFC", heading).split()).casefold()


def parse_headings(top: TomlValues) -> Headings:
    """Read ``[columns]`` and ``[units]`` of campaign.toml, for all tables or for one as ``[columns.penetration]``."""
    return Headings(_by_table(top.table(KEY), _name), _by_table(top.table(UNITS_KEY), _unit))


def _by_table(
    section: TomlValues, entry: Callable[[TomlValues, str, tuple[str, ...]], str]
) -> dict[str, dict[str, str]]:
    """Entries of a section by the file of a table, "" for all tables, and by plain heading.

    entry: reader of the value of a heading in a section, given the names of the columns; "" for an invalid one.
    """
    entries: dict[str, dict[str, str]] = {"": {}}
    every_name = tuple(dict.fromkeys(name for form in FORMS.values() for name in form.known))
    for heading, value in section.values.items():
        if heading in FORMS and isinstance(value, Mapping):
            file, known, table = FORMS[heading].file, FORMS[heading].known, section.table(heading)
            texts = {name: entry(table, name, known) for name in table.values}
        else:
            file, texts = "", {heading: entry(section, heading, every_name)}
        entries.setdefault(file, {}).update({plain_heading(name): text for name, text in texts.items() if text})
    return entries


def _unit(section: TomlValues, heading: str, _columns: tuple[str, ...]) -> str:
    """Unit that an entry such as ``"Last" = "kg"`` states for a heading; "", with an error, if it is unknown."""
    value = section.values[heading]
    unit = known_unit(value) if isinstance(value, str) else ""
    if not unit:
        every_unit = ", ".join(units_for(f"_{of_column}") for of_column in _OWN)
        allowed = Message("one of the units {every_unit}", every_unit=every_unit)
        section.refuse(heading, allowed, Message("Write the unit in quotes."))
    return unit


def _name(section: TomlValues, heading: str, columns: tuple[str, ...]) -> str:
    """Column that an entry of ``[columns]`` states for a heading; "", with an error, if it is unknown."""
    value = section.values[heading]
    if isinstance(value, str) and value.strip() in columns:
        return value.strip()
    write = Message("Write the heading, an equals sign and the column's name, both in quotes.")
    allowed = Message("one of the columns {columns}", columns=list(columns))
    section.refuse_unknown(heading, value, columns, allowed, write)
    return ""


_OWN: Final = {
    "deg": ("°", "deg", "degree", "degrees", "Grad", "Winkelgrad"), "N": ("N", "Newton"),
    "mm": ("mm", "Millimeter"), "Nm": ("Nm", "N m", "N·m", "N*m"),
    "kg_per_m3": ("kg/m³", "kg/m3", "kg/m^3", "kg m-3", "kg·m⁻³", "g/l"), "C": ("°C", "Grad C", "Celsius"),
}  # fmt: skip
"""Units of columns, as the last part of a column's name writes them, with their names in headings."""
_OTHER: Final[dict[str, dict[tuple[str, ...], tuple[float, float]]]] = {
    "deg": {("rad",): (1.0 / DEGREE, 0.0)},
    "N": {
        ("kg", "kgf", "kp"): (KILOGRAM_FORCE, 0.0),
        ("g", "Gramm"): (1e-3 * KILOGRAM_FORCE, 0.0),
        ("kN",): (1e3, 0.0),
        ("daN",): (10.0, 0.0),
    },
    "mm": {
        ("cm", "Zentimeter"): (10.0, 0.0),
        ("m", "Meter"): (1e3, 0.0),
        ("dm",): (100.0, 0.0),
        ("µm", "μm", "um"): (1e-3, 0.0),
        ("in", "inch"): (25.4, 0.0),
    },
    "Nm": {
        ("Ncm", "N cm", "N·cm"): (1e-2, 0.0),
        ("Nmm", "N mm", "N·mm"): (1e-3, 0.0),
        ("kNm", "kN m", "kN·m"): (1e3, 0.0),
    },
    "kg_per_m3": {("g/cm³", "g/cm3", "g/cm^3", "g cm-3", "kg/l", "kg/dm³", "kg/dm3", "t/m³", "t/m3"): (1e3, 0.0)},
    "C": {("K", "Kelvin"): (1.0, -ZERO_CELSIUS), ("°F", "Fahrenheit"): (5.0 / 9.0, -160.0 / 9.0)},
}
"""Factor and shift from other units to those of columns."""
_ONLY_NAMED: Final = ("mn", "s", "min", "h", "%", "pa", "kpa", "mpa")
"""Units that no column is converted from."""
FORM: Final = re.compile(
    r"(?P<words>[^\[(]*?)\s*(?:[\[(](?P<in>[^\])]*)[\])]?|/\s*(?P<per>\S+)|\bin\s+(?P<of>\S+))?\s*"
)
_LAST_WORD: Final = re.compile(
    r".*[^\s_,][\s_,]+(mm|cm|µm|μm|kg|N|kN|Nm|Ncm|Nmm|°|°C|kg/m³|kg/m3|g/cm³|g/cm3|kg/l)|.*[^\s_]_m"
)
"""Headings that end with a unit without brackets: Last kg, load_kg, depth_m."""


@dataclass(frozen=True, slots=True)
class UnitConversion:
    """Conversion of numbers from the unit that a heading names to that of their column: value × factor + shift."""

    name: str = field(compare=False)
    factor: float = 1.0
    shift: float = 0.0

    @property
    def changes(self) -> bool:
        """True if a conversion changes numbers, because the units differ."""
        return (self.factor, self.shift) != (1.0, 0.0)

    def convert(self, values: FloatArray) -> FloatArray:
        """Numbers in the unit of the column.

        >>> import numpy as np
        >>> conversion("cm", "depth_mm").convert(np.array([1.5])).tolist()
        [15.0]
        """
        return values * self.factor + self.shift if self.changes else values

    def revert(self, value: float) -> float:
        """Convert a number from the unit of the column to that of the heading.

        >>> conversion("cm", "depth_mm").revert(15.0)
        1.5
        """
        return (value - self.shift) / self.factor if self.changes else value


_CONVERSIONS: Final = {
    **{(unit, name.casefold()): UnitConversion(names[0]) for unit, names in _OWN.items() for name in names},
    **{
        (unit, name.casefold()): UnitConversion(names[0], *size)
        for unit, others in _OTHER.items()
        for names, size in others.items()
        for name in names
    },
}
_KNOWN: Final = frozenset({name for _, name in _CONVERSIONS} | set(_ONLY_NAMED))


def unit_of_column(name: str) -> str:
    """Unit at the end of a column's name, or "" without a unit.

    >>> unit_of_column("snow_density_kg_per_m3"), unit_of_column("load_N"), unit_of_column("site")
    ('kg_per_m3', 'N', '')
    """
    return next((unit for unit in sorted(_OWN, key=len, reverse=True) if name.endswith(f"_{unit}")), "")


def named_unit(heading: str) -> str:
    """Known unit in a heading, in small letters; "" without one.

    >>> [named_unit(each) for each in ("Last [kg]", "Tiefe / mm", "Arm in cm", "load_kg", "Tiefe (roh)", "Moment M")]
    ['kg', 'mm', 'cm', 'kg', '', '']
    """
    plain = " ".join(heading.split())
    if last := _LAST_WORD.fullmatch(plain):
        return (last[1] or "m").casefold()
    match = FORM.fullmatch(plain)
    unit = (match["in"] or match["per"] or match["of"] or "").strip() if match else ""
    return known_unit(unit)


def known_unit(text: str) -> str:
    """Unit in small letters, as in the tables of this module; "" for a text that is not a known unit."""
    unit = " ".join(text.split()).casefold()
    return unit if unit in _KNOWN else ""


def conversion(unit: str, column: str) -> UnitConversion | None:
    """Conversion from a known unit to that of a column; None if the unit is one of another quantity."""
    return _CONVERSIONS.get((unit_of_column(column), unit))


def folded_unit(column: str) -> str:
    """Unit at the end of a column's name, in small letters and as headings write it, such as "kg/m³"."""
    return _OWN[unit_of_column(column)][0].casefold()


def units_for(column: str) -> str:
    """List of the units, as text, in which numbers of a column can be stated, the column's own first.

    >>> units_for("load_N")
    'N, kg, g, kN, daN'
    """
    unit = unit_of_column(column)
    return ", ".join([_OWN[unit][0], *(names[0] for names in _OTHER[unit])])


SYNONYMS: Final[dict[str, tuple[str, ...]]] = {
    column: tuple(phrase.strip() for phrase in phrases.split(","))
    for column, phrases in {
        "experiment": "experiment, versuch, versuchsnummer, versuch nr, messung, messreihe, serie, reihe, test, "
        "nummer, nr, test no, test number, essai, prova",
        "recording": "recording, aufzeichnung, messung, profil, enregistrement, registrazione",
        "file": "file, datei, dateiname, fichier",
        "surface_mm": "surface, oberflaeche, schneeoberflaeche",
        "sample": "sample, probe, proben nr, nummer, nr, dichteprobe, messung, versuch, test, echantillon, campione",
        "test": "test, versuch, messung, nummer, nr, essai, prova",
        "site": "site, ort, messort, standort, stelle, messstelle, platz, hang, piste, feld, lieu, luogo",
        "spot": "spot, punkt, messpunkt, position, place",
        "tool": "tool, werkzeug, stempel, koerper, pruefkoerper, druckkoerper, ski, skistueck, outil, utensile",
        "plate": "plate, platte, blech, klinge, scherplatte, scherblatt, fluegel, plaque, piastra",
        "edge_angle_deg": "edge angle, edging angle, kantwinkel, aufkantwinkel, winkel, neigung, angle, angolo, edge, "
        "angle de carre, angle de prise de carre, angolo di spigolo, angolo di presa di spigolo",
        "load_N": "load, last, kraft, gewicht, masse, mass, normalkraft, belastung, f, force, charge, carico, forza",
        "depth_mm": "depth, tiefe, eindringtiefe, einsinktiefe, eindringung, e, penetration, penetration depth, "
        "profondeur, profondita, enfoncement, affondamento",
        "depth_after_mm": "depth after, tiefe danach, tiefe nachher, nachtiefe",
        "branch": "branch, ast, zweig, be entlastung",
        "lever_arm_mm": "lever arm, lever, hebelarm, hebel, arm, bras de levier, braccio",
        "moment_Nm": "moment, torque, drehmoment, m, couple, momento",
        "turning_angle_deg": "turning angle, drehwinkel, verdrehwinkel, verdrehung",
        "snow_density_kg_per_m3": "snow density, density, dichte, schneedichte, rho, densite, densita",
        "drop_cone_depth_mm": "drop cone depth, drop cone, kegeltiefe, fallkegel, kegel, konustiefe, cone",
        "sample_depth_mm": "sample depth, depth of sample, probentiefe",
        "sample_thickness_mm": "sample thickness, thickness of sample, probendicke, probenhohe",
        "repeat": "repeat, wiederholung, durchgang, repetition, ripetizione",
        "air_temperature_C": "air temperature, lufttemperatur, temperatur luft, temperature de l air, luft, air",
        "snow_temperature_C": "snow temperature, schneetemperatur, temperatur schnee, schnee, snow",
        "snow_type": "snow type, schneeart, kornform, schnee, neige",
        "time": "time, date, zeit, datum, zeitpunkt, uhrzeit, heure, data, ora",
        "status": "status, ungueltig, storniert, abgebrochen",
        "remark": "remark, comment, bemerkung, anmerkung, kommentar, notiz, remarque, nota",
    }.items()
}
"""Synonyms of each column in the form of `letters`, the column's usual name first."""
VAGUE: Final = frozenset({"neigung", "e", "f", "m", "schnee", "luft", "air", "snow", "edge", "arm", "data", "place"})
"""Synonyms that have other meanings, too: they propose a column, but do not state it."""

_UNIT_RANK: Final = 0.25


def columns_by_synonym(form: TableForm, headings: Sequence[str]) -> dict[str, str]:
    """Most likely column of each heading that contains one of its synonyms, by heading; each column occurs once."""
    ranked = sorted(
        (-rank, place, column)
        for place, heading in enumerate(headings)
        for column in form.known
        if (rank := _rank(heading, column))
    )
    columns: dict[int, str] = {}
    for _, place, column in ranked:
        if place not in columns and column not in columns.values():
            columns[place] = column
    return {headings[place]: columns[place] for place in sorted(columns)}


def stated_column(form: TableForm, heading: str) -> str:
    """Column that a heading states: its own name, or a whole synonym of only this column; otherwise "".

    >>> from .table_forms import PENETRATION
    >>> [stated_column(PENETRATION, each) for each in ("Last [kg]", "load_N", "Last oben", "F [N]")]
    ['load_N', 'load_N', '', '']
    """
    if heading in form.known:
        return heading
    words = heading_words(heading)
    columns = [column for column in form.known if words in SYNONYMS.get(column, ())]
    return columns[0] if len(columns) == 1 and words not in VAGUE else ""


def heading_words(heading: str) -> str:
    """Words of a heading without its unit, normalised by `letters`."""
    match = FORM.fullmatch(" ".join(heading.split()))
    words = letters(match["words"] if match else heading)
    unit = letters(named_unit(heading))
    return words.removesuffix(f" {unit}") if unit else words


@lru_cache(maxsize=4096)
def _rank(heading: str, column: str) -> float:
    """Likelihood, 0 to 1.25, that a heading means a column, by its synonyms and unit; 0 if it cannot."""
    unit = named_unit(heading) if unit_of_column(column) else ""
    if unit and conversion(unit, column) is None:
        return 0.0
    match = FORM.fullmatch(heading)
    words = letters(match["words"] if match else heading)
    synonyms = SYNONYMS.get(column, ())
    inside = [phrase for phrase in synonyms if f" {phrase} " in f" {words} "]
    if not inside:
        return 0.0
    unit_rank = _UNIT_RANK if unit else 0.0
    if words in synonyms:
        return 1.0 - 0.001 * synonyms.index(words) + unit_rank  # the first synonym is the column's name
    return (0.8 if any(words.startswith(phrase) for phrase in inside) else 0.7) + unit_rank


def letters(text: str) -> str:
    """Lower-case letters and spaces of a text; ä becomes ae.

    >>> letters("Eindring-Tiefe_e  Prüfkörper")
    'eindring tiefe e pruefkoerper'
    """
    small = text.casefold()
    for umlaut, plain in (("ä", "ae"), ("ö", "oe"), ("ü", "ue")):
        small = unicodedata.normalize("NFC", small).replace(umlaut, plain)
    decomposed = unicodedata.normalize("NFKD", small)
    return " ".join(re.sub(r"[^a-z ]", " ", re.sub(r"[\u0300-\u036f]", "", decomposed)).split())
