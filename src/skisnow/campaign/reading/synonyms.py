"""Synonyms of the columns in headings, shared by the reader's proposals and the import of workbooks."""

from __future__ import annotations

import re
import unicodedata
from typing import TYPE_CHECKING, Final

from .headings import FORM, conversion, named_unit, unit_of_column

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .table_forms import TableForm

SYNONYMS: Final[dict[str, tuple[str, ...]]] = {
    column: tuple(phrase.strip() for phrase in phrases.split(","))
    for column, phrases in {
        "experiment": "experiment, versuch, versuchsnummer, versuch nr, messung, messreihe, serie, reihe, test, "
        "nummer, nr, essai, prova",
        "recording": "recording, aufzeichnung, messung, profil, enregistrement, registrazione",
        "file": "file, datei, dateiname, fichier",
        "surface_mm": "surface, oberflaeche, schneeoberflaeche",
        "sample": "sample, probe, proben nr, nummer, nr, dichteprobe, messung, versuch, test, echantillon, campione",
        "test": "test, versuch, messung, nummer, nr, essai, prova",
        "site": "site, ort, messort, standort, stelle, messstelle, platz, hang, piste, feld, lieu, luogo",
        "spot": "spot, punkt, messpunkt, position, place",
        "tool": "tool, werkzeug, stempel, koerper, pruefkoerper, druckkoerper, ski, skistueck, outil, utensile",
        "plate": "plate, platte, blech, klinge, scherplatte, scherblatt, fluegel, plaque, piastra",
        "edge_angle_deg": "edge angle, kantwinkel, aufkantwinkel, winkel, neigung, angle, angolo, edge",
        "load_N": "load, last, kraft, gewicht, normalkraft, belastung, f, force, charge, carico, forza",
        "depth_mm": "depth, tiefe, eindringtiefe, einsinktiefe, eindringung, e, penetration depth, profondeur, "
        "profondita",
        "depth_after_mm": "depth after, tiefe danach, tiefe nachher, nachtiefe",
        "branch": "branch, ast, zweig, be entlastung",
        "lever_arm_mm": "lever arm, lever, hebelarm, hebel, arm, bras de levier, braccio",
        "moment_Nm": "moment, torque, drehmoment, m, couple, momento",
        "turning_angle_deg": "turning angle, drehwinkel, verdrehwinkel, verdrehung",
        "snow_density_kg_per_m3": "snow density, density, dichte, schneedichte, rho, densite, densita",
        "drop_cone_depth_mm": "drop cone depth, drop cone, kegeltiefe, fallkegel, kegel, konustiefe, cone",
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
    """Columns by the headings with one of their synonyms, each column once, in the order of the headings."""
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
    """Words of a heading without its unit, in the form of `letters`."""
    match = FORM.fullmatch(" ".join(heading.split()))
    words = letters(match["words"] if match else heading)
    unit = letters(named_unit(heading))
    return words.removesuffix(f" {unit}") if unit else words


def _rank(heading: str, column: str) -> float:
    """Rank of a column for a heading: 0 without a synonym, or if the heading names a unit of another quantity."""
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
