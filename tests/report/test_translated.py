"""Translated reports."""

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from html import unescape
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest
from matplotlib.text import Text

from skisnow._support.errors import ParameterError
from skisnow._support.messages import Message, in_language
from skisnow.campaign import QUALITY_FLAGS
from skisnow.comparison import compare_tracks, comparison_dict
from skisnow.identification import track_positions
from skisnow.identification import uncertainty as words
from skisnow.identification.intervals import EXACT_POSTERIOR, QUADRATIC_POSTERIOR
from skisnow.identification.result import Identification
from skisnow.identification.track_positions import track_points
from skisnow.report import identification as identify_report
from skisnow.report import write_report
from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.page import DRAWERS
from skisnow.report.figures.drawing import Drawing, Picture
from skisnow.report.figures.style import journal_style, local_axes, site_styles
from skisnow.report.formatting import figure_text
from skisnow.report.race.figures import gap_drawings
from skisnow.report.run.drawings import run_drawings
from skisnow.report.run.page import run_page
from skisnow.report.summaries import run_verdict
from skisnow.report.table import Column, record_table, table_html
from skisnow.report.track.page import comparison_page
from skisnow.report.track.report import comparison_drawing, track_drawings
from skisnow.report.turn import page as turn_report
from skisnow.report.turn.chain import TurnChain
from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.simulation.verification import limit_sentences
from skisnow.track.course.gates_table import GateGap
from skisnow.track.summary import track_summary
from skisnow.track.track import Track, inexact_sentence

from ..conftest import without_figures
from . import test_identify_report, test_turn_report
from .conftest import Reported
from .runs import circle_run
from .test_run_report import summary_of

VERSION = f"skisnow {version('skisnow')}"
TITLE = "Measurement of mechanical properties of snow for simulation of skiing"
SAME = frozenset({"BibTeX", "Code", "Journal of Glaciology", "Moment", f", {VERSION}", TITLE})
"""What is the same in both languages: words, and the title of a paper."""
CODES = re.compile(
    r"[\w.]*_\w+|[\w-]+\.(?:csv|toml)|[0-9a-f]{64}|[ab]@\d+deg|H_.; .* linear|; .* linear|linear|[Rr]mse"
)
ENGLISH = re.compile(
    r"\b(?:the|of|and|are|with|at|by|for|from|no|over|to|yes|not|used|its|each|sites|on|none|which|"
    r"depth|load|snow|stress|angle|density|interval|experiments?|campaign|without|constant)\b",
    re.IGNORECASE,
)


def texts(html: str) -> set[str]:
    """Texts between the tags of a page and in their attributes; formulas and names of files left out."""
    html = re.sub(r"<(style|script|code|math)\b.*?</\1>", "<br>", html, flags=re.DOTALL)
    said = re.findall(r'(?:alt|aria-label|data-name)="([^"]*)"', html)
    return {unescape(each).strip() for each in (*said, *re.findall(r">([^<>]+)<", html))}


@pytest.fixture(scope="module")
def german(reference: Reported, tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("german")
    with without_figures():
        write_report(reference.analysis, folder, language="de")
    return (folder / "report.html").read_text(encoding="utf-8")


def names_of(data: ReportData) -> frozenset[str]:
    """Names from the campaign and flag codes, which are not translated."""
    campaign, experiments = data.campaign, [row["experiment"] for row in (*data.penetration, *data.shear)]
    texts = (campaign.name, campaign.place, *campaign.observers, *data.sites, *campaign.tools, *campaign.plates)
    return frozenset((*texts, *QUALITY_FLAGS, *experiments))


def test_the_time_of_the_analysis_is_written_as_in_the_language(reference: Reported, german: str) -> None:
    at = reference.analysis.time
    assert f'<time datetime="{at:%Y-%m-%dT%H:%M:%S}+00:00">{at.day}. {at.month}. {at:%Y, %H:%M} UTC</time>' in german
    assert f">{at.day} {at:%b %Y, %H:%M} UTC</time>" in reference.html


def test_no_text_of_a_german_report_is_left_in_english(reference: Reported, german: str) -> None:
    names = names_of(ReportData(reference.analysis))
    assert '<html lang="de">' in german
    before, after = texts(reference.html) - names - SAME, texts(german) - names - SAME
    words = {each for each in before if re.search("[A-Za-z]{4}", each) and not CODES.fullmatch(each)}
    assert len(words) > 250
    assert words.intersection(after) == set()
    ours = {re.sub("|".join((*map(re.escape, names | SAME), "[ab]=constant")), "", each) for each in after}
    assert {each for each in ours if ENGLISH.search(each) and not CODES.fullmatch(each)} == set()


def test_a_german_report_has_the_same_numbers(reference: Reported, german: str) -> None:
    """Every digit in its order within a table, with the comma."""

    def numbers(html: str) -> list[str]:
        (body,) = re.findall(r'id="table-models".*?<tbody[^>]*>(.*?)</tbody>', html, flags=re.DOTALL)
        return re.findall(r"−?\d+[.,]\d+", re.sub(r"<[^>]*>", " ", body))

    assert len(numbers(reference.html)) > 30
    assert numbers(german) == [each.replace(".", ",") for each in numbers(reference.html)]


def test_text_of_users_is_not_translated() -> None:
    """A site called "Site" or "Snow" keeps its name; the same words of skisnow are translated."""
    column = Column("site", Message("Site"), "text")
    with in_language("de"):
        html = table_html(
            record_table("sites", Message("Snow"), (column,), [{"site": "Snow"}, {"site": "Site"}]), number=1
        )
    assert re.findall(r"<th [^>]*>([^<]*)</th>", html) == ["Messort", "Snow", "Site"]
    assert "</b> Schnee</caption>" in html


def written(drawing: Drawing) -> Iterator[str]:
    """Every text of a figure, those at its axes too."""
    for axes in drawing.figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            yield from axis.get_major_formatter().format_ticks([0.5, 1.0])
    for text in drawing.figure.findobj(Text):
        assert isinstance(text, Text)
        yield text.get_text()


def texts_of_figure(draw: Callable[[], object], language: str) -> set[str]:
    """All texts of a figure that is drawn in a language."""
    with journal_style(), in_language(language):
        drawn = draw()
        assert isinstance(drawn, Drawing)
        local_axes(drawn.figure)
        return set(written(drawn))


@pytest.mark.parametrize("number", range(len(DRAWERS)))
def test_no_word_in_a_german_figure_is_left_in_english(reference: Reported, number: int) -> None:
    data = ReportData(reference.analysis)
    names = frozenset(map(figure_text, names_of(data)))
    german = texts_of_figure(lambda: DRAWERS[number](data, site_styles(data)), "de")
    german = {re.sub(r"\$[^$]*\$", "", each) for each in german} - names
    assert any(re.search("[a-z]{4}", each) for each in german)
    assert {each for each in german if ENGLISH.search(each) and not CODES.fullmatch(each)} == set()
    assert {each for each in german if re.search(r"\d\.\d", each)} == set()


def test_no_word_in_german_figures_of_tracks_is_left_in_english() -> None:
    way = np.linspace(0.0, 40.0, 300)
    place = np.column_stack([way, 3.0 * np.sin(way / 5.0), 0.0 * way])
    measured, simulated = (
        Track("a.csv", way / 8.0, place + shift, np.full(300, np.nan), "local", "made by hand") for shift in (0.0, 0.1)
    )
    found = compare_tracks(simulated, measured)
    summary = track_summary(measured)
    shown: dict[str, list[set[str]]] = {}
    for code in ("en", "de"):
        with journal_style(), in_language(code):
            drawings = [*track_drawings(summary), comparison_drawing(found)]
            for each in drawings:
                local_axes(each.figure)
            shown[code] = [set(written(each)) for each in drawings]
    assert len(shown["en"]) == 5
    for english, german in zip(shown["en"], shown["de"], strict=True):
        assert {each for each in german if ENGLISH.search(re.sub(r"\$[^$]*\$", "", each))} == set()
        assert len(english) > 5
        assert {each for each in english & german if re.search("[a-z]{4}", each)} == set()


chain, found = test_turn_report.chain, test_identify_report.found  # fixtures
KEYS = frozenset(
    {*SCENARIO_KEYS, "giant-slalom", "false", "true", "BibTeX", "Start", "Start (J)", VERSION, f", {VERSION}"}
)
NAMES = ("run A", "run B")
CHOICES = frozenset(word for key in SCENARIO_KEYS.values() for word in key.choices)
GAPS = tuple(
    GateGap(gate=gate, outcome="passed", other_outcome=other, time_s=own, other_time_s=its, gap_s=gap, lost_s=lost)
    for gate, other, own, its, gap, lost in (
        ("1", "passed", 1.5, 1.25, 0.25, 0.25),
        ("2", "missed", 2.5, None, None, None),
        ("3", "passed", 3.5, 3.75, -0.25, -0.5),
    )
)


def drawn(drawings: Iterator[Drawing], names: frozenset[str], language: str) -> list[Picture]:
    """Drawn in a language, without files; no word in a German one is English."""
    pictures = []
    with journal_style(), in_language(language):
        for each in drawings:
            shown = {re.sub(r"\$[^$]*\$", "", text) for text in written(each)} - names
            assert language == "en" or {text for text in shown if ENGLISH.search(_without(text, names))} == set()
            assert any(re.search("[a-z]{4}", text) for text in shown)
            pictures.append(Picture(each.name, each.whole_caption, each.alt, each.wide, "", b""))
    return pictures


def _without(text: str, names: frozenset[str]) -> str:
    for name in sorted(names, key=len, reverse=True):
        text = text.replace(name, "")
    return text


def left(page: Callable[[str], str], names: frozenset[str], *, fewest: int) -> set[str]:
    """Texts of a page that stay as they are or have an English word, but for names and keys."""
    pages = []
    for language in ("en", "de"):
        with in_language(language):
            pages.append(texts(page(language)))
    english, german = pages
    words = {each for each in english if re.search("[A-Za-z]{4}", _without(each, names))} - KEYS
    assert len(words) > fewest
    stayed = words & german
    return stayed | {
        each for each in german - KEYS if ENGLISH.search(_without(each, names)) and "The skisnow developers" not in each
    }


def test_no_text_of_a_german_run_is_left_in_english() -> None:
    """Its page and its figures, but for keys, the papers to cite, and the ids of what the run was given."""
    run = circle_run()
    names = frozenset({run.scenario.contact.snow.source, *CHOICES})

    def page(language: str) -> str:
        return run_page(run, summary_of(run), drawn(run_drawings(run), names, language))

    assert left(page, names, fewest=150) == set()


def test_no_text_of_a_german_turn_is_left_in_english(chain: TurnChain) -> None:
    names = frozenset({chain.campaign, chain.site, chain.snow.source, *chain.runs, *CHOICES, "Hypoplastic,"})

    def page(language: str) -> str:
        pictures = drawn(turn_report._make_drawings(chain), names, language)
        return turn_report.turn_page(chain, pictures)

    assert left(page, names, fewest=120) == set()


def names_in(found: Identification) -> frozenset[str]:
    parameters = {text for row in found.parameters for text in (row.parameter.name, row.parameter.key)}
    files = {fit.name for fit in found.fits} | {name for name, _ in found.data}
    return frozenset({found.scenario, *files, *parameters})


def test_no_text_of_a_german_identification_is_left_in_english(found: Identification) -> None:
    names = names_in(found) | {"Two are hardly told apart", "By Gauss and Newton", "The search ended", "photo cells"}

    def page(language: str) -> str:
        pictures = drawn(identify_report._drawings(found), names, language)
        return identify_report.identify_page(found, pictures)

    assert left(page, names, fewest=30) == set()


def test_no_text_of_german_gaps_is_left_in_english() -> None:
    names = frozenset(NAMES)

    def page(language: str) -> str:
        pictures = drawn(gap_drawings(GAPS, NAMES), names, language)
        way = np.linspace(0.0, 40.0, 300)
        place = np.column_stack([way, 3.0 * np.sin(way / 5.0), 0.0 * way])
        tracks = [
            Track(name, way / speed, place, np.full(300, np.nan), "local", "made by hand")
            for name, speed in zip(NAMES, (8.0, 9.0), strict=True)
        ]
        compared, verdict = comparison_dict(compare_tracks(*tracks)), run_verdict(*tracks)
        return comparison_page(compared, pictures, verdict=verdict, gaps=GAPS)

    assert left(page, names, fewest=12) == set()


def test_a_language_without_texts_is_rejected_before_anything_is_written(
    reference: Reported, chain: TurnChain, found: Identification, tmp_path: Path
) -> None:
    writers: tuple[Callable[[Path], object], ...] = (
        lambda folder: write_report(reference.analysis, folder, language="xx"),
        lambda folder: chain.report(folder, language="xx"),
        lambda folder: identify_report.write_identify_report(found, {}, folder, language="xx"),
    )
    for write in writers:
        with pytest.raises(ParameterError):
            write(tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_every_warning_about_identified_values_has_its_german_one() -> None:
    """Whatever pair, whatever value: as the report shows them, each with its full stop."""
    german = [
        Message("{warning}.", warning=each).text("de") for each in (*words._HELPS.values(), *words._ALONE.values())
    ]
    assert [each for each in german if ENGLISH.search(each)] == []


def test_no_warning_of_a_german_identification_is_left_in_english(found: Identification) -> None:
    parameters = tuple(row.parameter for row in found.parameters)
    spreads = [words.linear_uncertainty(size * np.eye(2), degrees_of_freedom=None) for size in (0.01, 0.0)]
    way = np.linspace(0.0, 20.0, 20)
    track = track_points(Track("a", way, np.column_stack([way, 0.0 * way, way]), np.full(20, np.nan), "local", "made"))
    row = {"outcome": "energy_open", "reached": 15, "x_m": [*way[:19], 90.0], "y_m": [0.0] * 20}
    warnings = (
        *(text for spread in spreads for text in words.unknown_warnings(parameters, spread)),
        *track_positions._result_warnings(track, row | {"speed_m_per_s": [0.0] * 20}),
        *limit_sentences({"start.speed_m_per_s": 1.5}, 10.0),
        *filter(None, [track_positions.require_near(track, (1.5, 0.0), start_is_free=False)]),
        *filter(None, [inexact_sentence("a", np.array(kinds)) for kinds in (["fixed", "float"], ["fixed", "code"])]),
    )
    assert len(warnings) == 11
    result = replace(found, warnings=warnings, methods=(QUADRATIC_POSTERIOR, EXACT_POSTERIOR), data=())
    names = names_in(found) | {"The search ended"}
    assert left(lambda _: identify_report.identify_page(result, []), names, fewest=30) == set()


def test_no_warning_of_a_german_comparison_is_left_in_english() -> None:
    way = np.linspace(0.0, 60.0, 300)
    place = np.column_stack([way, 3.0 * np.sin(way / 5.0), -0.4 * way])
    flags = {"x": np.arange(300) < 9}
    onto_map = Track("a", way, place, np.full(300, np.nan), "local", axes="east_north_up", flags=flags)
    on_slope = replace(onto_map, name="b", place=place[:240], time=way[:240], speed=way[:240], axes="slope", flags={})
    fits = [compare_tracks(on_slope, onto_map, fit=fit) for fit in ((), ("start", "heading"))]
    texts_of_fits = [text for fit in fits for text in (*fit.warnings, fit.seen)]
    assert len(texts_of_fits) > 6
    assert [text.text("de") for text in texts_of_fits if ENGLISH.search(text.text("de"))] == []
