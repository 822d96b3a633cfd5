"""Analysis of a campaign's files with a choice of included data: results, tables, figures and report."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from .._support.errors import FieldDataError, SkisnowError
from .._support.messages import Message, in_language, languages
from ..campaign import QUALITY_FLAGS, campaign_of_files
from ..campaign.problems import ALWAYS_EXCLUDE, Problem, lines_of
from ..estimation import analyse
from ..report import write_report
from ..report.campaign.data import ReportData
from ..report.campaign.key_results import key_results
from ..report.campaign.page import DRAWERS, tables_html
from ..report.campaign.tables import campaign_tables
from ..report.campaign.verdicts import verdicts
from ..report.figures.drawing import Drawing, data_uri, drawing_svg
from ..report.figures.style import journal_style, local_axes, site_styles

if TYPE_CHECKING:
    from ..campaign.reading import FilesInMemory
    from ..campaign.records import Campaign, PenetrationTests, ShearTests
    from ..estimation import Analysis

LEFT_OUT: Final = Message("left out by choice in the lab")
N_FIGURES: Final = len(DRAWERS)
SHOWN_TABLES: Final = ("sites", "models", "model_tests", "regressions", "penetration_experiments", "shear_experiments")


@dataclass(frozen=True, slots=True)
class Choice:
    """Included data.

    Attributes
    ----------
    excluding
        Codes of the quality flags that exclude an experiment (default: those of the campaign).
    left_out
        Further excluded experiments by file and name.
    """

    excluding: frozenset[str] | None = None
    left_out: frozenset[tuple[str, str]] = frozenset()


@dataclass(frozen=True, slots=True)
class Numbers:
    """Analysis of a campaign with a choice, its verdicts, and the report's key results and tables as HTML.

    Both are by language, the tables also by name.
    """

    analysis: Analysis
    verdicts: tuple[Message, ...]
    key_results: dict[str, tuple[str, ...]] = field(default_factory=dict)
    tables: dict[str, dict[str, str]] = field(default_factory=dict)

    @property
    def results(self) -> dict[str, Any]:
        """Contents of results.json."""
        return self.analysis.results

    @property
    def excluding(self) -> frozenset[str]:
        """Codes of the quality flags that exclude an experiment."""
        return self.analysis.campaign.excluding


@dataclass(frozen=True, slots=True)
class FigureImage:
    """A figure with alternative text, caption as HTML, and address of its image; a ``wide`` one scrolls."""

    name: str
    alt: str
    caption: str
    image: str
    wide: bool


@dataclass(frozen=True, slots=True)
class Refusal:
    """Sentence why there is no analysis, with a line for each error in the files.

    Unlike an exception it can be sent between processes.
    """

    said: str
    errors: tuple[str, ...] = ()


def analyse_files(files: FilesInMemory, choice: Choice) -> Numbers | Refusal:
    """Analyse a campaign in memory."""
    try:
        analysis = analyse(_select_data(campaign_of_files(files.contents, others=files.others), choice))
    except FieldDataError as error:
        errors = (problem for problem in error.problems if isinstance(problem, Problem) and problem.severity == "error")
        return Refusal(error.message, tuple(lines_of(errors)))
    except SkisnowError as error:
        return Refusal(error.message)
    data = ReportData(analysis)
    numbers = Numbers(analysis, tuple(verdicts(analysis.results)))
    for language in languages():
        with in_language(language):
            html = tables_html({name: table for name, table in campaign_tables(data).items() if table.rows})
            numbers.tables[language] = {name: str(html[name]) for name in SHOWN_TABLES if name in html}
            numbers.key_results[language] = tuple(map(str, key_results(data)))
    return numbers


def figure(analysis: Analysis, number: int, language: str) -> FigureImage | None:
    """Image of one of the report's figures, counted from 0; None if the campaign has no data for it."""
    data = ReportData(analysis)
    with journal_style(), in_language(language):
        drawn = DRAWERS[number](data, site_styles(data))
        if not isinstance(drawn, Drawing):
            return None
        local_axes(drawn.figure)
        return FigureImage(
            drawn.name, str(drawn.alt), str(drawn.whole_caption), data_uri(drawing_svg(drawn)), drawn.wide
        )


def load_drawing() -> None:
    """Do nothing: the call imports this module, and with it Matplotlib, in the worker process."""


def write_whole_report(analysis: Analysis, out: str, language: str) -> None:
    """Write the report with tables, figures and results.json to a folder."""
    write_report(analysis, Path(out), language=language)


def choosable_flags() -> dict[str, str]:
    """Codes of the quality flags that users can include or exclude, with their sentences."""
    return {code: flag.sentence for code, flag in QUALITY_FLAGS.items() if code not in ALWAYS_EXCLUDE}


def _select_data(campaign: Campaign, choice: Choice) -> Campaign:
    excluding = campaign.excluding if choice.excluding is None else choice.excluding | ALWAYS_EXCLUDE
    return replace(
        campaign,
        excluding=excluding,
        penetration=_cancel_left_out(campaign.penetration, "penetration.csv", choice),
        shear=_cancel_left_out(campaign.shear, "shear.csv", choice),
    )


def _cancel_left_out(tests: Any, file: str, choice: Choice) -> Any:
    """Tests of which the excluded ones are cancelled with a reason, so that they stay in every table."""
    typed: PenetrationTests | ShearTests | None = tests
    if typed is None:
        return None
    gone = np.array([(file, name) in choice.left_out for name in typed.experiment], dtype=bool)
    cancelled = tuple(why or (LEFT_OUT if out else "") for why, out in zip(typed.cancelled, gone, strict=True))
    return replace(typed, cancelled=cancelled)
