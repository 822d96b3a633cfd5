"""Which column a heading of a table may stand for: words that people in the Alps write, symbols and units.

It only proposes. What is proposed counts when it stands in campaign.toml.
"""

from __future__ import annotations

import difflib
import re
import unicodedata
from typing import TYPE_CHECKING, Final

from .heading_units import FORM, conversion, named_unit, unit_of_column

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from .table_forms import TableForm

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
