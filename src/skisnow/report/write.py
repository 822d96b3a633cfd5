"""Writing a report: every table and figure as files, the page, and results.json last."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ..estimate.results import results_json
from ..files import write_file
from ..memory import paused_collector
from .figures import figures_of
from .material import Material
from .page import page
from .table_csv import table_csv
from .table_latex import table_latex
from .tables import tables_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from pathlib import Path

    from ..field.records import Campaign
    from .figures import Picture
    from .table import Table


def write_report(
    campaign: Campaign, results: dict[str, Any], out: Path, *, progress: Callable[[str], None] | None = None
) -> Path:
    """Write report.html, figures/, tables/ and results.json of an analysed campaign.

    Parameters
    ----------
    campaign
        The campaign that was analysed.
    results
        What `skisnow.estimate.results_dict` gave for it.
    out
        The folder; made where it is missing. Other files in it stay. Of an earlier report's tables and figures those
        that this campaign has no data for are removed, so that the folder tells of one campaign.
    progress
        Called with a line of text now and then.

    Returns
    -------
    Path
        Of report.html.

    Raises
    ------
    OutputError
        A file cannot be written. results.json, written last, says by its presence beside the others that all is there.
    """
    with paused_collector():
        return _write(Material(campaign, results), out, progress)


def _write(material: Material, out: Path, progress: Callable[[str], None] | None) -> Path:
    say = progress or _silent
    say("tables of the report")
    every_table = tables_of(material)
    tables = {name: table for name, table in every_table.items() if table.rows}
    for table in tables.values():
        say(f"table {table.name}")
        _write_table(table, out / "tables")
    pictures, missing = figures_of(material, progress=progress)
    for picture in pictures:
        _write_picture(picture, out / "figures")
    _remove_stale(out / "tables", _other_stems(every_table.values()), (".csv", ".tex"))
    _remove_stale(out / "figures", (left_out.name for left_out in missing), (".svg", ".png"))
    say("report.html")
    report = out / "report.html"
    write_file(report, page(material, tables, pictures, missing))
    say("results.json")
    write_file(out / "results.json", results_json(material.results))
    return report


def _silent(_text: str) -> None:
    return


def _write_table(table: Table, folder: Path) -> None:
    write_file(folder / f"{table.file_stem}.csv", table_csv(table))
    write_file(folder / f"{table.file_stem}.tex", table_latex(table))


def _write_picture(picture: Picture, folder: Path) -> None:
    write_file(folder / f"{picture.name}.svg", picture.svg)
    write_file(folder / f"{picture.name}.png", picture.png)


def _other_stems(tables: Iterable[Table]) -> Iterator[str]:
    """Names under which only an earlier report can have written its tables."""
    for table in tables:
        both = {replace(table, synthetic=synthetic).file_stem for synthetic in (False, True)}
        yield from sorted(both - {table.file_stem} if table.rows else both)


def _remove_stale(folder: Path, stems: Iterable[str], endings: tuple[str, str]) -> None:
    for stem in stems:
        for ending in endings:
            (folder / f"{stem}{ending}").unlink(missing_ok=True)
