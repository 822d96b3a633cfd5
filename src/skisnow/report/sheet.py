"""A short report as one HTML file that needs nothing else: sections of sentences, figures and tables."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass
from importlib.metadata import version
from importlib.resources import files
from typing import TYPE_CHECKING, Final

from markupsafe import Markup

from .._support.language import ENGLISH
from .environment import page_environment
from .tables.table_html import table_html
from .translated import translated_html

if TYPE_CHECKING:
    from .figures.drawing import Picture
    from .tables.table import Table


@dataclass(frozen=True, slots=True)
class Header:
    """What stands above the sections.

    Attributes
    ----------
    eyebrow, title
        What kind of report, and of what.
    facts
        Names with texts.
    synthetic
        A sentence where the numbers were not measured; empty: nothing is said.
    headline
        The key result in a sentence: one number, with how sure it is or how far it goes; empty: there is none.
    """

    eyebrow: str
    title: str
    facts: Sequence[tuple[str, str | Markup]]
    synthetic: str = ""
    headline: str | Markup = ""


@dataclass(frozen=True, slots=True)
class Section:
    """One section, drawn in this order: key sentences in a box, paragraphs, figures, tables, paragraphs after them."""

    name: str
    title: str
    key: Sequence[Markup] = ()
    words: Sequence[Markup] = ()
    pictures: Sequence[Picture] = ()
    tables: Sequence[Table] = ()
    after: Sequence[Markup] = ()


CITED: Final = (
    "The skisnow developers, skisnow {version}; Mössner, Innerhofer, Schindelwig, Kaps, Schretter, Nachbauer (2013), "
    "Measurement of mechanical properties of snow for simulation of skiing, Journal of Glaciology; Mössner, Heinrich, "
    "Schindelwig, Kaps, Schretter, Nachbauer (2013), Modeling the ski-snow contact in skiing turns using a hypoplastic "
    "vs an elastic force-penetration relation, Scandinavian Journal of Medicine & Science in Sports, "
    "doi 10.1111/sms.12035."
)
"""What a reader cites of such a page: the program and the papers whose methods it has, as CITATION.cff has them."""


def sheet(
    header: Header, sections: Sequence[Section], *, language: str = ENGLISH, names: Set[str] = frozenset()
) -> str:
    """The HTML in a language; ``names`` are what users wrote."""
    environment = page_environment(language)
    pictures = [picture for section in sections for picture in section.pictures]
    every = [table for section in sections for table in section.tables]
    english = environment.get_template("sheet.html").render(
        header=header,
        sections=sections,
        version=version("skisnow"),
        cited=CITED.format(version=version("skisnow")),
        figure_numbers={picture.name: number for number, picture in enumerate(pictures, start=1)},
        tables={table.name: table_html(table, number=number) for number, table in enumerate(every, start=1)},
        css=Markup(files("skisnow.report").joinpath("templates", "report.css").read_text(encoding="utf-8")),
    )
    return translated_html(english, language, names=names)
