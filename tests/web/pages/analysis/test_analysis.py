"""Analyses: their page and the list of them."""

import asyncio
import io
import os
import re
import threading
import zipfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from nicegui import ui

from skisnow._support.errors import StoreError
from skisnow.campaign import read_campaign
from skisnow.campaign.reading.campaign_files import FilesInMemory
from skisnow.campaign.store import Journals, NewEntry
from skisnow.estimation import analyse
from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.key_results import key_results
from skisnow.report.campaign.verdicts import verdicts
from skisnow.web import campaign_analysis as analyses_module
from skisnow.web.campaign_analysis import (
    AnalysisCache,
    CampaignSource,
    Choice,
    FigureImage,
    Numbers,
    Refusal,
    analyse_files,
    choosable_flags,
)
from skisnow.web.pages import analysis as page_module
from skisnow.web.uploads import Worker
from tests.coded import raises

from ...campaign_texts import HARD, SHEARED, SOFT, pressed, sheared
from ..desk import Desk, Sheet

TOML = SHEARED
PENETRATION = pressed(
    {"1": ("A", SOFT), "2": ("A", SOFT), "3": ("B", HARD), "4": ("B", HARD[:2]), "5": ("A", SOFT)}, {"5": "slipped"}
)  # 4 has fewer than three loads
SHEAR = sheared({"a": ("A", 20), "1": ("A", 21), "c": ("B", 30)})
FILES = {"campaign.toml": TOML, "penetration.csv": PENETRATION, "shear.csv": SHEAR}
FLAGS = choosable_flags()
COUNTED = "5 penetration experiments (3 used), 3 shear experiments (3 used), 2 sites."


@dataclass
class Drawing:
    """Do the work of the other process in this one; figures wait for the gate."""

    gate: asyncio.Event = field(default_factory=asyncio.Event)
    asked: list[Any] = field(default_factory=list)
    reports: list[Any] = field(default_factory=list)
    done: int = 0
    """Figures that are there."""
    held: int = 0
    """Only figures of so many points wait; 0: all."""


def points(analysis: Any) -> int:
    return sum(row["used"] for row in analysis.results["penetration"]["experiments"])


def kept(desk: Desk, folder: Path, files: dict[str, str] | None = None) -> str:
    """The id of a kept campaign that no other test has: what was analysed stays in memory."""
    texts = files or FILES
    return desk.kept(folder, texts | {"campaign.toml": f"{texts['campaign.toml']}# {folder}\n"})


def status(page: Sheet) -> str:
    return next(line for line in page.outline() if line.startswith("[status] "))[9:]


WRONG = {"campaign.toml": TOML, "penetration.csv": PENETRATION.replace("30,40,2.1", "30,-40,2.1", 1)}


@pytest.fixture
def drawing(monkeypatch: pytest.MonkeyPatch) -> Drawing:
    """The gate is open at first. Of three figures the second has no data; the third is wide."""
    made = Drawing()
    made.gate.set()

    def drawn(analysis: Any, number: int, _language: str) -> FigureImage | None:
        if number == 1:
            return None
        return FigureImage(
            f"fig{number}", f"{points(analysis)} points", f"<b>Figure {number}.</b> A", f"data:{number}", number == 2
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

INCLUDED = "Included experiments"


def used(report: str) -> str:
    """T for each experiment that the written report uses, F for the others."""
    return re.sub("[^TF]", "", report)


def opened(page: Sheet, words: str) -> None:
    """Open what stands behind these words."""
    (found,) = (
        each
        for each in page.tagged("details")
        if words in [word.text for word in each.descendants() if isinstance(word, ui.label)]
    )
    page.fire(found, "toggle", {})


def finally_says(page: Sheet, words: str) -> None:
    page.until(lambda: status(page) == words)


def figures(page: Sheet) -> list[tuple[str, str]]:
    """Address and words of each image."""
    return [(each.props["src"], each.props["alt"]) for each in page.tagged("img")]


def report_key(page: Sheet) -> str:
    return page.shows("link Open the report").split("/")[2]


def test_numbers_tables_and_figures_are_in_their_order(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    desk.do(drawing.gate.clear)
    id_ = kept(desk, tmp_path / "kept")
    page = desk.open(f"/analysis/kept/{id_}")
    key = report_key(page)
    finally_says(page, f"{COUNTED} Drawing the figures …")
    lines = page.outline()
    theirs = analyse(read_campaign(tmp_path / "kept"))
    assert page.link("Export the campaign") == f"/export/kept/{id_}.zip"
    page.link("Open the report")
    assert len(key) == 16
    results = [each.content for each in page.of(ui.html)]
    assert results[:2] == [str(each) for each in key_results(ReportData(theirs))]
    assert "A <strong>0.0512</strong> N/mm³" in results[0]
    compared = list(map(str, verdicts(theirs.results)))
    assert len(compared) == 2
    assert lines[6:8] == compared
    assert lines[10] == f"[quiet] {theirs.results['penetration']['warnings'][0]}"
    assert [line.split(".")[0] for line in lines if line.startswith("html Table")] == ["html Table 1", "html Table 2"]
    page.shows(INCLUDED)
    assert [each.props["aria-label"] for each in page.tagged("section")] == [
        "Key results", "Included data", "Tables", "Figures",
    ]  # fmt: skip
    assert [(each.tag, len(each.default_slot.children)) for each in page.of() if "results" in each.classes] == [
        ("ul", 4)
    ]
    desk.do(drawing.gate.set)
    finally_says(page, COUNTED)
    assert page.between("h2 Figures") == ["h2 Figures", "html Figure 0. A", "html Figure 2. A"]
    assert figures(page) == [("data:0", "3 points"), ("data:2", "3 points")]
    assert [box.props["aria-label"] for box in page.of() if "scroll" in box.classes] == ["3 points"]
    tags = [element.tag for element in page.of() if element.tag in ("figure", "figcaption")]
    assert tags == ["figure", "figcaption"] * 2
    assert [each for each in drawing.asked if each[0] == "drawn"] == [("drawn", number, "en") for number in range(3)]
    assert [each[0] for each in drawing.asked].count("load_drawing") == 1
    assert [each.text for each in page.of() if each.props.get("aria-current") == "page"] == ["Campaigns"]


def test_cached_results_are_on_the_page_at_once(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
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
    assert drawing.asked[asked:] == [("load_drawing",)]
    german = desk.open(f"/analysis/kept/{id_}", "de")
    desk.do(drawing.gate.set)
    german.until(lambda: figures(german))
    german.until(lambda: len(figures(german)) == 2)
    finally_says(german, "5 Eindringversuche (3 verwendet), 3 Scherversuche (3 verwendet), 2 Messorte.")
    assert drawing.asked[-3:] == [("drawn", number, "de") for number in range(3)]
    assert report_key(page) != report_key(again)


def test_an_experiment_that_is_left_out_stays_in_the_tables(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    finally_says(page, COUNTED)
    opened(page, INCLUDED)
    at = page.outline().index(INCLUDED)
    assert page.outline()[at + 1 : at + 9] == EXPERIMENTS
    assert [each.enabled for each in page.of(ui.checkbox)] == [True] * 4 + [False] + [True] * 3
    page.fill("Penetration 1, A, 30°", False)
    finally_says(page, "5 penetration experiments (2 used), 3 shear experiments (3 used), 2 sites.")
    assert figures(page) == [("data:0", "2 points"), ("data:2", "2 points")]
    page.fill("Shear 1, A, 90°", False)
    finally_says(page, "5 penetration experiments (2 used), 3 shear experiments (2 used), 2 sites.")
    page.fill("Penetration 1, A, 30°", True)
    finally_says(page, "5 penetration experiments (3 used), 3 shear experiments (2 used), 2 sites.")
    asked = len(drawing.asked)
    page.fill("Shear 1, A, 90°", True)
    finally_says(page, COUNTED)
    assert len(drawing.asked) == asked  # as at first
    at = page.outline().index(INCLUDED)
    assert page.outline()[at + 1 : at + 9] == EXPERIMENTS


def test_a_choice_made_during_the_computation_is_shown(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    """The first figure of the first choice comes after all of the second."""
    desk.do(drawing.gate.clear)
    drawing.held = 3
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    finally_says(page, f"{COUNTED} Drawing the figures …")
    opened(page, INCLUDED)
    page.fill("Penetration 1, A, 30°", False)
    fewer = COUNTED.replace("3 used", "2 used", 1)
    finally_says(page, fewer)
    shown = page.outline()
    desk.do(drawing.gate.set)
    page.until(lambda: drawing.done == 4)
    assert page.outline() == shown
    assert figures(page) == [("data:0", "2 points"), ("data:2", "2 points")]


def test_errors_in_files_are_listed_with_where_to_correct_them(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept', WRONG)}")
    page.until(lambda: status(page) != "Computing …")
    lines = page.outline()
    assert sum("-40" in line and "penetration.csv, row 3" in line for line in lines) == 1
    assert [each.tag for each in page.of() if "errors" in each.classes] == ["ul"]
    answer = desk.get(f"/report/{report_key(page)}/report.html")
    assert answer.status_code == 404
    assert "-40" in answer.text
    assert desk.get(f"/report/{report_key(page)}/analysis.zip").text == answer.text
    assert drawing.asked == [("load_drawing",)]


def test_report_and_zip_are_of_what_is_chosen(desk: Desk, tmp_path: Path, drawing: Drawing) -> None:
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    finally_says(page, COUNTED)
    key = report_key(page)
    for _ in range(2):
        answer = desk.get(f"/report/{key}/report.html", "de")
        assert (answer.status_code, used(answer.text)) == (200, "TTTFF")
    assert "sandbox" in answer.headers["content-security-policy"]
    packed = desk.get(f"/report/{key}/analysis.zip")
    assert packed.headers["content-type"] == "application/zip"
    assert "analysis.zip" in packed.headers["content-disposition"]
    with zipfile.ZipFile(io.BytesIO(packed.content)) as archive:
        assert {name.split("/")[0] for name in archive.namelist()} == {"analysis", "campaign"}
        assert "analysis/report.html" in archive.namelist()
        assert archive.read("campaign/shear.csv").decode() == SHEAR
    assert [language for _, language in drawing.reports] == ["de", "en"]
    names = {name for name, _ in drawing.reports}
    assert {name[-3:] for name in names} == {"-de", "-en"} and {name[:7] for name in names} == {"report-"}
    opened(page, INCLUDED)
    page.fill("Penetration 1, A, 30°", False)
    finally_says(page, COUNTED.replace("3 used", "2 used", 1))
    assert used(desk.get(f"/report/{key}/report.html").text) == "FTTFF"
    assert len({name for name, _ in drawing.reports}) == 3


def test_numbers_come_first(desk: Desk, tmp_path: Path, drawing: Drawing, monkeypatch: pytest.MonkeyPatch) -> None:
    asked, report_of = threading.Event(), page_module._report

    async def report(*what: Any) -> Path | None:
        asked.set()
        return await report_of(*what)

    def late(*what: Any) -> Any:
        assert asked.wait(300)
        return analyse_files(*what)

    monkeypatch.setattr(page_module, "_report", report)
    monkeypatch.setattr(analyses_module, "analyse_files", late)
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    path = f"/report/{report_key(page)}/report.html"
    assert used(desk.get(path).text) == "TTTFF"
    finally_says(page, COUNTED)
    opened(page, INCLUDED)
    asked.clear()
    page.fill("Penetration 2, A, 30°", False)
    finally_says(page, "Computing …")
    with ThreadPoolExecutor(1) as beside:
        assert used(beside.submit(desk.get, path).result(60).text) == "TFTFF"
    assert drawing.asked


def test_numbers_are_on_the_page_at_once_until_something_is_entered(desk: Desk, drawing: Drawing) -> None:
    journals, last = Journals(desk.lab.store), 0
    id_ = journals.begin(TOML)
    head = {"experiment": "1", "site": "A", "tool": "ski piece", "edge_angle_deg": "30"}
    for position, (load, depth) in enumerate((("20", "1.5"), ("40", "2.15"), ("60", "2.6"))):
        cells = {**head, "load_N": load, "depth_mm": depth}
        row = NewEntry(action="add", file="penetration.csv", test="1", position=position, cells=cells)
        last = journals.append(id_, row, seen=last).sequence
    finally_says(desk.open(f"/analysis/entry/{id_}"), "1 penetration experiment (1 used), 1 site.")
    html = desk.open(f"/analysis/entry/{id_}").html
    assert "1 penetration experiment (1 used)" in html and f"/enter/{id_}" in html
    cancelled = NewEntry(action="cancel", file="penetration.csv", test="1", why="the tool slipped")
    journals.append(id_, cancelled, seen=last)
    page = desk.open(f"/analysis/entry/{id_}")
    assert "1 penetration experiment" not in page.html
    finally_says(page, "1 penetration experiment (0 used), 1 site.")
    assert drawing.asked


@pytest.mark.parametrize("file", ["report.html", "analysis.zip"])
def test_a_page_that_is_closed_has_no_report(desk: Desk, tmp_path: Path, drawing: Drawing, file: str) -> None:
    page = desk.open(f"/analysis/kept/{kept(desk, tmp_path / 'kept')}")
    finally_says(page, COUNTED)
    path = f"/report/{report_key(page)}/{file}"
    assert desk.get(path).status_code == 200
    desk.do(page.client.delete)
    for each in (path, f"/report/nothing/{file}"):
        assert desk.get(each).status_code == 404
    assert drawing.asked


@pytest.mark.parametrize(
    ("path", "code"),
    [
        ("/analysis/kept/ffffffffffff", "unknown_id"),
        ("/analysis/entry/ffffffffffff", "unknown_campaign"),
        ("/analysis/kept/..x", "no_campaign"),
    ],
)
def test_there_is_no_analysis_of_what_the_store_has_not(desk: Desk, path: str, code: str) -> None:
    assert (desk.get(path).status_code, desk.code) == (404, code)
    assert [type(failure) for failure in desk.failures] == [StoreError]
    desk.failures.clear()


def looked_at(desk: Desk, analyses: AnalysisCache, *campaigns: tuple[str, str]) -> list[CampaignSource]:
    async def done() -> list[CampaignSource]:
        return [await analyses.subject(*each) for each in campaigns]

    return desk.wait(done())


def test_the_last_campaigns_are_kept_in_memory(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(analyses_module, "MOST_CAMPAIGNS", 2)
    analyses, journals = AnalysisCache(desk.lab, Worker()), Journals(desk.lab.store)
    first, second = (("entry", journals.begin(TOML)) for _ in range(2))
    third = ("kept", kept(desk, tmp_path / "kept"))
    one, two, again, three = looked_at(desk, analyses, first, second, first, third)
    assert one is again
    assert analyses.cached(*first) is one
    assert analyses.cached(*second) is None
    assert analyses.cached(*third) is three
    assert two is not one
    with raises(StoreError, "unknown_campaign"):
        analyses.cached("entry", "ffffffffffff")
    assert set(three.files.contents) == set(FILES)
    assert set(one.files.contents) == {"campaign.toml"}


def test_a_lab_that_is_about_to_end_says_so(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    id_ = kept(desk, tmp_path / "kept")
    subject, analyses = CampaignSource(desk.lab, "kept", id_), AnalysisCache(desk.lab, Worker())

    async def nothing(*_: Any) -> None:
        return None

    monkeypatch.setattr("skisnow.web.campaign_analysis.run.io_bound", nothing)
    assert isinstance(desk.wait(subject.analysed(Choice())), Refusal)
    with raises(StoreError, "lab_ends"):
        desk.wait(analyses.subject("kept", id_))


def numbers(choice: Choice, files: dict[str, str] | None = None) -> Numbers:
    found = analyse_files(FilesInMemory({name: text.encode() for name, text in (files or FILES).items()}), choice)
    assert isinstance(found, Numbers)
    return found


def flags(found: Numbers, kind: str = "penetration") -> dict[str, list[str]]:
    return {row["experiment"]: row["flags"] for row in found.analysis.results[kind]["experiments"]}


def test_what_always_excludes_goes_with_every_choice() -> None:
    assert numbers(Choice()).analysis.campaign.excluding == frozenset(
        {"zero_depth", "cancelled", "too_few_loads", "loads_not_rising", "depth_shrinks"}
    )
    found = numbers(Choice(frozenset({"layered"})))
    assert found.analysis.campaign.excluding == frozenset({"zero_depth", "cancelled", "layered"})
    assert [row["used"] for row in found.analysis.results["penetration"]["experiments"]] == [True] * 4 + [False]
    assert list(FLAGS) == [code for code in FLAGS if code not in ("zero_depth", "cancelled")]


def test_what_is_left_out_is_that_of_its_file_and_keeps_its_reason() -> None:
    found = numbers(Choice(left_out=frozenset({("penetration.csv", "1"), ("penetration.csv", "5")})))
    assert flags(found) == {"1": ["cancelled"], "2": [], "3": [], "4": ["too_few_loads"], "5": ["cancelled"]}
    assert flags(found, "shear") == {"a": [], "1": [], "c": []}
    reasons = found.analysis.campaign.penetration
    assert reasons is not None
    assert [bool(each) for each in reasons.cancelled] == [True, False, False, False, True]
    sheared = numbers(Choice(left_out=frozenset({("shear.csv", "1")})))
    assert flags(sheared, "shear") == {"a": [], "1": ["cancelled"], "c": []}
    assert flags(sheared)["1"] == []


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
