"""Report of a campaign in a folder: report.html, figures, tables and results.json."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from datetime import UTC
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

from markupsafe import Markup

from ..._support.environment import paused_collector
from ..._support.errors import ParameterError, require_language
from ..._support.messages import ENGLISH, Message, current_language, in_language, translated
from ..._support.staging import prepare_folder, staged, write_file
from ...campaign import Campaign
from ...estimation import Analysis
from ...estimation.results import results_pieces
from ..figures.drawing import Drawing, LeftOut, Picture, Progress, picture_files, silent, write_pictures
from ..figures.style import SiteStyle, site_styles
from ..formatting import significant
from ..sheet import bibtex, render_template
from ..table import Table, table_csv, table_html
from .data import ReportData
from .key_results import headline, key_results
from .penetration_figures import force_depth, hardness_density, hardness_mean_force, seating_offsets, unloading_ratios
from .shear_figures import machining, shear_force_depth, stress_angle, stress_density, stress_hardness
from .site_figures import residuals, sites, snow_profiles
from .tables import campaign_tables
from .verdicts import caveats, procedure_comparison, readings_used, seating_findings, unloading_finding, verdicts

RESULTS: Final = "results.json"
SECTIONS: Final = {
    "key-results": Message("Key results"),
    "caveats": Message("Warnings and missing statements"),
    "law": Message("The law of the penetration force"),
    "seating": Message("Seating: offsets of the depth zero"),
    "unloading": Message("Unloading: the permanent depth of a groove"),
    "displacement": Message("Shear displacement: how far until the full shear strength"),
    "relations": Message("Relations between snow parameters"),
    "sites": Message("Sites compared"),
    "published": Message("Compared with published values"),
    "marks": Message("Quality flags of the screening"),
    "experiments": Message("All experiments"),
    "methods": Message("Methods"),
    "provenance": Message("Provenance"),
}
_ONLY_WITH_PENETRATION: Final = ("law", "seating", "unloading")
_ONLY_WITH_TESTS: Final = ("sites", "published", "marks", "experiments")


def write_report(
    analysis: Analysis, out: str | Path, *, language: str = ENGLISH, progress: Progress | None = None
) -> Path:
    """Write report.html, figures/, tables/ and results.json of an analysed campaign.

    The files are written to a temporary folder inside ``out`` and moved into place together. An error or an
    interruption leaves ``out`` unchanged.

    Parameters
    ----------
    analysis
        Result of `skisnow.analyse`.
    out
        Output folder, created if necessary. Tables and figures of an earlier report are removed if this campaign has
        no data for them; other files stay.
    language
        Language of the page and the figures (en, de). Tables and results.json are the same in every language.
    progress
        Callback for progress messages.

    Returns
    -------
    Path
        Path of report.html.

    Raises
    ------
    ParameterError
        `analysis` is not an Analysis, or the language is unknown.
    OutputError
        A file cannot be written. results.json is moved last: a folder with it is complete.

    See Also
    --------
    skisnow.analyse : the analysis.
    skisnow.results_dict : its numbers.

    References
    ----------
    The page docs/files/results.md.
    """
    if not isinstance(analysis, Analysis):
        raise ParameterError(
            "a report is written of an analysis, into a folder: write_report(analyse(campaign), folder); given is a "
            "{kind}"
        ).tag("wrong_type", kind=type(analysis).__name__)
    require_language(language)
    report = progress or silent
    out = Path(out)
    for message in prepare_folder(out):
        report(message)
    with paused_collector(), staged(out, last=RESULTS) as stage:
        stage.stale += _write(ReportData(analysis), stage.path, language, report)
    return out / "report.html"


def _write(data: ReportData, stage: Path, language: str, report: Progress) -> list[str]:
    """Write all files to the stage; returns the files of an earlier report that must be removed."""
    report("tables of the report")
    all_tables = campaign_tables(data)
    tables = {name: table for name, table in all_tables.items() if table.rows}
    for table in tables.values():
        report(f"table {table.name}")
        write_file(stage / "tables" / f"{table.file_stem}.csv", table_csv(table))
    with in_language(language):
        pictures, missing = _write_figures(data, stage / "figures", report)
        report("report.html")
        write_file(stage / "report.html", page(data, tables, pictures, missing))
    report("results.json")
    write_file(stage / RESULTS, results_pieces(data.results))
    stems = {replace(table, synthetic=mark).file_stem for table in all_tables.values() for mark in (False, True)}
    stems -= {table.file_stem for table in tables.values()}
    return [f"tables/{stem}.csv" for stem in sorted(stems)] + picture_files(left_out.name for left_out in missing)


def page(data: ReportData, tables: Mapping[str, Table], pictures: Sequence[Picture], missing: Sequence[LeftOut]) -> str:
    """HTML of the report in the current language, with styles, figures and tables inside."""
    return render_template(
        "report.html",
        **_frame(data),
        key_results=key_results(data),
        caveats=caveats(data),
        readings_used=readings_used(data),
        procedures_compared=procedure_comparison(data),
        seating_found=list(seating_findings(data)),
        unloading_found=[unloading_finding(data)],
        tables=defaultdict(Markup, tables_html(tables)),
        pictures=pictures,
        missing=missing,
        figure_numbers={picture.name: number for number, picture in enumerate(pictures, start=1)},
        matplotlib_version=version("matplotlib"),
        bibtex=bibtex(data.results["campaign"] | {"files": data.campaign.file_hashes}),
    )


def tables_html(tables: Mapping[str, Table]) -> dict[str, Markup]:
    """HTML of the tables by name, numbered in the order of the report."""
    in_html = [table for table in tables.values() if table.rows_in_html]
    return {table.name: table_html(table, number=i) for i, table in enumerate(in_html, start=1)}


def _frame(data: ReportData) -> dict[str, Any]:
    """Values for the template of the page by name, except sentences, tables and figures."""
    results, has_penetration = data.results, bool(data.penetration)
    ids = [name for name in SECTIONS if has_penetration or name not in _ONLY_WITH_PENETRATION]
    if not data.has_tests:
        left_out = (*_ONLY_WITH_TESTS, *(() if data.campaign.snow_micro_pen else ("relations",)))
        ids = [name for name in ids if name not in left_out]
    if has_penetration and not data.unloaded:
        ids.remove("unloading")
    if not data.results["shear"]["displacement"]:
        ids.remove("displacement")
    return {
        "campaign": results["campaign"],
        "provenance": results["provenance"],
        "geometry": results["provenance"]["options"]["geometry"],
        "shapes": {type(tool).__name__ for tool in data.campaign.tools.values()},
        "stated": _stated_uncertainties(results["campaign"]),
        "synthetic": data.synthetic,
        "dates": data.dates,
        "analysed": translated(data.analysis.time.astimezone(UTC), current_language()),
        "headline": headline(data),
        "verdicts": verdicts(results),
        "counts": data.counts,
        "has_penetration": has_penetration,
        "has_tests": data.has_tests,
        "has_unloading": bool(data.unloaded),
        "has_displacement": bool(results["shear"]["displacement"]),
        "selected": results["penetration"]["selected"],
        "not_selected": next(iter(results["penetration"]["warnings"]), ""),
        "sections": [(name, SECTIONS[name]) for name in ids],
        "titles": SECTIONS,
        "numbers": {name: number for number, name in enumerate(ids, start=1)},
    }


def _stated_uncertainties(campaign: dict[str, Any]) -> dict[str, str]:
    """Texts of the gauge's resolution and stated uncertainties; "not stated" with what follows."""
    not_stated = Message("not stated, counted as 0")
    fields = {
        "gauge": ("gauge_resolution_mm", "mm", Message("not stated, so that no depth uncertainty is counted")),
        "load": ("load_uncertainty_N", "N", not_stated),
        "moment": ("moment_uncertainty_Nm", "N m", not_stated),
        "lever_arm": ("lever_arm_uncertainty_mm", "mm", not_stated),
    }
    return {
        name: words if campaign[key] is None else f"{significant(campaign[key])} {unit}"
        for name, (key, unit, words) in fields.items()
    }


DRAWERS: Final = (
    sites,
    force_depth,
    residuals,
    seating_offsets,
    unloading_ratios,
    hardness_density,
    shear_force_depth,
    stress_angle,
    machining,
    stress_density,
    stress_hardness,
)
"""Functions that draw one figure each, in the order of the report."""


def drawers_of(campaign: Campaign) -> tuple[Callable[[ReportData, Sequence[SiteStyle]], Drawing | LeftOut], ...]:
    """Functions of the figures that a campaign with its tables can have."""
    has_profile = campaign.density is not None and bool(campaign.density.in_profile.any())
    recorded = (snow_profiles, hardness_mean_force) if campaign.snow_micro_pen else ()
    of_plates = DRAWERS if campaign.penetration or campaign.shear else ()
    return of_plates + (recorded or (snow_profiles,) * has_profile)


def _write_figures(data: ReportData, folder: Path, progress: Progress) -> tuple[list[Picture], list[LeftOut]]:
    """Write the figures for which the campaign has data; returns them, and the reasons for the missing ones."""
    missing: list[LeftOut] = []

    def drawings() -> Iterator[Drawing]:
        styles = site_styles(data)
        for draw in drawers_of(data.campaign):
            drawing = draw(data, styles)
            if isinstance(drawing, Drawing):
                yield drawing
            else:
                missing.append(drawing)

    return write_pictures(drawings(), folder, progress=progress), missing
