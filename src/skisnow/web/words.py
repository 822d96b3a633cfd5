"""Words of pages in the language of the page: labels with units, results, local times, and typed numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final
from weakref import WeakKeyDictionary

from nicegui import Client, ui
from starlette.requests import Request

from .._support.errors import ParameterError, SkisnowError
from .._support.messages import (
    ENGLISH,
    Message,
    count_message,
    decimal_sign,
    languages,
    translated,
    use_language_of_pages,
)
from ..report.formatting import interval, significant

LABELS: Final = {
    "experiment": Message("Name of the test"),
    "sample": Message("Name of the sample"),
    "test": Message("Name of the test"),
    "repeat": Message("Repeat"),
    "site": Message("Site"),
    "spot": Message("Measurement point"),
    "tool": Message("Tool"),
    "plate": Message("Plate"),
    "edge_angle_deg": Message("Edge angle (°)"),
    "load_N": Message("Load (N)"),
    "depth_mm": Message("Depth (mm)"),
    "depth_after_mm": Message("Depth after waiting (mm)"),
    "branch": Message("Branch (loading or unloading)"),
    "lever_arm_mm": Message("Lever arm (mm)"),
    "moment_Nm": Message("Moment (N m)"),
    "turning_angle_deg": Message("Turning angle (°)"),
    "sample_depth_mm": Message("Depth of the sample's middle (mm)"),
    "sample_thickness_mm": Message("Thickness of the sample (mm)"),
    "snow_density_kg_per_m3": Message("Density (kg/m³)"),
    "drop_cone_depth_mm": Message("Drop-cone depth (mm)"),
    "remark": Message("Remark"),
    "time": Message("Time"),
}
TABLES: Final = {
    "penetration.csv": Message("Penetration"),
    "shear.csv": Message("Shear"),
    "density.csv": Message("Density"),
    "drop_cone.csv": Message("Drop cone"),
}

_LABEL_OF_NAME: Final = {name: words for name, words in (LABELS | TABLES).items() if "_" in name or "." in name}
"""Names of columns and tables that are replaced by labels in messages."""
_NAMES: Final = re.compile(
    "|".join(rf"(?<![\w.]){re.escape(name)}(?![\w.])" for name in sorted(_LABEL_OF_NAME, key=len, reverse=True))
)


def label(column: str, *, unit: str = "") -> str:
    """Label of a column on a page; `unit`: unit of its cells (default: that of the column's name).

    >>> label("depth_mm"), label("depth_mm", unit="cm")
    ('Depth (mm)', 'Depth (cm)')
    """
    words = LABELS.get(column, column)
    return re.sub(r" \([^)]*\)$", f" ({unit})", str(words)) if unit else words


def in_words(message: str) -> str:
    """Message with the labels of the pages instead of names of columns and tables.

    >>> in_words("the column depth_mm has no number")
    'the column Depth (mm) has no number'
    """
    return reword(message, lambda text: _NAMES.sub(lambda key: str(_LABEL_OF_NAME[key[0]]), text))


def reword(message: str, change: Callable[[str], str]) -> str:
    """Copy of a message with a function applied to the texts of its fields; to all of it if it is a plain text.

    >>> reword(Message("{key} is missing", key="depth_mm"), str.upper)
    'DEPTH_MM is missing'
    """
    if not isinstance(message, Message):
        return change(message)
    fields = {name: _change_text(value, change) for name, value in message.fields.items()}
    if message.plural is not None:
        return count_message(message.template, message.plural, **{**fields, "count": message.fields["count"]})
    return Message(message.template, **fields)


def replaced(message: str, words: Mapping[str, str]) -> str:
    """Copy of a message in which words are replaced, one after the other, where `reword` changes text.

    >>> replaced("mass_kg is 3", {"mass_kg": "Mass (kg)"})
    'Mass (kg) is 3'
    """

    def change(text: str) -> str:
        for old, new in words.items():
            text = text.replace(old, new)
        return text

    return reword(message, change)


def _change_text(value: object, change: Callable[[str], str]) -> object:
    """A field with `change` applied to its texts, also in lists and messages; numbers stay unchanged."""
    if isinstance(value, SkisnowError):
        value = value.message
    if isinstance(value, list):
        return [_change_text(item, change) for item in value]
    return reword(value if isinstance(value, str) else str(value), change) if isinstance(value, str | Path) else value


def result_words(row: dict[str, Any]) -> str:
    """Text with H_V and k_u/H_V, or S_f and u_y, and intervals, from a row of ``experiments`` in results.json."""
    if "H_V_N_per_mm3" in row:
        words = f"H_V = {estimate_words(row['H_V_N_per_mm3'], row['H_V_interval_N_per_mm3'], 'N/mm³')}"
        if not row["n_unloading"]:
            return words
        return f"{words}; k_u/H_V = {estimate_words(row['unloading_ratio'], row['unloading_ratio_interval'])}"
    words = f"S_f = {estimate_words(row['S_f_N_per_mm2'], row['S_f_interval_N_per_mm2'], 'N/mm²')}"
    if row["shear_displacement_mm"] is None:
        return words
    return f"{words}; u_y = {estimate_words(row['shear_displacement_mm'], row['shear_displacement_interval_mm'], 'mm')}"


def estimate_words(value: float | None, pair: list[float] | None, unit: str = "") -> str:
    """Text of a value with its unit and 95 % interval; a note if one of them is None."""
    if value is None:
        return Message("not defined")
    words = f"{significant(value)} {unit}".strip()
    if pair is None:
        return Message("{value}, interval not known", value=words)
    return Message("{value}, {ends}", value=words, ends=interval(pair))


def plain_number(text: str) -> str:
    """Text of a typed number with a decimal point and a hyphen as its sign, as it is stored.

    >>> plain_number(" −2,5")
    '-2.5'
    """
    return text.strip().replace(",", ".").replace("−", "-")


def typed_number(what: str, text: str) -> float:
    """Finite number in a text with a decimal point or comma; otherwise a ParameterError that begins with `what`."""
    try:
        value = float(plain_number(text))
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ParameterError("{field}: {value!r} is not a number. Correct it").tag(
            "not_a_number", field=what, value=text.strip()
        )
    return value


_STORED_NUMBER: Final = re.compile(r"-?\d+\.?\d*(e[+-]?\d+)?|\.\d+")
COOKIE: Final = "skisnow-language"
_OF_PAGES: Final = WeakKeyDictionary[Client, str]()


def language_asked(chosen: str | None, accepted: str) -> str:
    """Code of the language for a request: the chosen one, else the first accepted one, that skisnow has; else "en".

    accepted: header Accept-Language of the browser.

    >>> language_asked(None, "fr-CH, de-AT;q=0.9, en;q=0.5"), language_asked("en", "de")
    ('de', 'en')
    """
    preferred = [part.split(";")[0].strip().split("-")[0].lower() for part in accepted.split(",")]
    return next((code for code in (chosen or "", *preferred) if code in languages()), ENGLISH)


def language_of(client: Client | None = None) -> str:
    """Code of a page's language (default: of the current page)."""
    try:
        client = client or ui.context.client
        if client not in _OF_PAGES:
            _OF_PAGES[client] = language_of_request(client.request)
    except RuntimeError:  # outside of a page
        return ENGLISH
    return _OF_PAGES[client]


use_language_of_pages(language_of)


def language_of_request(request: Request) -> str:
    """Language code of a request: the chosen one (cookie), else the first accepted one that is known, else "en"."""
    return language_asked(request.cookies.get(COOKIE), request.headers.get("accept-language", ""))


def said(text: str, client: Client | None = None) -> str:
    """Text of a message in the language of the page; other text is returned unchanged."""
    return text.text(language_of(client)) if isinstance(text, Message) else text


def number_text(number: str, client: Client | None = None) -> str:
    """Text of a stored number with the signs of the language of the page; other text is unchanged.

    >>> number_text("-3.61"), number_text("2026-02-14")
    ('−3.61', '2026-02-14')
    """
    if not _STORED_NUMBER.fullmatch(number):
        return number
    return number.replace(".", decimal_sign(language_of(client))).replace("-", "−")


def minute_words(at: datetime | str) -> str:
    """Local day and time of the server in the format of the page's language, of an ISO 8601 text or a time in UTC."""
    time = datetime.fromisoformat(at) if isinstance(at, str) else at
    return translated((time if time.tzinfo else time.replace(tzinfo=UTC)).astimezone(), language_of())
