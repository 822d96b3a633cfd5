"""Queues of runs and studies: their folders, their processes."""

import asyncio
import json
import re
import signal
import sys
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest

from skisnow._support.errors import ParameterError
from skisnow._support.processes.kept_rows import KeptRows
from skisnow.web import runs as runs_module
from skisnow.web import studies as studies_module
from skisnow.web import widgets
from skisnow.web.runs import Job, Runs, new_name
from skisnow.web.studies import Studies
from skisnow.web.study_fields import CARVE, Range, StudyQuestion
from tests.coded import raises

from ...finished import finished
from ..desk import Desk

SUMMARY = {"outcome": "left_course", "run_length_m": 46.04, "simulated_s": 5.126, "remedy": "Take less."}
TABLE = "edge_angle_deg,outcome,study\n10,equilibrium,a\n70,not_converged,a\n75,not_converged,a\n"
BUSY = "is being written by another run"


def acts(monkeypatch: pytest.MonkeyPatch, script: str) -> None:
    """Let the command be this script, whose arguments are what it is asked."""
    monkeypatch.setattr(runs_module, "COMMAND", (sys.executable, "-I", "-S", "-c", f"import sys, time, os\n{script}"))
    monkeypatch.setattr(runs_module, "_PAUSE_S", 0.001)


def says(*lines: str) -> str:
    return "".join(f"print({line!r}, file=sys.stderr, flush=True)\n" for line in lines)


def state(runs: Runs, name: str) -> Job:
    return next(job for job in runs.jobs() if job.name == name)


async def worked(runs: Runs, over: Any, during: Any = None) -> None:
    """Work through the queue until something holds; ``during`` is called meanwhile, until it gives something."""
    work = asyncio.ensure_future(runs.work())
    end = asyncio.get_running_loop().time() + 60.0
    while not over():
        assert not work.done() and asyncio.get_running_loop().time() < end
        if during is not None and during():
            during = None
        await asyncio.sleep(0.002)
    runs.end()
    await work


def is_over(runs: Runs) -> bool:
    return all(job.state not in ("waiting", "running") for job in runs.jobs())


def work_through(runs: Runs, during: Any = None) -> None:
    finished(worked(runs, lambda: is_over(runs), during))


def ended(queue: Runs, job: Job, last: str = "so", *, cancelled: bool = False) -> Job:
    return finished(queue._ended_as(job, last, cancelled=cancelled))


def test_the_name_of_a_folder_says_when_and_what_for() -> None:
    names = {new_name("a/b ä.c-1", datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)) for _ in range(3)}
    assert len(names) == 3
    assert all(re.fullmatch(r"2026-01-02-030405-a-b---c-1-[0-9a-f]{4}", name) for name in names)


def test_a_run_is_on_the_disk_as_it_was_asked(tmp_path: Path) -> None:
    runs = Runs(tmp_path)
    files = {"ski.file": ("ski/a.toml", b"text")}
    job = runs.ask("carved-46m", {"run.duration_s": "1"}, files=files, given="ski: a ü", language="de")
    place = tmp_path / job.name / "ski" / "a.toml"
    assert place.read_bytes() == b"text"
    kept = (tmp_path / job.name / "job.json").read_text(encoding="utf-8")
    assert json.loads(kept) == {
        "name": job.name, "scenario": "carved-46m", "changes": {"run.duration_s": "1", "ski.file": str(place)},
        "asked_at": job.asked_at, "state": "waiting", "said": "", "given": "ski: a ü", "language": "de",
        "title": "", "points": 0,
    }  # fmt: skip
    assert "ü" in kept and '\n "name": ' in kept
    assert datetime.fromisoformat(job.asked_at).tzinfo == UTC
    assert runs.jobs() == [job]
    assert Runs(tmp_path / "none").jobs() == []


def test_jobs_that_are_damaged_are_left_out(tmp_path: Path) -> None:
    runs = Runs(tmp_path)
    older, newer = (Job(name, "a", {}, when) for name, when in (("b", "2025"), ("a", "2026")))
    runs._keep(older)
    runs._keep(newer)
    for name, text in (("c", "{"), ("d", '{"unknown": 1}')):
        (tmp_path / name).mkdir()
        (tmp_path / name / "job.json").write_text(text, encoding="utf-8")
    assert runs.jobs() == [newer, older]


def test_the_queue_starts_the_oldest_and_reports_its_state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    acts(
        monkeypatch,
        "open(sys.argv[-1] + '/asked', 'a').write(repr(sys.argv[1:]) + os.environ['SKISNOW_PROGRESS_LINES'] + "
        "str(time.monotonic_ns()))\nprint('no word', flush=True)\n" + says("first", "  x" + "y" * 700 + "  "),
    )
    runs = Runs(tmp_path)
    first, second = runs.ask("a", {"b.c": "1"}, language="de"), runs.ask("d", {})
    runs._keep(replace(first, state="running"))  # the server ended meanwhile
    done = Job("e", "e", {}, "2026", state="done")
    runs._keep(done)
    work_through(runs)
    words = [(tmp_path / job.name / "asked").read_text(encoding="utf-8") for job in (first, second)]
    told = ["simulate", "a", "--set", "b.c=1", "--language", "de", "--out", str(tmp_path / first.name)]
    assert words[0].startswith(f"{told!r}1")
    assert int(words[0].rpartition("]1")[2]) < int(words[1].rpartition("]1")[2])
    for job in (first, second):
        assert state(runs, job.name) == replace(job, state="failed", said="y" * 600)
    assert state(runs, "e") == done
    assert (runs._process, runs._running, runs._cancelling, runs.progress) == (None, "", "", "")


def test_what_a_run_says_is_its_progress_until_it_is_cancelled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    acts(
        monkeypatch,
        "import signal\nsignal.signal(signal.SIGTERM, lambda *_: ("
        "print('late', file=sys.stderr, flush=True), os._exit(3)))\n" + says(" 1 s of 5 s ") + "time.sleep(60)\n",
    )
    runs, seen = Runs(tmp_path), list[str]()
    job = runs.ask("a", {})

    def during() -> bool:
        seen.append(runs.progress)
        if runs.progress != "1 s of 5 s":
            return False
        assert state(runs, job.name).state == "running"
        runs.cancel(job.name)
        seen.append(runs.progress)
        return True

    work_through(runs, during)
    assert set(seen[:-1]) <= {"", "starting", "1 s of 5 s", seen[-1]}
    assert seen[-1] not in ("", "starting", "1 s of 5 s")
    assert state(runs, job.name).state == "cancelled"
    with raises(ParameterError, "run_is_over"):
        runs.cancel(job.name)


def test_a_run_that_is_cancelled_before_its_process_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    acts(monkeypatch, "time.sleep(60)\n")
    runs = Runs(tmp_path)
    job = runs.ask("a", {})
    begin = asyncio.create_subprocess_exec

    async def late(*what: Any, **further: Any) -> Any:
        runs.cancel(job.name)
        assert runs.progress not in ("", "starting")
        return await begin(*what, **further)

    monkeypatch.setattr(asyncio, "create_subprocess_exec", late)
    work_through(runs)
    assert state(runs, job.name).state == "cancelled"


def test_a_server_that_ends_kills_the_run_which_stays_running(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    acts(monkeypatch, says("begun") + "time.sleep(20)\n")
    runs, seen = Runs(tmp_path), list[Any]()
    job = runs.ask("a", {})

    def begun() -> bool:
        seen[:] = [runs._process]
        return runs.progress == "begun"

    finished(worked(runs, begun))
    assert seen[0].returncode == -signal.SIGKILL
    assert state(runs, job.name).state == "running"
    runs.end()  # twice does no harm


def test_one_that_waits_is_cancelled_and_no_other(tmp_path: Path) -> None:
    runs = Runs(tmp_path)
    first, second = runs.ask("a", {}), runs.ask("b", {})
    runs.cancel(second.name)
    assert [(job.name, job.state) for job in runs.jobs()] == [(second.name, "cancelled"), (first.name, "waiting")]
    for name in (second.name, "none"):
        with raises(ParameterError, "run_is_over"):
            runs.cancel(name)


@pytest.mark.parametrize(
    ("summary", "cancelled", "over"),
    [
        (None, False, "failed"),
        (None, True, "cancelled"),
        ({}, False, "done"),
        ({}, True, "done"),
        ({"remedy": ""}, False, "done"),
        ({"outcome": "interrupted"}, True, "cancelled"),
    ],
)
def test_end_of_a_run_by_its_summary(tmp_path: Path, summary: Any, cancelled: bool, over: str) -> None:
    runs = Runs(tmp_path)
    job = runs.ask("a", {})
    if summary is not None:
        (tmp_path / job.name / "summary.json").write_text(json.dumps(SUMMARY | summary), encoding="utf-8")
    found = ended(runs, job, cancelled=cancelled)
    assert found.state == over
    assert ("46.0 m" in found.said) is (summary is not None)


@pytest.mark.parametrize(("cores", "workers"), [(1, "1"), (2, "1"), (4, "3")])
def test_a_core_stays_free_for_the_pages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, cores: int, workers: str
) -> None:
    monkeypatch.setattr(studies_module, "available_cores", lambda: cores)
    studies, folder = Studies(tmp_path), tmp_path / "studies" / "n"
    job = Job("n", CARVE, {}, "2026", language="de")
    words = ["study", str(folder / "study.toml"), "--workers", workers]
    shown = ["--language", "de", "--figure", str(folder / "map.svg")]
    assert studies._command(job) == [*words, *shown]
    assert studies._command(replace(job, scenario="a")) == words


def test_a_study_is_on_the_disk_when_it_is_in_the_queue(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(studies_module, "available_cores", lambda: 5)
    studies = Studies(tmp_path)
    job = studies.ask_for(replace(TURNS, beside={"ski/a.toml": b"b"}, named=("ski: a",)), "de")
    assert [path.name for path in studies.folder.iterdir()] == [job.name]
    assert {str(path.relative_to(studies.folder / job.name)) for path in studies.folder.rglob("*.*")} == {
        "job.json", "study.toml", "ski/a.toml",
    }  # fmt: skip
    assert studies.jobs() == [job]
    fixed = {"load_N": "800", "H_V_N_per_mm3": "0.2", "S_f_N_per_mm2": "0.5", "unloading_ratio": "10"}
    assert job.given.endswith("ski: a")
    assert job == Job(job.name, CARVE, fixed, job.asked_at, given=job.given, points=2, language="de")
    assert (studies.folder / job.name).stat().st_mode & 0o777 == 0o755


def test_a_study_of_too_many_points_is_rejected_before_it_takes_memory(tmp_path: Path) -> None:
    studies = Studies(tmp_path)
    for n, code in ((10**9, "out_of_range"), (10_001, "too_many_points")):
        asked = replace(TURNS, varied={"edge_angle_deg": Range(10.0, 70.0, n)})
        with raises(ParameterError, code):
            studies.ask_for(asked)
    assert studies.jobs() == []


def test_a_study_that_was_cancelled_or_failed_continues(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    studies = Studies(tmp_path)
    first, second = studies.ask_for(TURNS), studies.ask_for(TURNS)
    monkeypatch.setattr(studies_module, "available_cores", lambda: 9)
    for before in ("cancelled", "failed"):
        studies._keep(replace(first, state=before, said="so"))
        studies.go_on(first.name)
        assert studies.jobs() == [second, first]
    for name, now in ((first.name, "waiting"), (first.name, "running"), (first.name, "done"), ("none", "failed")):
        studies._keep(replace(first, state=now))  # type: ignore[arg-type]
        with raises(ParameterError, "not_stopped"):
            studies.go_on(name)


def test_only_the_files_of_a_study_are_given(tmp_path: Path) -> None:
    studies = Studies(tmp_path)
    name = studies.ask_for(TURNS).name
    assert studies.file(name, "study.toml") == studies.folder / name / "study.toml"
    (studies.folder / "other").mkdir()
    (studies.folder / "other" / "study.toml").touch()
    for where, file in (("other", "study.toml"), (name, "job.json"), (name, "map.svg")):
        with raises(ParameterError, "unknown_file"):
            studies.file(where, file)
    (studies.folder / name / "map.svg").write_bytes(b"map")
    folder = studies.folder / name
    files = dict(studies.files_of(folder))
    assert files == {"study/study.toml": (folder / "study.toml").read_bytes(), "study/map.svg": b"map"}


def test_the_outcomes_of_a_study_are_counted(tmp_path: Path) -> None:
    studies = Studies(tmp_path)
    job = studies.ask_for(TURNS)
    (studies.folder / job.name / "table.csv").write_text(TABLE, encoding="utf-8")
    found = ended(studies, job)
    assert found == replace(job, state="done", said=found.said)
    assert ("3 " in found.said, "2;" in found.said, "1." in found.said) == (True, True, True)
    assert ended(studies, job, BUSY).state == "done"
    study, table = studies.table(job.name)
    assert (study.varied, table.varied, len(table.rows)) == (("edge_angle_deg",), ("edge_angle_deg",), 3)
    (studies.folder / job.name / "table.csv").write_text("a\n", encoding="utf-8")
    assert "3 " not in ended(studies, job).said


@pytest.mark.parametrize("cancelled", [False, True])
def test_what_a_study_has_finished_is_kept_and_told(tmp_path: Path, cancelled: bool) -> None:
    studies = Studies(tmp_path)
    job = studies.ask_for(TURNS)
    folder = studies.folder / job.name
    said = f"skisnow: {folder / 'study.toml'}: {folder}/ski is none."
    found = ended(studies, job, said, cancelled=cancelled)
    assert found.state == ("cancelled" if cancelled else "failed")
    assert str(tmp_path) not in found.said
    assert "0 of 2" in found.said
    kept = KeptRows.opened(folder / "table.csv.partial", "a")
    kept.add([(0, '{"a": 1}')])
    kept.close()
    assert "1 of 2" in ended(studies, job, said, cancelled=cancelled).said
    (folder / "table.csv.partial").write_bytes(b"none of rows" * 100)
    assert "0 of 2" in ended(studies, job, said, cancelled=cancelled).said


def test_a_study_that_another_process_writes_is_restarted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(studies_module, "_AGAIN_S", 0.0)
    studies = Studies(tmp_path)
    job = studies.ask_for(TURNS)
    said = f"table.csv.partial {BUSY}"
    assert ended(studies, job, said) == replace(job, state="waiting")
    assert ended(studies, job, said, cancelled=True).state == "cancelled"


def test_the_list_has_a_card_for_each_job_the_newest_first(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    timers = list[Any]()
    monkeypatch.setattr(f"{widgets.__name__}.ui.timer", lambda *what: timers.append(what))
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


def test_what_the_queue_rejects_is_reported(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(f"{widgets.__name__}.ui.timer", lambda *_: None)
    studies = Studies(desk.lab.runs)
    job = studies.ask_for(TURNS)
    page = desk.open("/study")
    studies._keep(replace(job, state="done", said="so"))
    page.press(f"Cancel {job.name}")
    page.until(lambda: desk.code == "run_is_over")
    assert page.shows(" · done").endswith(" · done · so")


TURN = {"ski": "carver", "load_N": 800.0, "H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5, "unloading_ratio": 10.0}
TURNS = StudyQuestion(CARVE, {"edge_angle_deg": Range(10.0, 70.0, 2)}, TURN)
