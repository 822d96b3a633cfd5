"""The view of an analysis without its page, what the lab keeps in memory, and what the other process does."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any
from unittest.mock import Mock

import pytest

from skisnow._support.errors import FieldDataError, ParameterError, StoreError
from skisnow.campaign.reading import FilesInMemory
from skisnow.campaign.store import Journals
from skisnow.report.campaign.page import DRAWERS
from skisnow.web import analysis_cache as analyses_module
from skisnow.web import campaign_analysis as analysing
from skisnow.web.analysis_cache import AnalysisCache, CachedAnalysis, CampaignSource
from skisnow.web.analysis_view import AnalysisView, OpenAnalysis
from skisnow.web.campaign_analysis import Choice, Numbers, Refusal, analyse_files, figure
from skisnow.web.subprocesses import Worker
from tests.coded import raises

from .shared import COUNTED, FILES, FLAGS, PENETRATION, TOML, WRONG, Drawing, kept

if TYPE_CHECKING:
    from ..desk import Desk


class View:
    """The view of a page, driven by hand."""

    def __init__(self, desk: Desk, kind: str, id_: str, analyses: Any = None) -> None:
        self.desk, self.sheet = desk, desk.open("/replay")
        self.page = OpenAnalysis(kind, id_, None)
        self._analyses = analyses or AnalysisCache(desk.lab, Worker())
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
    monkeypatch.setattr(analyses_module, "analyse_files", lambda *_: told)
    view.page.choice = Choice(frozenset())
    view.compute()
    assert view.lines[1] == "a.csv, row 2: wrong"
    assert view.page.refused.endswith(" it is so")
    assert vars(view.page)["analysed"] is None
    chooser = view.lines[2:]
    monkeypatch.setattr(analyses_module, "analyse_files", lambda *_: Refusal("it is so"))
    view.compute()
    assert view.lines == [f"[status] {view.page.refused}", *chooser]
    view.view.show_cached()
    assert view.lines[1:] == chooser
    view.page.choice = Choice()
    view.view.show_cached()
    assert view.lines[:2] == [f"[status] {COUNTED} Drawing the figures …", "h2 Desk"]
    assert view.lines.count("h2 Included data") == 1
    assert drawing.asked


def test_a_page_without_a_campaign_in_memory_shows_nothing_at_first(desk: Desk) -> None:
    view = View(desk, "kept", "ffffffffffff")
    view.view.show_cached()
    assert view.lines == ["[status] Computing …"]


def looked_at(desk: Desk, analyses: AnalysisCache, *campaigns: tuple[str, str]) -> list[CampaignSource]:
    async def done() -> list[CampaignSource]:
        return [await analyses.subject(*each) for each in campaigns]

    return desk.wait(done())


def test_the_campaigns_that_were_looked_at_last_are_known(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
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


def test_the_choices_that_were_made_last_are_known(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(analyses_module, "MOST_CHOICES", 2)
    subject = CampaignSource(desk.lab, "kept", kept(desk, tmp_path / "kept"))
    choices = [Choice(left_out=frozenset({("penetration.csv", name)})) for name in "123"]

    async def done() -> list[Any]:
        return [await subject.analysed(each) for each in (*choices, choices[2])]

    found = desk.wait(done())
    assert [subject.cached(each) for each in choices] == [None, *found[1:3]]
    assert found[3] is found[2]
    assert len({each.key for each in found}) == 3
    assert {len(each.key) for each in found} == {16}


def test_a_lab_that_is_about_to_end_says_so(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    id_ = kept(desk, tmp_path / "kept")
    subject, analyses = CampaignSource(desk.lab, "kept", id_), AnalysisCache(desk.lab, Worker())

    async def nothing(*_: Any) -> None:
        return None

    monkeypatch.setattr("skisnow.web.analysis_cache.run.io_bound", nothing)
    assert isinstance(desk.wait(subject.analysed(Choice())), Refusal)
    with raises(StoreError, "lab_ends"):
        desk.wait(analyses.subject("kept", id_))


def numbers(choice: Choice, files: dict[str, str] | None = None) -> Numbers:
    found = analyse_files(FilesInMemory({name: text.encode() for name, text in (files or FILES).items()}), choice)
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


def test_tables_are_those_of_the_page_that_have_rows() -> None:
    found = numbers(Choice())
    assert list(found.tables["de"]) == ["sites", "regressions", "penetration_experiments", "shear_experiments"]
    alone = numbers(Choice(), {"campaign.toml": TOML, "penetration.csv": PENETRATION})
    assert list(alone.tables["en"]) == ["sites", "regressions", "penetration_experiments"]


def test_only_errors_are_listed_in_a_refusal() -> None:
    """A mark of quality beside them is not an error."""
    files = {name: text.encode() for name, text in WRONG.items()}
    found = analyse_files(FilesInMemory(files), Choice())
    assert isinstance(found, Refusal)
    assert len(found.errors) == 1
    assert "-40" in found.errors[0]
    assert "-40" in found.said


def test_a_campaign_without_tests_is_refused_without_a_list(monkeypatch: pytest.MonkeyPatch) -> None:
    files = FilesInMemory({name: text.encode() for name, text in FILES.items()})
    for error in (ParameterError("it is so"), FieldDataError(["it is so"])):
        monkeypatch.setattr(analysing, "analyse", Mock(side_effect=error))
        assert analyse_files(files, Choice()) == Refusal("it is so")


def test_the_report_of_the_page_is_that_of_the_library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    given: list[Any] = []
    monkeypatch.setattr(analysing, "write_report", lambda *what, **named: given.append((what, named)))
    found = numbers(Choice())
    analysing.write_whole_report(found.analysis, str(tmp_path), "de")
    assert given == [((found.analysis, tmp_path), {"language": "de"})]


def test_a_figure_has_its_images_and_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(analysing, "drawing_svg", lambda drawn: drawn.name)
    monkeypatch.setattr(analysing, "data_uri", str.upper)
    analysis = numbers(Choice()).analysis
    number = [drawer.__name__ for drawer in DRAWERS].index("force_depth")
    found = figure(analysis, number, "en")
    assert found is not None
    assert (found.name, found.image, found.wide) == ("fig05_force_depth", "FIG05_FORCE_DEPTH", False)
    assert found.alt and found.caption


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
    assert CachedAnalysis("a", found) != CachedAnalysis("a", found)
