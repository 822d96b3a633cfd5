"""The view of an analysis without its page, what the lab keeps in memory, and what the other process does."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from skisnow._support.errors import StoreError
from skisnow.campaign.reading import FilesInMemory
from skisnow.campaign.store import Journals
from skisnow.web import campaign_analysis as analyses_module
from skisnow.web.analysis_view import AnalysisView, OpenAnalysis
from skisnow.web.campaign_analysis import AnalysisCache, CampaignSource, Choice, Numbers, Refusal, analyse_files
from skisnow.web.subprocesses import Worker
from tests.coded import raises

from .shared import COUNTED, FILES, FLAGS, TOML, WRONG, Drawing, kept

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


def test_only_errors_are_listed_in_a_refusal() -> None:
    """A mark of quality beside them is not an error."""
    files = {name: text.encode() for name, text in WRONG.items()}
    found = analyse_files(FilesInMemory(files), Choice())
    assert isinstance(found, Refusal)
    assert len(found.errors) == 1
    assert "-40" in found.errors[0]
    assert "-40" in found.said


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
