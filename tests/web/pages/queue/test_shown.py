"""How long runs and studies take, and the cards of the queue."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from skisnow.web import job_list
from skisnow.web import studies as studies_module
from skisnow.web.runs import Job, duration_words, estimated_s, simulated_s, slowness
from skisnow.web.studies import Studies, StudyJob, estimate_words, measured_slowness, unit_s
from skisnow.web.study_fields import CARVE

from .shared import TURNS

if TYPE_CHECKING:
    from ..desk import Desk


def run(folder: Path, name: str, took: float, wall: float, simulated: float, method: str = "fast") -> Job:
    """A run that is done."""
    (folder / name).mkdir()
    summary = {"wall_s": wall, "simulated_s": simulated, "scenario": {"solver": {"method": method}}}
    (folder / name / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    return Job(name, "a", {}, "2026", state="done", took_s=took)


def test_how_long_a_run_takes_is_learned_from_the_last_five(tmp_path: Path) -> None:
    """12 s of computing for 5 s with the method; 3.2 s around each."""
    values = {"run.duration_s": 10.0, "solver.method": "fast"}
    assert estimated_s(tmp_path, [], values) == 18.0
    assert estimated_s(tmp_path, [], {}) is None
    told = [
        run(tmp_path, "a", 5.0, 4.0, 2.0),
        run(tmp_path, "b", 10.0, 8.0, 3.0),
        run(tmp_path, "c", 6.0, 2.0, 1.0, "default"),
        run(tmp_path, "d", 6.0, 2.0, 1.0, "default"),
        run(tmp_path, "e", 7.0, 2.0, 1.0, "default"),
        run(tmp_path, "f", 99.0, 2.0, 1.0),
    ]
    none = run(tmp_path, "g", 0.0, 50.0, 1.0)
    (tmp_path / "h").mkdir()
    damaged = []
    for number, text in enumerate(("{", "{}", '{"scenario": 1}', json.dumps({"scenario": {"solver": {"method": 1}}}))):
        damaged.append(replace(none, name=f"h{number}", took_s=1.0))
        (tmp_path / f"h{number}").mkdir()
        (tmp_path / f"h{number}" / "summary.json").write_text(text, encoding="utf-8")
    jobs = [none, *damaged, replace(none, name="nowhere", took_s=1.0), *told]
    assert slowness(tmp_path, jobs, "fast") == pytest.approx(12.0 / 5.0)
    assert slowness(tmp_path, jobs, "default") == pytest.approx(2.0)
    assert slowness(tmp_path, jobs, "accurate") == 1.0
    assert estimated_s(tmp_path, jobs, values) == pytest.approx(24.0 + (1 + 2 + 4 + 4 + 5) / 5)


@pytest.mark.parametrize(
    ("duration", "length", "speed", "ends"),
    [
        (5.0, None, 7.0, 5.0), (5.0, 14.0, 7.0, 2.0), (1.0, 14.0, 7.0, 1.0), (None, 14.0, 7.0, 2.0),
        (None, 14.0, 0.0, None), (None, None, 7.0, None), (0.0, 0.0, 7.0, None), ("5", "14", "7", 2.0),
        (float("inf"), 14.0, 7.0, 2.0), (float("nan"), None, None, None), (-0.5, None, None, None),
        (1e308, None, None, None), (5.0, 14.0, None, 5.0),
    ],
)  # fmt: skip
def test_a_run_ends_after_its_time_or_its_way(duration: Any, length: Any, speed: Any, ends: float | None) -> None:
    values = {"run.duration_s": duration, "run.length_m": length, "start.speed_m_per_s": speed}
    assert simulated_s(values) == ends
    assert unit_s("a", values) == (ends or 0.0)


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.0, "5 s"), (7.0, "5 s"), (8.0, "10 s"), (42.0, "40 s"), (89.9, "90 s"), (90.0, "2 min"), (600.0, "10 min"),
        (7100.0, "118 min"), (7139.0, "119 min"), (7200.0, "2 h"), (20_000.0, "6 h"),
    ],
)  # fmt: skip
def test_a_duration_is_said_as_exact_as_it_is_known(seconds: float, words: str) -> None:
    assert duration_words(seconds) == words


def study_done(**what: Any) -> StudyJob:
    usual: dict[str, Any] = {"state": "done", "took_s": 18.0, "points": 10, "workers": 2, "unit_s": 0.5}
    return StudyJob("a", CARVE, {}, "2026", **(usual | what))


def test_of_studies_the_last_five_of_a_kind_tell_how_long_they_take() -> None:
    assert measured_slowness([study_done()], "") == 4.0  # 10 s on two cores for 5 s
    assert measured_slowness([study_done(method="fast")], "fast") == 4.0
    assert measured_slowness([study_done(method="fast")], "") is None
    every = [study_done(took_s=8.0), study_done(state="failed"), study_done(workers=0), study_done(unit_s=0.0)]
    assert measured_slowness(every, "") is None
    assert measured_slowness([*every, *[study_done()] * 5, study_done(took_s=999.0)], "") == 4.0
    assert measured_slowness([*[study_done()] * 4, study_done(took_s=28.0)], "") == pytest.approx((4 * 20 + 40) / 25)
    assert measured_slowness([study_done(points=0)], "") is None


def test_how_long_a_study_takes_in_words(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(studies_module, "available_cores", lambda: 3)
    here, there = Studies(tmp_path), Studies(tmp_path, "tcp://a:1")
    assert unit_s(CARVE, {"run.duration_s": 5.0}) == 0.03
    jobs = [run(tmp_path, "before", 6.0, 6.0, 2.0, "")]

    def words(studies: Studies, unit: float, method: str = "") -> str:
        return estimate_words(studies, tmp_path, jobs, points=20, method=method, unit=unit)

    def numbers(text: str) -> list[str]:
        return re.findall(r"\d+", text)

    assert numbers(words(here, 0.0)) == ["20"]
    assert numbers(words(here, 5.0)) == ["20", "60"]  # 50 s and 8 s; runs tell nothing of a turn
    assert numbers(words(here, 5.0, "fast")) == ["20", "60"]
    assert "tcp://a:1" in words(there, 4.0)
    assert numbers(words(there, 4.0))[:2] == ["20", "80"]
    here._keep(study_done())
    assert numbers(words(here, 2.0)) == ["20", "90"]  # 4 times 40 s, and 8 s
    jobs[:] = [run(tmp_path, "of fast", 6.0, 6.0, 2.0, "fast")]
    assert numbers(words(here, 2.0, "fast")) == ["20", "70"]  # 3 times 40 s, and 8 s


def test_the_list_has_a_card_for_each_job_the_newest_first(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    timers = list[Any]()
    monkeypatch.setattr(f"{job_list.__name__}.ui.timer", lambda *what: timers.append(what))
    studies = Studies(desk.lab.runs)
    first = studies.ask_for(TURNS)
    page = desk.open("/study")
    ((interval, show),) = timers
    assert interval == 1.0
    (card,) = (each for each in page.of() if "card" in each.classes)
    second = studies.ask_for(TURNS)
    (desk.lab.runs / "studies" / "cd").mkdir()

    def anew() -> list[str]:
        desk.do(show, page.client)
        return [line.removeprefix("h3 ") for line in page.outline() if line.startswith("h3 2")]

    assert anew() == [second.name, first.name]
    assert card in list(page.of())
    third = studies.ask_for(TURNS)
    fourth = studies.ask_for(TURNS)
    assert anew() == [fourth.name, third.name, second.name, first.name]
    (desk.lab.runs / "studies" / second.name / "job.json").unlink()
    assert anew() == [fourth.name, third.name, first.name]
    for each in (first, third, fourth):
        (desk.lab.runs / "studies" / each.name / "job.json").unlink()
    assert anew() == []


def test_what_the_queue_refuses_is_told(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(f"{job_list.__name__}.ui.timer", lambda *_: None)
    studies = Studies(desk.lab.runs)
    job = studies.ask_for(TURNS)
    page = desk.open("/study")
    studies._keep(replace(job, state="done", said="so"))
    page.press(f"Cancel {job.name}")
    page.until(lambda: desk.code == "run_is_over")
    assert page.shows(" · done").endswith(" · done · so")
