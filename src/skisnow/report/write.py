"""Writing a report: every table and figure as files, the page, and results.json last."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from ..errors import ParameterError
from ..estimate import Analysis
from ..estimate.results_text import results_json
from ..files import write_file
from ..language import ENGLISH, require_language
from ..memory import paused_collector
from ..staging import staged, tidied
from .figures import figures_of
from .page import page
from .pictures import picture_files, write_picture
from .report_data import ReportData
from .table_csv import table_csv
from .table_latex import table_latex
from .tables import tables_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from .table import Table

RESULTS: Final = "results.json"


def write_report(
    analysis: Analysis,
    out: str | Path,
    *,
    language: str = ENGLISH,
    progress: Callable[[str], None] | None = None,
) -> Path:
    """Write report.html, figures/, tables/ and results.json of an analysed campaign.

    All is made in a folder of its own inside ``out`` and moved into place at the end: an error or interruption before
    leaves ``out`` as it was.

    Parameters
    ----------
    analysis
        What `skisnow.analyse` gave.
    out
        The folder; made where it is missing. Other files in it stay. Of an earlier report's tables and figures those
        that this campaign has no data for are removed, so that the folder tells of one campaign.
    language
        Of the page and the figures: en, or a language that there is a catalogue of (de). Tables and results.json, which
        programs read, are the same in every language.
    progress
        Called with a line of text now and then.

    Returns
    -------
    Path
        Of report.html.

    Raises
    ------
    ParameterError
        What is given is no analysis, or there are no texts of the language.
    OutputError
        A file cannot be written. results.json, moved last, says by its presence beside the others that all is there.

    See Also
    --------
    skisnow.analyse : what is written.
    skisnow.results_dict : its numbers alone.

    References
    ----------
    The page docs/files/results.md.
    """
    if not isinstance(analysis, Analysis):
        raise ParameterError(
            "a report is written of an analysis, into a folder: write_report(analyse(campaign), folder); given is a "
            f"{type(analysis).__name__}"
        )
    require_language(language)
    report = progress or _silent
    out = Path(out)
    for sentence in tidied(out):
        report(sentence)
    with paused_collector(), staged(out, last=RESULTS) as stage:
        stage.stale += _write(ReportData(analysis), stage.path, language, report)
    return out / "report.html"


def _write(data: ReportData, stage: Path, language: str, report: Callable[[str], None]) -> list[str]:
    """Write all files below the stage; returns those of an earlier report that this campaign has no data for."""
    report("tables of the report")
    every_table = tables_of(data)
    tables = {name: table for name, table in every_table.items() if table.rows}
    for table in tables.values():
        report(f"table {table.name}")
        _write_table(table, stage / "tables")
    pictures, missing = figures_of(data, language=language, progress=report)
    for picture in pictures:
        write_picture(picture, stage / "figures")
    report("report.html")
    write_file(stage / "report.html", page(data, tables, pictures, missing, language=language))
    report("results.json")
    write_file(stage / RESULTS, results_json(data.results))
    stale = [f"tables/{stem}{ending}" for stem in _other_stems(every_table.values()) for ending in (".csv", ".tex")]
    return stale + picture_files(left_out.name for left_out in missing)


def _silent(_text: str) -> None:
    return


def _write_table(table: Table, folder: Path) -> None:
    write_file(folder / f"{table.file_stem}.csv", table_csv(table))
    write_file(folder / f"{table.file_stem}.tex", table_latex(table))


def _other_stems(tables: Iterable[Table]) -> Iterator[str]:
    """Names under which only an earlier report can have written its tables."""
    for table in tables:
        both = {replace(table, synthetic=synthetic).file_stem for synthetic in (False, True)}
        yield from sorted(both - {table.file_stem} if table.rows else both)
