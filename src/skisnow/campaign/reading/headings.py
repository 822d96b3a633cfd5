"""Headings that a campaign's tables have in place of the columns' names: ``[columns]`` in campaign.toml."""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from .heading_units import FORM, conversion, every_unit, known_unit, named_unit, unit_of_column
from .table_forms import CORRECTIONS, TABLES

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from .table_forms import TableForm
    from .toml_values import TomlValues


KEY: Final = "columns"
UNITS_KEY: Final = "units"
FORMS: Final = {form.file.removesuffix(".csv"): form for form in (*TABLES, CORRECTIONS)}
"""Tables by the names that ``[columns.NAME]`` and sheets of a workbook have."""


@dataclass(frozen=True, slots=True)
class Headings:
    """Names of columns by the headings that stand for them, plain ones.

    Attributes
    ----------
    everywhere
        In every table that may have such a column.
    of_table
        In one table, by its file; before what holds everywhere.
    units, units_of_table
        Units of the numbers below headings, in the same way.
    """

    everywhere: Mapping[str, str] = field(default_factory=dict)
    of_table: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    units_of_table: Mapping[str, Mapping[str, str]] = field(default_factory=dict)

    def name(self, form: TableForm, heading: str) -> str:
        """The column that a heading of a table stands for; the heading where it stands for itself."""
        plain = plain_heading(heading)
        own = self.of_table.get(form.file, {}).get(plain)
        if own is not None:
            return own
        name = self.everywhere.get(plain)
        return name if name is not None and name in form.known else heading

    def unit(self, form: TableForm, heading: str) -> str:
        """The unit that campaign.toml states for a heading of a table; empty if it states none."""
        plain = plain_heading(heading)
        return self.units_of_table.get(form.file, {}).get(plain) or self.units.get(plain, "")

    def without_heading(self, headings: Mapping[str, Sequence[str]]) -> Iterator[str]:
        """Paths of stated units whose heading no table has; the headings of each table are given by its file."""
        there = {file: {plain_heading(each) for each in names} for file, names in headings.items()}
        everywhere = set().union(*there.values())
        yield from (f"{UNITS_KEY}.{name}" for name in self.units if name not in everywhere)
        for file, units in self.units_of_table.items():
            table = file.removesuffix(".csv")
            yield from (f"{UNITS_KEY}.{table}.{name}" for name in units if name not in there.get(file, set()))


def plain_heading(heading: str) -> str:
    r"""A heading without what nobody sees: line breaks, several spaces, capitals, two ways to write an umlaut.

    >>> plain_heading(" Kantwinkel\n[°] ")
    'kantwinkel [°]'
    """
    return " ".join(unicodedata.normalize("NFC", heading).split()).casefold()


def headings_of(top: TomlValues) -> Headings:
    """Read ``[columns]`` and ``[units]``; each for all tables, or for one under ``[columns.penetration]``."""
    units, units_of_table = _units_of(top.table(UNITS_KEY))
    section = top.table(KEY)
    everywhere: dict[str, str] = {}
    of_table: dict[str, dict[str, str]] = {}
    every_name = tuple(dict.fromkeys(name for form in FORMS.values() for name in form.known))
    for heading, value in section.values.items():
        if heading in FORMS and isinstance(value, Mapping):
            form = FORMS[heading]
            of_table[form.file] = _names(section.table(heading), form.known)
        else:
            everywhere |= _name(section, heading, every_name)
    return Headings(everywhere, of_table, units, units_of_table)


def _units_of(section: TomlValues) -> tuple[dict[str, str], dict[str, dict[str, str]]]:
    """Units of all tables and of single ones: ``"Last" = "kg"``."""
    everywhere: dict[str, str] = {}
    of_table: dict[str, dict[str, str]] = {}
    for heading, value in section.values.items():
        if heading in FORMS and isinstance(value, Mapping):
            table = section.table(heading)
            of_table[FORMS[heading].file] = {
                plain_heading(name): unit for name in table.values if (unit := _unit(table, name))
            }
        elif unit := _unit(section, heading):
            everywhere[plain_heading(heading)] = unit
    return everywhere, of_table


def _unit(section: TomlValues, heading: str) -> str:
    value = section.values[heading]
    unit = known_unit(value) if isinstance(value, str) else ""
    if not unit:
        section.refuse(heading, f"one of the units {every_unit()}", "Write the unit in quotes.")
    return unit


def _names(section: TomlValues, known: tuple[str, ...]) -> dict[str, str]:
    found: dict[str, str] = {}
    for heading in section.values:
        found |= _name(section, heading, known)
    return found


def _name(section: TomlValues, heading: str, known: tuple[str, ...]) -> dict[str, str]:
    """The column that a heading stands for, or nothing where that is refused."""
    value = section.values[heading]
    if isinstance(value, str) and value.strip() in known:
        return {plain_heading(heading): value.strip()}
    near = difflib.get_close_matches(str(value).lower(), known, n=1)
    meant = f"Is {near[0]} meant? " if near else ""
    action = f"{meant}Write the heading, an equals sign and the column's name, both in quotes."
    section.refuse(heading, f"one of the columns {', '.join(known)}", action)
    return {}


WORDS: Final = {
    "experiment": "experiment versuch versuchsnummer messung messreihe serie reihe test nummer nr essai prova",
    "recording": "recording aufzeichnung messung profil enregistrement registrazione",
    "file": "file datei dateiname fichier",
    "surface_mm": "surface oberflaeche schneeoberflaeche",
    "sample": "sample probe proben nr nummer nr dichteprobe messung versuch test echantillon campione",
    "test": "test versuch messung nummer nr essai prova",
    "site": "site ort messort standort stelle messstelle platz hang piste feld lieu luogo",
    "spot": "spot punkt messpunkt position place",
    "tool": "tool werkzeug stempel koerper pruefkoerper druckkoerper ski skistueck outil utensile",
    "plate": "plate platte blech klinge scherplatte fluegel plaque piastra",
    "edge_angle_deg": "edge angle kantwinkel aufkantwinkel winkel neigung angle angolo",
    "load_N": "load last kraft gewicht normalkraft belastung f force charge carico forza",
    "depth_mm": "depth tiefe eindringtiefe einsinktiefe eindringung e profondeur profondita",
    "depth_after_mm": "depth after tiefe danach tiefe nachher nachtiefe",
    "branch": "branch ast zweig be entlastung",
    "lever_arm_mm": "lever arm lever hebelarm hebel bras de levier braccio",
    "moment_Nm": "moment torque drehmoment m couple momento",
    "turning_angle_deg": "turning angle drehwinkel verdrehwinkel verdrehung",
    "snow_density_kg_per_m3": "snow density density dichte schneedichte rho densite densita",
    "drop_cone_depth_mm": "drop cone depth drop cone kegeltiefe fallkegel kegel konustiefe cone",
    "repeat": "repeat wiederholung durchgang repetition ripetizione",
    "air_temperature_C": "air temperature lufttemperatur temperatur luft temperature de l air",
    "snow_temperature_C": "snow temperature schneetemperatur temperatur schnee",
    "snow_type": "snow type schneeart kornform schnee neige",
    "time": "time date zeit datum zeitpunkt uhrzeit heure data ora",
    "status": "status ungueltig storniert abgebrochen",
    "remark": "remark comment bemerkung anmerkung kommentar notiz remarque nota",
}  # fmt: skip
"""Words for a column, as `_letters` writes them; phrases are found by their words."""

_LIKELY: Final = 0.62
_UNIT_COUNTS: Final = 0.25


def proposed(form: TableForm, headings: Sequence[str]) -> dict[str, str]:
    """Columns by the headings that may stand for them, each once, in the order of the headings."""
    scored = sorted(
        (
            (-_likeness(heading, column), place, column)
            for place, heading in enumerate(headings)
            for column in form.known
            if heading
        ),
    )
    found: dict[int, str] = {}
    for likeness, place, column in scored:
        if -likeness >= _LIKELY and place not in found and column not in found.values():
            found[place] = column
    return {headings[place]: found[place] for place in sorted(found)}


def _likeness(heading: str, column: str) -> float:
    """From 0 up; 0 if the heading names a unit that is not converted to the column's."""
    unit = named_unit(heading) if unit_of_column(column) else ""
    if unit and conversion(unit, column) is None:
        return 0.0
    found = FORM.fullmatch(heading)
    words = _letters(found["words"] if found else heading)
    return _of_words(words, WORDS.get(column, "")) + (_UNIT_COUNTS if unit else 0.0)


def _of_words(words: str, known: str) -> float:
    vocabulary = [*known.split(), known]
    if not words:
        return 0.0
    if words in vocabulary:
        return 1.0 - 0.001 * vocabulary.index(words)  # the first word of a column is its own
    parts = words.split()
    if any(part in vocabulary for part in parts):
        return 0.8 if parts[0] in vocabulary else 0.7
    if any(len(each) > 3 and (words.endswith(each) or words.startswith(each)) for each in vocabulary):
        return 0.7
    return 0.8 * _nearest(words, vocabulary)


def _nearest(words: str, vocabulary: Iterable[str]) -> float:
    return max(
        (difflib.SequenceMatcher(None, words, each).ratio() for each in vocabulary if len(each) > 3), default=0.0
    )


def _letters(text: str) -> str:
    """Small letters and spaces alone; ä is ae.

    >>> _letters("Eindring-Tiefe_e  Prüfkörper")
    'eindring tiefe e pruefkoerper'
    """
    small = text.casefold()
    for umlaut, letters in (("ä", "ae"), ("ö", "oe"), ("ü", "ue")):
        small = unicodedata.normalize("NFC", small).replace(umlaut, letters)
    plain = unicodedata.normalize("NFKD", small)
    return " ".join(re.sub(r"[^a-z ]", " ", re.sub(r"[\u0300-\u036f]", "", plain)).split())
