"""The report as one HTML file that needs nothing else: style, figures and tables are inside it."""

from __future__ import annotations

from importlib.metadata import version
from importlib.resources import files
from typing import TYPE_CHECKING, Any, Final

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from ..language import ENGLISH
from .dates import days_words, moment_words
from .number_formatting import counted, significant, whole
from .sentences.caveats import caveats
from .sentences.key_results import headline, key_results
from .sentences.penetration import procedures_compared, readings_used, seating_found, unloading_found
from .sentences.regressions import regression_sentences
from .table_html import table_html
from .translated import translated_html

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from .figures import LeftOut, Picture
    from .report_data import ReportData
    from .table import Table

SECTIONS: Final = {
    "key-results": "Key results",
    "caveats": "Warnings, and what was not stated",
    "law": "The law of the penetration force",
    "seating": "Seating: offsets of the depth zero",
    "unloading": "Unloading: the permanent depth of a groove",
    "displacement": "Shear displacement: how far until the full shear strength",
    "relations": "Relations between snow parameters",
    "sites": "Sites compared",
    "published": "Compared with published values",
    "marks": "Quality flags of the screening",
    "experiments": "All experiments",
    "methods": "Methods",
    "provenance": "Provenance",
}
_ONLY_WITH_PENETRATION: Final = ("law", "seating", "unloading")


def page(
    data: ReportData,
    tables: Mapping[str, Table],
    pictures: Sequence[Picture],
    missing: Sequence[LeftOut],
    *,
    language: str = ENGLISH,
) -> str:
    """The HTML of the whole report."""
    environment = Environment(
        loader=PackageLoader("skisnow.report"), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    english = environment.get_template("report.html").render(
        **_frame(data),
        **_words(data),
        tables=_Tables(tables),
        pictures=pictures,
        missing=missing,
        figure_numbers={picture.name: number for number, picture in enumerate(pictures, start=1)},
        matplotlib_version=version("matplotlib"),
    )
    return translated_html(english, language, names=data.names)


def tables_html(tables: Mapping[str, Table]) -> dict[str, Markup]:
    """Tables by name as HTML, numbered as in the report."""
    in_html = [table for table in tables.values() if table.rows_in_html]
    return {table.name: table_html(table, number=i) for i, table in enumerate(in_html, start=1)}


class _Tables:
    """Tables by name as HTML; nothing for one without rows."""

    def __init__(self, tables: Mapping[str, Table]) -> None:
        self._html = tables_html(tables)

    def __getitem__(self, name: str) -> Markup:
        return self._html.get(name, Markup(""))


def _frame(data: ReportData) -> dict[str, Any]:
    results, has_penetration = data.results, bool(data.penetration)
    ids = [name for name in SECTIONS if has_penetration or name not in _ONLY_WITH_PENETRATION]
    if has_penetration and not data.unloaded:
        ids.remove("unloading")
    if not data.results["shear"]["displacement"]:
        ids.remove("displacement")
    return {
        "campaign": results["campaign"],
        "provenance": results["provenance"],
        "geometry": results["provenance"]["options"]["geometry"],
        "shapes": {type(tool).__name__ for tool in data.campaign.tools.values()},
        "stated": _stated(results["campaign"]),
        "synthetic": data.synthetic,
        "dates": None if data.dates is None else days_words(*data.dates),
        "analysed": moment_words(results["provenance"]["time"]),
        "headline": headline(data),
        "counts": _counts(data),
        "has_penetration": has_penetration,
        "has_unloading": bool(data.unloaded),
        "has_displacement": bool(results["shear"]["displacement"]),
        "selected": results["penetration"]["selected"],
        "not_selected": next(iter(results["penetration"]["warnings"]), ""),
        "sections": [(name, SECTIONS[name]) for name in ids],
        "titles": SECTIONS,
        "numbers": {name: number for number, name in enumerate(ids, start=1)},
        "css": Markup(files("skisnow.report").joinpath("templates", "report.css").read_text(encoding="utf-8")),
    }


def _counts(data: ReportData) -> str:
    return (
        f"{counted(len(data.penetration), 'penetration experiment')} ({whole(len(data.hardness))} used), "
        f"{counted(len(data.shear), 'shear experiment')} ({whole(len(data.stress))} used), "
        f"{counted(len(data.sites), 'site')}"
    )


def _stated(campaign: dict[str, Any]) -> dict[str, str]:
    def said(key: str, unit: str) -> str:
        value = campaign[key]
        return "not stated, counted as 0" if value is None else f"{significant(value)} {unit}"

    gauge = campaign["gauge_resolution_mm"]
    return {
        "gauge": "not stated, so that no depth uncertainty is counted" if gauge is None else f"{significant(gauge)} mm",
        "load": said("load_uncertainty_N", "N"),
        "moment": said("moment_uncertainty_Nm", "N m"),
        "lever_arm": said("lever_arm_uncertainty_mm", "mm"),
    }


def _words(data: ReportData) -> dict[str, Any]:
    return {
        "key_results": key_results(data),
        "caveats": caveats(data),
        "readings_used": readings_used(data),
        "procedures_compared": procedures_compared(data),
        "seating_found": seating_found(data),
        "unloading_found": unloading_found(data),
        "regression_sentences": regression_sentences(data),
    }
