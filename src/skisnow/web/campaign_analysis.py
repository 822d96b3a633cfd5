"""Analysis of a campaign's files with a choice of data: results, tables, figures and the report."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from .._support.errors import FieldDataError, SkisnowError
from ..campaign import QUALITY_FLAGS, campaign_of_files
from ..campaign.problems import ALWAYS_EXCLUDE, Problem, lines_of
from ..estimation import analyse
from ..report import write_report
from ..report.campaign.data import ReportData
from ..report.campaign.key_results import key_results
from ..report.campaign.page import DRAWERS, tables_html
from ..report.campaign.tables import campaign_tables
from ..report.figures.drawing import Drawing, data_uri, drawing_svg
from ..report.figures.style import journal_style, site_styles
from ..report.figures.translated import translate_figure
from ..report.symbols import figure_text

if TYPE_CHECKING:
    from ..campaign.reading import FilesInMemory
    from ..campaign.records import Campaign, PenetrationTests, ShearTests
    from ..estimation import Analysis

LEFT_OUT: Final = "left out by choice in the lab"
N_FIGURES: Final = len(DRAWERS)
SHOWN_TABLES: Final = ("sites", "models", "model_tests", "regressions", "penetration_experiments", "shear_experiments")


@dataclass(frozen=True, slots=True)
class Choice:
    """Included data.

    Attributes
    ----------
    excluding
        Codes of the quality flags that leave an experiment out; None: those of the campaign.
    left_out
        Experiments that are left out besides, by file and name.
    """

    excluding: frozenset[str] | None = None
    left_out: frozenset[tuple[str, str]] = frozenset()


@dataclass(frozen=True, slots=True)
class Numbers:
    """The campaign as chosen, analysed; the report's key results and, by name, its tables, as HTML."""

    analysis: Analysis
    key_results: tuple[str, ...]
    tables: dict[str, str]

    @property
    def results(self) -> dict[str, Any]:
        """The contents of results.json."""
        return self.analysis.results

    @property
    def names(self) -> frozenset[str]:
        """What users wrote, which no language has other words for."""
        return ReportData(self.analysis).names

    @property
    def excluding(self) -> frozenset[str]:
        """Codes of the quality flags that leave an experiment out."""
        return self.analysis.campaign.excluding


@dataclass(frozen=True, slots=True)
class Shown:
    """A figure: name, words for who cannot see it, caption as HTML, address of its image; ``wide``: it scrolls."""

    name: str
    alt: str
    caption: str
    image: str
    wide: bool


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why there is no answer, in a sentence, and where files are at fault a line for each error in them.

    An exception would not travel between processes whole.
    """

    said: str
    errors: tuple[str, ...] = ()


def numbers_of(files: FilesInMemory, choice: Choice) -> Numbers | Refusal:
    """Analyse a campaign whose files are at hand."""
    try:
        analysis = analyse(_chosen(campaign_of_files(files.contents, others=files.others), choice))
    except FieldDataError as error:
        wrong = (each for each in error.problems if isinstance(each, Problem) and each.severity == "error")
        return Refusal(str(error), tuple(lines_of(wrong)))
    except SkisnowError as error:
        return Refusal(str(error))
    data = ReportData(analysis)
    html = tables_html({name: table for name, table in campaign_tables(data).items() if table.rows})
    shown: dict[str, str] = {name: str(html[name]) for name in SHOWN_TABLES if name in html}
    return Numbers(analysis, tuple(map(str, key_results(data))), shown)


def figure(analysis: Analysis, number: int, language: str) -> Shown | None:
    """Draw one of the report's figures, counted from 0, of what `numbers_of` gave; None: there are no data for it."""
    data = ReportData(analysis)
    with journal_style():
        drawn = DRAWERS[number](data, site_styles(data))
        if not isinstance(drawn, Drawing):
            return None
        translate_figure(drawn.figure, language, names=frozenset(map(figure_text, data.names)))
        return Shown(drawn.name, drawn.alt, str(drawn.whole_caption), data_uri(drawing_svg(drawn)), drawn.wide)


def ready() -> None:
    """Draw nothing: a process that was asked for this has what it needs to draw."""


def write_whole_report(analysis: Analysis, out: str, language: str) -> None:
    """Write the report with its tables, figures and results.json."""
    write_report(analysis, Path(out), language=language)


def choosable_flags() -> dict[str, str]:
    """Codes of the quality flags that may be let in or left out, with their sentences."""
    return {code: flag.sentence for code, flag in QUALITY_FLAGS.items() if code not in ALWAYS_EXCLUDE}


def _chosen(campaign: Campaign, choice: Choice) -> Campaign:
    excluding = campaign.excluding if choice.excluding is None else choice.excluding | ALWAYS_EXCLUDE
    return replace(
        campaign,
        excluding=excluding,
        penetration=_less(campaign.penetration, "penetration.csv", choice),
        shear=_less(campaign.shear, "shear.csv", choice),
    )


def _less(tests: Any, file: str, choice: Choice) -> Any:
    """The tests with those cancelled that are left out: they stay in every table, with the reason."""
    typed: PenetrationTests | ShearTests | None = tests
    if typed is None:
        return None
    gone = np.array([(file, name) in choice.left_out for name in typed.experiment], dtype=bool)
    cancelled = tuple(why or (LEFT_OUT if out else "") for why, out in zip(typed.cancelled, gone, strict=True))
    return replace(typed, cancelled=cancelled)
