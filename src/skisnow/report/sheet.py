"""A report as one self-contained HTML file: sections of sentences, figures and tables; citations."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from importlib.resources import files
from typing import TYPE_CHECKING, Any, Final

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from .._support.messages import Message, current_language, translated, translations
from .formatting import prose
from .table import Table, table_html

if TYPE_CHECKING:
    from .figures.drawing import Picture


@dataclass(frozen=True, slots=True)
class Header:
    """Head of a report.

    eyebrow, title: kind of report, and its title.
    synthetic: sentence that the numbers were not measured (default: none).
    headline: key result as a sentence with one number and its uncertainty (default: none).
    back: address of the page of the lab that links here (default: none).
    """

    eyebrow: str
    title: str
    facts: Sequence[tuple[str, str | Markup]]
    synthetic: str = ""
    headline: str | Markup = ""
    back: str = ""


@dataclass(frozen=True, slots=True)
class Section:
    """Section of a report, in this order: key sentences in a box, paragraphs, figures, tables, further paragraphs."""

    name: str
    title: str
    key: Sequence[Markup] = ()
    words: Sequence[Markup] = ()
    pictures: Sequence[Picture] = ()
    tables: Sequence[Table] = ()
    after: Sequence[Markup] = ()


def sheet(header: Header, sections: Sequence[Section]) -> str:
    """HTML of a report in the current language; empty sections are omitted."""
    sections = [part for part in sections if part.key or part.words or part.pictures or part.tables or part.after]
    pictures = [picture for section in sections for picture in section.pictures]
    every = [table for section in sections for table in section.tables]
    return render_template(
        "sheet.html",
        header=header,
        sections=sections,
        version=version("skisnow"),
        bibtex=bibtex(),
        figure_numbers={picture.name: number for number, picture in enumerate(pictures, start=1)},
        tables={table.name: table_html(table, number=number) for number, table in enumerate(every, start=1)},
    )


def render_template(name: str, /, **values: Any) -> str:
    """HTML of a template of this package in the current language, with the values ``css``, ``language`` and ``cited``.

    A missing value is an error.
    """
    language = current_language()
    css = files("skisnow.report").joinpath("templates", "report.css").read_text(encoding="utf-8")
    values |= {"css": Markup(css), "language": language, "cited": CITED.format(version=version("skisnow"))}
    return _page_environment(language).get_template(name).render(**values)


def _page_environment(language: str) -> Environment:
    """Environment whose pages have ``{% trans %}``; ``{{ message }}`` and ``{{ value | text }}`` are translated."""

    def text(value: object) -> str:
        return translated(value, language)

    environment = Environment(
        loader=PackageLoader("skisnow.report"), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        extensions=["jinja2.ext.i18n"], finalize=lambda value: text(value) if isinstance(value, Message) else value,
    )  # fmt: skip
    environment.policies["ext.i18n.trimmed"] = True
    environment.filters["text"] = text
    environment.globals["prose"] = prose
    install: Callable[..., None] = environment.install_gettext_translations  # type: ignore[attr-defined]
    install(translations(language), newstyle=True)
    return environment


CITED: Final = (
    "The skisnow developers, skisnow {version}; Mössner, Innerhofer, Schindelwig, Kaps, Schretter, Nachbauer (2013), "
    "Measurement of mechanical properties of snow for simulation of skiing, Journal of Glaciology; Mössner, Heinrich, "
    "Schindelwig, Kaps, Schretter, Nachbauer (2013), Modeling the ski-snow contact in skiing turns using a hypoplastic "
    "vs an elastic force-penetration relation, Scandinavian Journal of Medicine & Science in Sports, "
    "doi 10.1111/sms.12035."
)
"""Citations on a page: the program and the papers of its methods."""
_BIBTEX: Final = """\
@software{{skisnow,
  author = {{{{The skisnow developers}}}},
  title = {{skisnow}},
  version = {{{version}}}
}}
@article{{moessner2013measurement,
  author = {{Mössner, Martin and Innerhofer, Gerhard and Schindelwig, Kurt and Kaps, Peter and Schretter, Herwig and Nachbauer, Werner}},
  title = {{Measurement of mechanical properties of snow for simulation of skiing}},
  journal = {{Journal of Glaciology}},
  year = {{2013}}
}}
@article{{moessner2013modeling,
  author = {{Mössner, Martin and Heinrich, Dieter and Schindelwig, Kurt and Kaps, Peter and Schretter, Herwig and Nachbauer, Werner}},
  title = {{Modeling the ski-snow contact in skiing turns using a hypoplastic vs an elastic force-penetration relation}},
  journal = {{Scandinavian Journal of Medicine \\& Science in Sports}},
  year = {{2013}},
  doi = {{10.1111/sms.12035}}
}}
"""  # noqa: E501
_LATEX: Final = str.maketrans({
    "\\": r"\textbackslash{}", "{": r"\textbraceleft{}", "}": r"\textbraceright{}", "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}", "<": r"\textless{}", ">": r"\textgreater{}", "|": r"\textbar{}",
    "$": r"\$", "&": r"\&", "#": r"\#", "%": r"\%", "_": r"\_",
})  # fmt: skip
_CAMPAIGN: Final = """\
@misc{{campaign,
  author = {{{authors}}},
  title = {{{title}}},
  howpublished = {{Field campaign{place}}}{files}
}}
"""


def bibtex(campaign: Mapping[str, Any] | None = None) -> str:
    """BibTeX of the program and its papers, and of a campaign with the SHA-256 of its files.

    campaign: ``campaign`` of results.json.
    """
    own = _BIBTEX.format(version=version("skisnow"))
    if campaign is None:
        return own
    observers = " and ".join(f"{{{_latex(name)}}}" for name in campaign["observers"]) or "{not stated}"
    hashes = campaign.get("files", {})
    listed = ", ".join(f"{_latex(name)} SHA-256 {digest}" for name, digest in hashes.items())
    files = f",\n  note = {{{listed}}}" if listed else ""
    place = f", {_latex(campaign['place'])}" if campaign["place"] else ""
    return own + _CAMPAIGN.format(authors=observers, title=_latex(campaign["name"]), place=place, files=files)


def _latex(text: str) -> str:
    """LaTeX of a text from a user, on one line."""
    return " ".join(text.split()).translate(_LATEX)
