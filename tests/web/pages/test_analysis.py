"""*Analysis*: the numbers of a campaign, the choice of what takes part, the figures as they come, the report."""

from __future__ import annotations

import asyncio
import io
import os
import threading
import zipfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from nicegui import ui

from skisnow.errors import FieldDataError, ParameterError, StoreError
from skisnow.estimate import analyse
from skisnow.field import read_campaign
from skisnow.field.reading import FilesInMemory
from skisnow.field.store import Journals
from skisnow.report.figures import DRAWERS
from skisnow.report.report_data import ReportData
from skisnow.report.sentences.key_results import key_results
from skisnow.web import analyses as analyses_module
from skisnow.web import analysing, analysis_view
from skisnow.web.analyses import Analysed, Analyses, CampaignSource
from skisnow.web.analysing import Choice, Numbers, Refusal, Shown, choosable_flags, figure, numbers_of
from skisnow.web.analysis_view import AnalysisView, OpenAnalysis
from skisnow.web.pages import analysis as page_module
from skisnow.web.worker import Worker

if TYPE_CHECKING:
    from .desk import Desk, Sheet

TOML = """name = "Desk"
[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200
width_mm = 62
[[plate]]
name = "blade"
length_mm = 100
"""
SERIES = {
    "1": ("A", "", (1.5, 2.1, 2.6)),
    "2": ("A", "", (1.5, 2.1, 2.6)),
    "3": ("B", "", (1.0, 1.4, 1.7)),
    "4": ("B", "", (1.0, 1.4)),  # fewer than three loads
    "5": ("A", "slipped", (1.5, 2.1, 2.6)),
}
PENETRATION = "experiment,site,tool,edge_angle_deg,load_N,depth_mm,status\n" + "".join(
    f"{name},{site},ski piece,30,{20 * number},{depth},{status}\n"
    for name, (site, status, depths) in SERIES.items()
    for number, depth in enumerate(depths, start=1)
)
SHEAR = "experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm\n" + "".join(
    f"{name},{site},blade,90,5,250,{moment}\n"
    for name, site, moment in (("a", "A", 20), ("1", "A", 21), ("c", "B", 30))
)
FILES = {"campaign.toml": TOML, "penetration.csv": PENETRATION, "shear.csv": SHEAR}
FLAGS = choosable_flags()
EXPERIMENTS = [
    "field Penetration 1, A, 30° = True",
    "field Penetration 2, A, 30° = True",
    "field Penetration 3, B, 30° = True",
    "field Penetration 4, B, 30° = True",
    "field Penetration 5, A, 30° (cancelled) = False",
    "field Shear a, A, 90° = True",
    "field Shear 1, A, 90° = True",
    "field Shear c, B, 90° = True",
]
COUNTED = "5 penetration experiments, 3 used; 3 shear experiments, 3 used."


@dataclass
class Drawing:
    """What the other process would do is done in this one; figures wait for the gate."""

    gate: asyncio.Event = field(default_factory=asyncio.Event)
    asked: list[Any] = field(default_factory=list)
    reports: list[Any] = field(default_factory=list)
    done: int = 0
    """Figures that are there."""
    held: int = 0
    """Only figures of so many points wait; 0: all."""


def points(analysis: Any) -> int:
    return sum(row["used"] for row in analysis.results["penetration"]["experiments"])


@pytest.fixture
def drawing(monkeypatch: pytest.MonkeyPatch) -> Drawing:
    """The gate is open at first. Of three figures the second has no data; the third has an image for a phone."""
    made = Drawing()
    made.gate.set()

    def drawn(analysis: Any, number: int, _language: str) -> Shown | None:
        if number == 1:
            return None
        narrow = "data:narrow" if number == 2 else ""
        return Shown(
            f"fig{number}", f"{points(analysis)} points", f"<b>Figure {number}.</b> A", f"data:{number}", narrow
        )

    def written(analysis: Any, out: str, language: str) -> None:
        made.reports.append((Path(out).name, language))
        (Path(out) / "figures").mkdir(parents=True)
        (Path(out) / "figures" / "one.svg").write_text("<svg/>", encoding="utf-8")
        rows = analysis.results["penetration"]["experiments"]
        (Path(out) / "report.html").write_text(f"{[row['used'] for row in rows]}", encoding="utf-8")
        (Path(out) / "results.json").write_text("{}", encoding="utf-8")

    async def do(_self: Worker, work: Callable[..., Any], *given: Any) -> Any:
        made.asked.append((work.__name__, *given[1:]))
        if work is drawn:
            if made.held in (0, points(given[0])):
                await made.gate.wait()
            made.done += 1
        return work(*given)

    monkeypatch.setattr(analyses_module, "figure", drawn)
    monkeypatch.setattr(analyses_module, "N_FIGURES", 3)
    monkeypatch.setattr(page_module, "write_whole_report", written)
    monkeypatch.setattr(Worker, "do", do)
    return made


def kept(desk: Desk, folder: Path, files: dict[str, str] | None = None) -> str:
    """The id of a kept campaign that no other test has: what was analysed stays in memory."""
    folder.mkdir()
    for name, text in (files or FILES).items():
        (folder / name).write_text(text, encoding="utf-8")
    with (folder / "campaign.toml").open("a", encoding="utf-8") as file:
        file.write(f"# {folder}\n")
    return desk.lab.store.add(folder).id


def opened(page: Sheet, words: str) -> None:
    """Open what stands behind these words."""
    (found,) = (
        each
        for each in page.tagged("details")
        if words in [word.text for word in each.descendants() if isinstance(word, ui.label)]
    )
    page.fire(found, "toggle", {})


def status(page: Sheet) -> str:
    return next(line for line in page.outline() if line.startswith("[status] "))[9:]


def finally_says(page: Sheet, words: str) -> None:
    page.until(lambda: status(page) == words)


def figures(page: Sheet) -> list[tuple[str, str]]:
    """Address and words of each image."""
    return [(each.props["src"], each.props["alt"]) for each in page.tagged("img")]


def report_key(page: Sheet) -> str:
    return page.shows("link Open the report").split("/")[2]


def test_numbers_tables_and_figures_stand_in_their_order(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    desk.do(drawing.gate.clear)
    id_ = kept(desk, tmp_path / "kept")
    page = desk.open(f"/analysis/kept/{id_}")
    key = report_key(page)
    finally_says(page, f"{COUNTED} Drawing the figures …")
    lines = page.outline()
    theirs = analyse(read_campaign(tmp_path / "kept"))
    assert lines[:6] == [
        "h1 Analysis",
        f"link Open the report -> /report/{key}/report.html",
        "link Download everything -> #",
        f"link Export the campaign -> /export/kept/{id_}.zip",
        f"[status] {COUNTED} Drawing the figures …",
        "h2 Desk",
    ]
    assert len(key) == 16
    results = [each.content for each in page.of(ui.html)]
    assert results[:2] == [str(each) for each in key_results(ReportData(theirs))]
    assert "A <strong>0.0512</strong> N/mm³" in results[0]
    assert lines[8] == f"[quiet] {theirs.results['penetration']['warnings'][0]}"
    assert lines[9].startswith("html Table 1. Snow hardness and failure shear stress by site")
    assert lines[10:13] == [
        "h2 Included data", "Exclude experiments with these quality flags", "Included experiments",
    ]  # fmt: skip
    assert lines[13].startswith("html Table 4. Linear regressions")
    assert lines[14:] == ["Every penetration experiment", "Every shear experiment"]
    assert [each.props["aria-label"] for each in page.tagged("section")] == [
        "Key results", "Included data", "Tables", "Figures",
    ]  # fmt: skip
    assert [(each.tag, len(each.default_slot.children)) for each in page.of() if "results" in each.classes] == [
        ("ul", 2)
    ]
    desk.do(drawing.gate.set)
    finally_says(page, COUNTED)
    assert page.outline()[16:] == ["h2 Figures", "html Figure 0. A", "html Figure 2. A"]
    assert figures(page) == [("data:0", "3 points"), ("data:2", "3 points")]
    (source,) = page.tagged("source")
    assert source.props == {"media": "(max-width: 46rem)", "srcset": "data:narrow"}
    assert [each.tag for each in page.of() if each.tag in ("figure", "picture", "figcaption")] == [
        "figure", "picture", "figcaption",
    ] * 2  # fmt: skip
    assert [each for each in drawing.asked if each[0] == "drawn"] == [("drawn", number, "en") for number in range(3)]
    assert [each[0] for each in drawing.asked].count("ready") == 1
    assert [each.text for each in page.of() if each.props.get("aria-current") == "page"] == ["Campaigns"]


def test_what_was_computed_is_there_with_the_page(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    id_ = kept(desk, tmp_path / "kept")
    page = desk.open(f"/analysis/kept/{id_}")
    assert "Computing …" in page.html and "Drawing the figures" not in page.html
    finally_says(page, COUNTED)
    desk.do(drawing.gate.clear)
    asked = len(drawing.asked)
    again = desk.open(f"/analysis/kept/{id_}")
    assert f"{COUNTED} Drawing the figures …" in again.html
    finally_says(again, COUNTED)  # they are drawn
    assert figures(again) == [("data:0", "3 points"), ("data:2", "3 points")]
    assert drawing.asked[asked:] == [("ready",)]
    german = desk.open(f"/analysis/kept/{id_}", "de")
    desk.do(drawing.gate.set)
    german.until(lambda: figures(german))
    german.until(lambda: len(figures(german)) == 2)
    assert drawing.asked[-3:] == [("drawn", number, "de") for number in range(3)]
    assert report_key(page) != report_key(again)


def test_tables_of_every_experiment_are_there_once_they_are_opened(
    desk: Desk, tmp_path: Path, drawing: Drawing
) -> None:
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    finally_says(page, COUNTED)
    for _ in range(2):
        opened(page, "Every shear experiment")
        lines = page.outline()
        at = lines.index("Every penetration experiment")
        assert lines[at + 1] == "Every shear experiment"
        assert lines[at + 2].startswith("html Table 9. Shear experiments")
        assert lines[at + 3] == "h2 Figures"
    assert drawing.asked


def test_an_experiment_that_is_left_out_stays_in_the_tables(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    finally_says(page, COUNTED)
    opened(page, "Included experiments")
    at = page.outline().index("Included experiments")
    assert page.outline()[at + 1 : at + 9] == EXPERIMENTS
    assert [each.enabled for each in page.of(ui.checkbox)] == [True] * 4 + [False] + [True] * 3
    page.fill("Penetration 1, A, 30°", False)
    finally_says(page, "5 penetration experiments, 2 used; 3 shear experiments, 3 used.")
    assert figures(page) == [("data:0", "2 points"), ("data:2", "2 points")]
    page.fill("Shear 1, A, 90°", False)
    finally_says(page, "5 penetration experiments, 2 used; 3 shear experiments, 2 used.")
    page.fill("Penetration 1, A, 30°", True)
    finally_says(page, "5 penetration experiments, 3 used; 3 shear experiments, 2 used.")
    asked = len(drawing.asked)
    page.fill("Shear 1, A, 90°", True)
    finally_says(page, COUNTED)
    assert len(drawing.asked) == asked  # as at first
    at = page.outline().index("Included experiments")
    assert page.outline()[at + 1 : at + 9] == EXPERIMENTS


def test_flags_are_let_in_and_left_out(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    finally_says(page, COUNTED)
    opened(page, "Exclude experiments with these quality flags")
    at = page.outline().index("Exclude experiments with these quality flags")
    of_campaign = ("too_few_loads", "loads_not_rising", "depth_shrinks")
    lines = [f"field {words} = {code in of_campaign}" for code, words in FLAGS.items()]
    assert page.outline()[at + 1 : at + 1 + len(FLAGS)] == lines
    page.fill(FLAGS["too_few_loads"], False)
    finally_says(page, COUNTED.replace("3 used; 3", "4 used; 3"))
    page.fill(FLAGS["layered"], True)
    page.until(lambda: len([each for each in drawing.asked if each[0] == "drawn"]) == 9)
    page.fill(FLAGS["too_few_loads"], True)
    finally_says(page, COUNTED)
    assert drawing.asked


def test_what_is_chosen_meanwhile_is_what_is_shown(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    """The first figure of the first choice comes after all of the second."""
    desk.do(drawing.gate.clear)
    drawing.held = 3
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    finally_says(page, f"{COUNTED} Drawing the figures …")
    opened(page, "Included experiments")
    page.fill("Penetration 1, A, 30°", False)
    fewer = COUNTED.replace("3 used; 3", "2 used; 3")
    finally_says(page, fewer)
    shown = page.outline()
    desk.do(drawing.gate.set)
    page.until(lambda: drawing.done == 4)
    assert page.outline() == shown
    assert figures(page) == [("data:0", "2 points"), ("data:2", "2 points")]


def test_nothing_more_is_drawn_for_a_page_that_is_closed(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    desk.do(drawing.gate.clear)
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    page.until(lambda: ("drawn", 0, "en") in drawing.asked)
    desk.do(page.client.delete)
    desk.do(drawing.gate.set)
    page.until(lambda: drawing.done)
    assert desk.do(lambda: drawing.done) == 1


def test_long_lists_are_cut(desk: Desk, tmp_path: Path, drawing: Drawing, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(analysis_view, "MOST_LISTED", 3)
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    finally_says(page, COUNTED)
    opened(page, "Included experiments")
    at = page.outline().index("Included experiments")
    assert page.outline()[at + 1 : at + 8] == [
        *EXPERIMENTS[:3],
        "[quiet] The first 3 of 5 penetration experiments.",
        *EXPERIMENTS[5:],
    ]
    assert page.outline()[at + 8].startswith("html Table 4")
    assert drawing.asked


WRONG = {"campaign.toml": TOML, "penetration.csv": PENETRATION.replace("30,40,2.1", "30,-40,2.1", 1)}


def test_what_is_wrong_in_files_is_listed_and_where_it_can_be_put_right(
    desk: Desk, tmp_path: Path, drawing: Drawing
) -> None:
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept', WRONG)}")
    finally_says(page, "This campaign cannot be analysed yet. What is wrong in its files:")
    lines = page.outline()
    assert len(lines) == 7
    assert lines[5].startswith("error out_of_range: penetration.csv, row 3, column load_N (experiment 1): found '-40'")
    assert lines[6] == "Put the files right and import them again. Single cells can be put right under Correct."
    assert [each.tag for each in page.of() if "errors" in each.classes] == ["ul"]
    answer = desk.get(f"/report/{report_key(page)}/report.html")
    assert answer.status_code == 404
    assert "<h1>No report yet</h1><p>This campaign cannot be analysed yet. " in answer.text
    assert "-40" in answer.text
    assert desk.get(f"/report/{report_key(page)}/analysis.zip").text == answer.text
    assert drawing.asked == [("ready",)]


def test_a_campaign_that_has_nothing_yet_says_so(desk: Desk, drawing: Drawing) -> None:
    id_ = Journals(desk.lab.store).begin(TOML)
    page = desk.open(f"/analysis/entry/{id_}")
    page.until(lambda: status(page) != "Computing …")
    refusal = numbers_of(FilesInMemory({"campaign.toml": TOML.encode()}), Choice())
    assert isinstance(refusal, Refusal)
    (wrong,) = refusal.errors
    assert page.outline() == [
        "h1 Analysis",
        f"link Enter tests -> /enter/{id_}",
        f"link Open the report -> /report/{report_key(page)}/report.html",
        "link Download everything -> #",
        f"link Export the campaign -> /export/entry/{id_}.zip",
        "[status] This campaign cannot be analysed yet. What is wrong in its files:",
        wrong,
    ]
    assert drawing.asked == [("ready",)]


def test_report_and_zip_are_of_what_is_chosen(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    finally_says(page, COUNTED)
    key = report_key(page)
    for _ in range(2):
        answer = desk.get(f"/report/{key}/report.html", "de")
        assert (answer.status_code, answer.text) == (200, "[True, True, True, False, False]")
    policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; frame-ancestors 'none'; sandbox"
    assert answer.headers["content-security-policy"] == policy
    packed = desk.get(f"/report/{key}/analysis.zip")
    assert packed.headers["content-type"] == "application/zip"
    assert packed.headers["content-disposition"] == 'attachment; filename="analysis.zip"'
    with zipfile.ZipFile(io.BytesIO(packed.content)) as archive:
        assert sorted(archive.namelist()) == [
            "analysis/figures/one.svg", "analysis/report.html", "analysis/results.json",
            "campaign/campaign.toml", "campaign/penetration.csv", "campaign/shear.csv",
        ]  # fmt: skip
        assert archive.read("campaign/shear.csv").decode() == SHEAR
    assert [language for _, language in drawing.reports] == ["de", "en"]
    names = {name for name, _ in drawing.reports}
    assert {name[-3:] for name in names} == {"-de", "-en"} and {name[:7] for name in names} == {"report-"}
    opened(page, "Included experiments")
    page.fill("Penetration 1, A, 30°", False)
    finally_says(page, COUNTED.replace("3 used; 3", "2 used; 3"))
    assert desk.get(f"/report/{key}/report.html").text == "[False, True, True, False, False]"
    assert len({name for name, _ in drawing.reports}) == 3


def test_a_report_waits_for_the_numbers_of_the_choice(
    desk: Desk, tmp_path: Path, drawing: Drawing, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked, report_of = threading.Event(), page_module._report

    async def report(*what: Any) -> Path | None:
        asked.set()
        return await report_of(*what)

    def late(*what: Any) -> Any:
        assert asked.wait(60)
        return numbers_of(*what)

    monkeypatch.setattr(page_module, "_report", report)
    monkeypatch.setattr(analyses_module, "numbers_of", late)
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    path = f"/report/{report_key(page)}/report.html"
    assert desk.get(path).text == "[True, True, True, False, False]"
    finally_says(page, COUNTED)
    opened(page, "Included experiments")
    asked.clear()
    page.fill("Penetration 2, A, 30°", False)
    finally_says(page, "Computing …")
    with ThreadPoolExecutor(1) as beside:
        assert beside.submit(desk.get, path).result(60).text == "[True, False, True, False, False]"
    assert drawing.asked


@pytest.mark.parametrize("file", ["report.html", "analysis.zip"])
def test_a_page_that_is_closed_has_no_report(desk: Desk, tmp_path: Path, drawing: Drawing, file: str) -> None:
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    finally_says(page, COUNTED)
    path = f"/report/{report_key(page)}/{file}"
    assert desk.get(path).status_code == 200
    desk.do(page.client.delete)
    for each in (path, f"/report/nothing/{file}"):
        answer = desk.get(each)
        assert answer.status_code == 404
        assert "<h1>No such report</h1><p>Open the analysis of the campaign again.</p>" in answer.text
    assert drawing.asked


def test_report_and_zip_are_asked_for_after_what_was_chosen(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    finally_says(page, COUNTED)
    key, links = report_key(page), {each.text: each for each in page.of(ui.link)}
    assert links["Open the report"].props["target"] == "_blank"
    page.fire(links["Open the report"], "click.prevent", {})
    page.until(lambda: page.scripts[-1] == f"open {{'path': '/report/{key}/report.html', 'new_tab': True}}")
    page.fire(links["Download everything"], "click.prevent", {})
    page.told(f"/report/{key}/analysis.zip")
    assert page.scripts[-1].startswith("download ")
    assert drawing.asked


@pytest.mark.parametrize(
    ("path", "told"),
    [
        ("/analysis/kept/ffffffffffff", "ffffffffffff"),
        ("/analysis/entry/ffffffffffff", "The store has no campaign with the id"),
        ("/analysis/kept/..x", "This address names no campaign; the list of campaigns names all."),
    ],
)
def test_there_is_no_analysis_of_what_the_store_has_not(desk: Desk, path: str, told: str) -> None:
    answer = desk.get(path)
    assert answer.status_code == 404
    assert told in answer.text
    assert "This page cannot be shown" in answer.text
    assert [type(failure) for failure in desk.failures] == [StoreError]
    desk.failures.clear()


class View:
    """The view of a page, driven by hand."""

    def __init__(self, desk: Desk, kind: str, id_: str, analyses: Any = None) -> None:
        self.desk, self.sheet = desk, desk.open("/replay")
        self.page = OpenAnalysis(kind, id_, None)
        self._analyses = analyses or Analyses(desk.lab, Worker())
        self.before = len(self.sheet.outline())
        self.view: AnalysisView = desk.do(self._made, self.sheet.client)

    def _made(self) -> AnalysisView:
        with self.sheet.content:
            return AnalysisView(self.page, self._analyses)

    def compute(self) -> None:
        self.desk.wait(self.view.compute())

    @property
    def lines(self) -> list[str]:
        return self.sheet.outline()[self.before :]


def test_a_page_that_is_closed_shows_nothing_any_more(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    view = View(desk, "kept", kept(desk, tmp_path / "kept"))
    assert (view.page.closed, view.page.settled.is_set(), view.page.refused) == (False, False, "")
    view.page.closed = True
    view.compute()
    assert view.lines == ["[status] Computing …"]
    assert (view.page.settled.is_set(), drawing.asked) == (False, [])


def test_what_went_wrong_is_said_and_settled(desk: Desk, drawing: Drawing) -> None:
    view = View(desk, "kept", "ffffffffffff")
    view.compute()
    assert view.lines == [f"[status] {view.page.refused}"]
    assert "ffffffffffff" in view.page.refused
    assert view.page.settled.is_set()
    late = View(desk, "kept", "ffffffffffff")
    late.page.closed = True
    late.compute()
    assert (late.page.refused, late.page.settled.is_set(), late.lines) == ("", False, ["[status] Computing …"])
    assert drawing.asked == []


def test_a_refusal_takes_away_what_was_shown_before(
    desk: Desk, tmp_path: Path, drawing: Drawing, monkeypatch: pytest.MonkeyPatch
) -> None:
    view = View(desk, "entry", kept(desk, tmp_path / "kept"))
    view.page.kind = "kept"
    view.compute()
    assert view.lines[0] == f"[status] {COUNTED}"
    assert view.page.analysed is not None
    assert view.page.settled.is_set()
    shown, view.page.kind = view.lines, "entry"
    view.compute()  # nothing is different
    assert view.lines == shown
    told = Refusal("it is so", ("a.csv, row 2: wrong",))
    monkeypatch.setattr(analyses_module, "numbers_of", lambda *_: told)
    view.page.choice = Choice(frozenset())
    view.compute()
    wrong = "[status] This campaign cannot be analysed yet. What is wrong in its files:"
    chooser = ["h2 Included data", "Exclude experiments with these quality flags", "Included experiments"]
    assert view.lines == [wrong, "a.csv, row 2: wrong", *chooser]
    assert view.page.refused == "This campaign cannot be analysed yet. it is so"
    assert vars(view.page)["analysed"] is None
    monkeypatch.setattr(analyses_module, "numbers_of", lambda *_: Refusal("it is so"))
    view.compute()
    assert view.lines == ["[status] This campaign cannot be analysed yet. it is so", *chooser]
    view.view.show_known()
    assert view.lines[1:] == chooser
    view.page.choice = Choice()
    view.view.show_known()
    assert view.lines[:2] == [f"[status] {COUNTED} Drawing the figures …", "h2 Desk"]
    assert view.lines.count("h2 Included data") == 1
    assert drawing.asked


def test_a_page_without_a_campaign_in_memory_shows_nothing_at_first(desk: Desk) -> None:
    view = View(desk, "kept", "ffffffffffff")
    view.view.show_known()
    assert view.lines == ["[status] Computing …"]


def looked_at(desk: Desk, analyses: Analyses, *campaigns: tuple[str, str]) -> list[CampaignSource]:
    async def done() -> list[CampaignSource]:
        return [await analyses.subject(*each) for each in campaigns]

    return desk.wait(done())


def test_the_campaigns_that_were_looked_at_last_are_known(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(analyses_module, "MOST_CAMPAIGNS", 2)
    analyses, journals = Analyses(desk.lab, Worker()), Journals(desk.lab.store)
    first, second = (("entry", journals.begin(TOML)) for _ in range(2))
    third = ("kept", kept(desk, tmp_path / "kept"))
    one, two, again, three = looked_at(desk, analyses, first, second, first, third)
    assert one is again
    assert analyses.known(*first) is one
    assert analyses.known(*second) is None
    assert analyses.known(*third) is three
    assert two is not one
    with pytest.raises(StoreError) as found:
        analyses.known("entry", "ffffffffffff")
    told = "The store has no campaign with the id 'ffffffffffff'; the list of campaigns names all."
    assert str(found.value) == told
    assert set(three.files.contents) == set(FILES)
    assert set(one.files.contents) == {"campaign.toml"}


def test_the_choices_that_were_made_last_are_known(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(analyses_module, "MOST_CHOICES", 2)
    subject = CampaignSource(desk.lab, "kept", kept(desk, tmp_path / "kept"))
    choices = [Choice(left_out=frozenset({("penetration.csv", name)})) for name in "123"]

    async def done() -> list[Any]:
        return [await subject.analysed(each) for each in (*choices, choices[2])]

    found = desk.wait(done())
    assert [subject.known(each) for each in choices] == [None, *found[1:3]]
    assert found[3] is found[2]
    assert len({each.key for each in found}) == 3
    assert {len(each.key) for each in found} == {16}


def test_a_lab_that_is_about_to_end_says_so(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    id_ = kept(desk, tmp_path / "kept")
    subject, analyses = CampaignSource(desk.lab, "kept", id_), Analyses(desk.lab, Worker())

    async def nothing(*_: Any) -> None:
        return None

    monkeypatch.setattr("skisnow.web.analyses.run.io_bound", nothing)
    assert desk.wait(subject.analysed(Choice())) == Refusal("The lab is about to end.")
    with pytest.raises(StoreError, match=r"^The lab is about to end\.$"):
        desk.wait(analyses.subject("kept", id_))


def numbers(choice: Choice, files: dict[str, str] | None = None) -> Numbers:
    found = numbers_of(FilesInMemory({name: text.encode() for name, text in (files or FILES).items()}), choice)
    assert isinstance(found, Numbers)
    return found


def flags(found: Numbers, kind: str = "penetration") -> dict[str, list[str]]:
    return {row["experiment"]: row["flags"] for row in found.results[kind]["experiments"]}


def test_what_always_excludes_goes_with_every_choice() -> None:
    assert numbers(Choice()).excluding == frozenset(
        {"zero_depth", "cancelled", "too_few_loads", "loads_not_rising", "depth_shrinks"}
    )
    found = numbers(Choice(frozenset({"layered"})))
    assert found.excluding == frozenset({"zero_depth", "cancelled", "layered"})
    assert [row["used"] for row in found.results["penetration"]["experiments"]] == [True] * 4 + [False]
    assert list(FLAGS) == [code for code in FLAGS if code not in ("zero_depth", "cancelled")]
    assert FLAGS["too_few_loads"] == "The series has fewer than 3 load steps."


def test_what_is_left_out_is_that_of_its_file_and_keeps_its_reason() -> None:
    found = numbers(Choice(left_out=frozenset({("penetration.csv", "1"), ("penetration.csv", "5")})))
    assert flags(found) == {"1": ["cancelled"], "2": [], "3": [], "4": ["too_few_loads"], "5": ["cancelled"]}
    assert flags(found, "shear") == {"a": [], "1": [], "c": []}
    reasons = found.analysis.campaign.penetration
    assert reasons is not None
    assert reasons.cancelled == ("left out by choice in the lab", "", "", "", "slipped")
    sheared = numbers(Choice(left_out=frozenset({("shear.csv", "1")})))
    assert flags(sheared, "shear") == {"a": [], "1": ["cancelled"], "c": []}
    assert flags(sheared)["1"] == []


def test_tables_are_those_of_the_page_that_have_rows() -> None:
    found = numbers(Choice())
    assert list(found.tables) == ["sites", "regressions", "penetration_experiments", "shear_experiments"]
    alone = numbers(Choice(), {"campaign.toml": TOML, "penetration.csv": PENETRATION})
    assert list(alone.tables) == ["sites", "regressions", "penetration_experiments"]
    assert {"Desk", "A", "blade", "ski piece"} <= found.names


def test_only_errors_are_listed_in_a_refusal() -> None:
    """A mark of quality beside them is no error."""
    files = {name: text.encode() for name, text in WRONG.items()}
    found = numbers_of(FilesInMemory(files), Choice())
    assert isinstance(found, Refusal)
    assert len(found.errors) == 1
    assert "-40" in found.errors[0]
    assert "-40" in found.said


def test_a_campaign_without_tests_is_refused_without_a_list(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(_: Any) -> None:
        raise ParameterError("there is nothing to analyse")

    monkeypatch.setattr(analysing, "analyse", refused)
    files = FilesInMemory({name: text.encode() for name, text in FILES.items()})
    assert numbers_of(files, Choice()) == Refusal("there is nothing to analyse")
    monkeypatch.setattr(analysing, "analyse", refused_in_words)
    assert numbers_of(files, Choice()) == Refusal("it is so")


def refused_in_words(_: Any) -> None:
    raise FieldDataError(["it is so"])


def test_the_report_of_the_page_is_that_of_the_library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    given: list[Any] = []
    monkeypatch.setattr(analysing, "write_report", lambda *what, **named: given.append((what, named)))
    found = numbers(Choice())
    analysing.write_whole_report(found.analysis, str(tmp_path), "de")
    assert given == [((found.analysis, tmp_path), {"language": "de"})]


def test_a_figure_has_its_images_and_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(analysing, "svgs_of", lambda drawn: [b"<svg>", drawn.name.encode()])
    monkeypatch.setattr(analysing, "data_uri", lambda svg: svg.decode())
    analysis = numbers(Choice()).analysis
    number = [drawer.__name__ for drawer in DRAWERS].index("force_depth")
    found = figure(analysis, number, "en")
    assert found is not None
    assert (found.name, found.image, found.narrow) == ("fig05_force_depth", "<svg>", "fig05_force_depth")
    assert found.alt and found.caption.startswith("Load against penetration depth")


def test_the_worker_does_one_thing_after_another_in_a_process_of_its_own(desk: Desk) -> None:
    worker = Worker()
    worker.end()  # nothing was begun

    async def done() -> tuple[int, tuple[int, int], int]:
        return await worker.do(os.getpid), await worker.do(divmod, 7, 2), await worker.do(os.getpid)

    try:
        process, halves, again = desk.wait(done())
    finally:
        worker.end()
    assert halves == (3, 1)
    assert process == again != os.getpid()
    with pytest.raises(RuntimeError):
        desk.wait(done())


def test_two_analyses_of_the_same_numbers_are_two() -> None:
    found = numbers(Choice())
    assert Analysed("a", found) != Analysed("a", found)
