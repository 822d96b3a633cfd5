"""`skisnow simulate` as a user meets it. All but one test replace the simulator by a straight run in closed form."""

import csv
import json
import os
import signal
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import jsonschema
import pytest

from skisnow import Run, Scenario
from skisnow._support.errors import SkisnowError
from skisnow.cli import main
from skisnow.cli.output import Progress
from skisnow.cli.shell import json_schema
from skisnow.simulation.run_tables import write_track

from ..simulation.straight_run import STRAIGHT, straight_run
from .json_answer import json_answer

SCHEMA = json_schema("summary")
ASKED = ["carved-46m", *(word for key, value in STRAIGHT.items() for word in ("--set", f"{key}={value}"))]
LENGTH = 10.0 + 2.0 * 9.81 * (0.17364817766693033 - 0.05 * 0.984807753012208)  # 2 s from 5 m/s down 10°, μ = 0.05
Printed = pytest.CaptureFixture[str]
Simulate = Callable[..., Run]
Replaced = Callable[[Simulate], None]


@pytest.fixture
def replaced(monkeypatch: pytest.MonkeyPatch) -> Replaced:
    def put(simulate: Simulate) -> None:
        module = ModuleType("skisnow.simulation.simulated_run")
        vars(module)["simulate"] = simulate
        monkeypatch.setitem(sys.modules, "skisnow.simulation.simulated_run", module)

    put(straight_run)
    return put


def interrupted(scenario: Scenario, *, progress: Callable[[float, float], None] | None = None) -> Run:
    return straight_run(scenario, progress=progress, outcome="interrupted", share=0.5)


def answer(words: list[str], printed: Printed) -> Any:
    return json_answer(["simulate", *words], SCHEMA, printed)


def test_simulator_itself_answers_through_the_command(capsys: Printed) -> None:
    """Without losses ½v² would grow by g sin 10° times the way down; losses take some, never all of it, in 0.2 s."""
    found = answer(["carved-46m", "--set", "duration_s=0.2"], capsys)
    down = 9.81 * 0.17364817766693033 * (found["end"]["x_m"])
    gained = (found["end"]["speed_m_per_s"] ** 2 - 7.0**2) / 2.0
    assert 0.5 * down < gained < down
    assert found["end"]["y_m"] < 0.0  # heading 30 degrees to the right
    assert -30.0 < found["end"]["heading_deg"] < -20.0  # and turning left
    assert found["numbers"]["elements"] >= 20


@pytest.mark.usefixtures("replaced")
def test_json_is_the_summary_alone_and_summary_says_in_words_what_came_out(capsys: Printed) -> None:
    found = answer(ASKED, capsys)
    assert found["outcome"] == "finished"
    assert found["run_length_m"] == pytest.approx(LENGTH, rel=1e-12)
    assert found["scenario"]["run"]["duration_s"] == 2.0
    assert "verification" not in found
    assert main(["simulate", *ASKED]) == 0
    out, err = capsys.readouterr()
    told = {line[:17].strip(): line[17:].strip() for line in out.splitlines()[1:] if line}
    assert out.startswith("carved-46m: finished\n")
    assert told["run length"] == "12.44 m in 2 s"
    assert told["turn radius"] == "straight"
    assert "%" in told["energy residual"]
    assert told["computed in"] == "1000 steps, 0.5 s"
    assert "warning" not in err  # on a busy machine a line says that it is loading


@pytest.mark.usefixtures("replaced", "undrawn")
def test_folder_holds_summary_track_file_and_report(tmp_path: Path, capsys: Printed) -> None:
    folder = tmp_path / "new" / "run"
    assert main(["simulate", *ASKED, "--verify", "--out", str(folder)]) == 0
    assert {"summary.json", "track.csv", "run.nc", "report.html", "figures"} == {each.name for each in folder.iterdir()}
    text = (folder / "summary.json").read_text(encoding="utf-8")
    assert text.startswith('{\n "')  # lines indented by one, as in every file of ours
    summary = json.loads(text)
    jsonschema.validate(summary, SCHEMA)
    with (folder / "track.csv").open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert float(rows[-1]["x_m"]) == summary["end"]["x_m"] == pytest.approx(LENGTH, rel=1e-12)
    assert summary["verification"]["solver.elements"]["now"] == 80.0
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "End moves by" in page  # of the table of what was computed finer
    assert "sledge.stance_width_m" in page
    assert str(folder / "report.html") in capsys.readouterr().err


@pytest.mark.usefixtures("replaced", "undrawn")
def test_a_folder_never_holds_two_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ended while it writes, the folder is as it was; written again, nothing of the earlier run is left."""

    def contents() -> dict[str, bytes]:
        return {str(each.relative_to(tmp_path)): each.read_bytes() for each in tmp_path.rglob("*") if each.is_file()}

    def interrupted_here(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    (tmp_path / "mine.txt").write_text("mine", encoding="utf-8")
    assert main(["simulate", *ASKED, "--out", str(tmp_path), "--replay"]) == 0
    first = contents()
    assert "replay.html" in first
    with monkeypatch.context() as patched:
        patched.setattr("skisnow.report.run.page.run_page", interrupted_here)
        assert main(["simulate", *ASKED, "--set", "friction.mu_0=0.06", "--out", str(tmp_path)]) == 130
    assert contents() == first
    assert main(["simulate", *ASKED, "--set", "friction.mu_0=0.06", "--out", str(tmp_path)]) == 0
    second = contents()
    assert first.keys() - second.keys() == {"replay.html"}
    assert second["mine.txt"] == b"mine"
    assert all(second[name] != first[name] for name in ("summary.json", "track.csv", "run.nc", "report.html"))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.usefixtures("replaced", "undrawn")
def test_a_kill_between_new_numbers_and_old_figures(tmp_path: Path, capsys: Printed) -> None:
    """Killed while its files are moved; what is there is of one run, and the next run replaces all of it."""
    assert main(["simulate", *ASKED, "--out", str(tmp_path)]) == 0
    first = {path.relative_to(tmp_path): path.read_bytes() for path in tmp_path.rglob("*.*") if path.is_file()}
    child = os.fork()
    if child == 0:
        move, moved = Path.replace, iter(range(3))

        def replace(self: Path, target: Path) -> Path:
            if target.parent in (tmp_path, tmp_path / "figures") and next(moved, None) is None:
                os.kill(os.getpid(), signal.SIGKILL)
            return move(self, target)

        Path.replace = replace  # type: ignore[method-assign,assignment]
        try:
            main(["simulate", *ASKED, "--set", "friction.mu_0=0.06", "--out", str(tmp_path)])
        finally:
            os._exit(0)
    assert os.WIFSIGNALED(os.waitpid(child, 0)[1])
    seen = {
        path.relative_to(tmp_path): path.read_bytes()
        for path in tmp_path.rglob("*.*")
        if ".skisnow-" not in str(path) and path.is_file()
    }
    assert Path("summary.json") not in seen
    assert len(seen) == 3
    assert any(seen[name] != first[name] for name in seen)
    capsys.readouterr()
    assert main(["simulate", *ASKED, "--set", "friction.mu_0=0.06", "--out", str(tmp_path)]) == 0
    summary = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))
    assert summary["scenario"]["friction"]["mu_0"] == 0.06
    assert all((tmp_path / name).exists() for name in first)
    assert all((tmp_path / name).read_bytes() == content for name, content in seen.items())


@pytest.mark.usefixtures("replaced")
def test_without_out_nothing_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["simulate", *ASKED]) == 0
    assert list(tmp_path.iterdir()) == []


@pytest.mark.usefixtures("replaced")
def test_verify_repeats_the_run_finer(capsys: Printed) -> None:
    """The made-up run misses by 40 mm / elements: from 40 to 80 its end moves by 0.05 cm."""
    found = answer([*ASKED, "--verify"], capsys)["verification"]
    assert found["solver.elements"]["end_moves_cm"] == pytest.approx(0.05, rel=1e-9)
    assert main(["simulate", *ASKED, "--verify"]) == 0
    (line,) = [line for line in capsys.readouterr().out.splitlines() if "solver.elements" in line]
    assert line.split(maxsplit=1)[1].startswith("40.0 to 80.0:") and "0.0500 cm" in line


@pytest.mark.usefixtures("undrawn")
def test_interrupted_run_is_kept(tmp_path: Path, capsys: Printed, replaced: Replaced) -> None:
    replaced(interrupted)
    assert main(["simulate", *ASKED, "--out", str(tmp_path), "--verify"]) == 130
    out, _ = capsys.readouterr()
    assert out.startswith("carved-46m: interrupted\n")
    summary = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))
    assert (summary["outcome"], summary["simulated_s"]) == ("interrupted", 1.0)
    assert "verification" not in summary
    assert (tmp_path / "report.html").is_file()


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.usefixtures("undrawn")
def test_run_that_the_system_ends_is_kept_and_says_so(tmp_path: Path, replaced: Replaced) -> None:
    def ended(scenario: Scenario, **told: Any) -> Run:
        try:
            os.kill(os.getpid(), signal.SIGTERM)
            signal.pause()
        except KeyboardInterrupt:
            return interrupted(scenario, **told)
        raise AssertionError("not reached")

    replaced(ended)
    assert main(["simulate", *ASKED, "--json", "--out", str(tmp_path)]) == 143
    assert (tmp_path / "track.csv").is_file()


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.usefixtures("undrawn", "replaced")
@pytest.mark.parametrize(
    ("signals", "status", "is_kept"),
    [
        ((signal.SIGTERM,), 143, True),
        ((signal.SIGINT, signal.SIGTERM), 143, False),
        ((signal.SIGTERM, signal.SIGINT), 130, False),
    ],
)
def test_asked_to_end_while_it_writes_it_writes_first(
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    signals: tuple[signal.Signals, ...],
    status: int,
    is_kept: bool,
) -> None:
    def written(run: Run, place: Path) -> None:
        for each in signals:
            signal.raise_signal(each)
        write_track(run, place)

    monkeypatch.setattr("skisnow.report.run.page.write_track", written)
    assert main(["simulate", *ASKED, "--out", str(tmp_path)]) == status
    assert (tmp_path / "summary.json").is_file() is is_kept
    assert (tmp_path / "track.csv").is_file() is is_kept
    assert "computed results first" in capfd.readouterr().err
    assert [each.name for each in tmp_path.iterdir() if each.name.startswith(".")] == []
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.parametrize("outcome", ["tipped_over", "airborne", "sunk", "energy_open", "not_finite"])
def test_every_outcome_is_an_answer_with_its_remedy(outcome: Any, capsys: Printed, replaced: Replaced) -> None:
    replaced(lambda scenario, **told: straight_run(scenario, outcome=outcome, **told))
    assert main(["simulate", *ASKED]) == 0
    first, second, *_ = capsys.readouterr().out.splitlines()
    assert first == f"carved-46m: {outcome.replace('_', ' ')}"
    assert second == "a longer breath"


@pytest.mark.usefixtures("undrawn")
def test_an_open_balance_is_reported(tmp_path: Path, capsys: Printed, replaced: Replaced) -> None:
    """In the terminal, in summary.json and in the report."""

    def opened(scenario: Scenario, **told: Any) -> Run:
        run = straight_run(scenario, **told)
        return replace(run, energies=run.energies | {"damping": run.energies["friction"]})

    replaced(opened)
    assert main(["simulate", *ASKED, "--out", str(tmp_path)]) == 0
    out, err = capsys.readouterr()
    warned = "the energy residual is "
    assert "energy residual" in out
    assert f"warning: {warned}" in err
    assert any(warned in each for each in json.loads((tmp_path / "summary.json").read_text())["warnings"])
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert warned in page


def test_progress_has_a_real_time_factor(capsys: Printed, replaced: Replaced, monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setitem(Progress.__init__.__kwdefaults__ or {}, "patience_s", 1.0)
    for module in ("simulate", "output"):
        monkeypatch.setattr(f"skisnow.cli.{module}.time", SimpleNamespace(monotonic=lambda: now))

    def slow(scenario: Scenario, *, progress: Callable[[float, float], None]) -> Run:
        nonlocal now
        progress(0.0, 0.0)
        now += 4.0
        progress(1.0, 0.5)
        return straight_run(scenario)

    replaced(slow)
    assert main(["simulate", *ASKED]) == 0
    assert "0.25 times real" in capsys.readouterr().err


@pytest.mark.usefixtures("replaced")
def test_warnings_go_to_stderr_and_into_the_summary(capsys: Printed) -> None:
    words = [*ASKED, "--set", "S_f_N_per_mm2=0.9"]
    assert main(["simulate", *words, "--json"]) == 0
    out, err = capsys.readouterr()
    assert "warning: " in err and "0.9 N/mm²" in err
    assert len(json.loads(out)["warnings"]) == 1


@pytest.mark.usefixtures("replaced")
def test_file_and_its_hash(tmp_path: Path, capsys: Printed, monkeypatch: pytest.MonkeyPatch) -> None:
    from skisnow.scenario import scenario_text

    monkeypatch.chdir(tmp_path)
    Path("mine.toml").write_text(scenario_text("carved-46m"), encoding="utf-8")
    found = answer(["mine.toml", *ASKED[1:]], capsys)
    assert list(found["provenance"]["files"]) == ["mine.toml"]


def test_list_names_the_built_in_scenarios_and_prints_one(capsys: Printed) -> None:
    assert main(["simulate", "--list"]) == 0
    names = capsys.readouterr().out.split()
    assert names[:2] + names[3:4] == ["carved-46m", "carver-42m", "giant-slalom-67m"]
    assert {"skier-10deg", "skier-12deg", "skier-19deg", "slalom-20-gates", "giant-slalom-20-gates"} < set(names)
    assert main(["simulate", "carver-42m", "--list"]) == 0
    assert 'published = "race-piste"' in capsys.readouterr().out
    assert main(["simulate", "carver-42", "--list"]) == 1
    assert "carver-42m?" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["carved-46"], "unknown_name"),
        (["nowhere.toml"], "cannot_read"),
        (["carved-46m", "--set", "mass_kg"], "changes_nothing"),
        (["carved-46m", "--set", "mas_kg=3"], "unknown_name"),
        (["carved-46m", "--set", "mass_kg=0"], "out_of_range"),
    ],
)
def test_bad_input_is_rejected(words: list[str], code: str, capsys: Printed, noted_errors: list[SkisnowError]) -> None:
    assert main(["simulate", *words]) == 1
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert noted_errors[-1].code == code


def test_out_that_cannot_be_written_is_rejected_first(tmp_path: Path, capsys: Printed, replaced: Replaced) -> None:
    def never(*_: object, **__: object) -> Run:
        raise AssertionError("simulated all the same")

    replaced(never)
    (tmp_path / "file").write_text("", encoding="utf-8")
    assert main(["simulate", *ASKED, "--out", str(tmp_path / "file")]) == 1
    assert "cannot be written" in capsys.readouterr().err
