"""The page of the lab: the list, the form of two runs, and the replay behind it, as a person opens them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from skisnow.cli import main
from skisnow.replay import moving_replay_model, replay_model, replay_of_file
from skisnow.report.run.file import write_run_file
from skisnow.scenario import scenario_values
from skisnow.scenario.keys import in_sections

from ...report.runs import circle_run
from .browsers import slowly

ODD = 'wide "turn" <b>'


def kept(folder: Path, name: str, **how: Any) -> None:
    """A run in the lab's folder."""
    run = circle_run(count=21, **how)
    (folder / name).mkdir(parents=True)
    write_run_file(run, in_sections(scenario_values(run.scenario)), folder / name / "run.nc")


@pytest.mark.slow
def test_runs_are_listed_and_two_are_watched(served: Any, page: Any) -> None:
    runs = served.store.parent / "lab"
    page.goto(f"{served.address.rstrip('/')}/replay")
    page.get_by_text("Simulate one, then it can be watched here.").wait_for()
    kept(runs, "tight")
    kept(runs, ODD, radius=13.0)
    page.reload()
    page.get_by_text("2 runs kept").wait_for()
    assert page.get_by_role("heading", name=ODD).count() == 1  # text, no mark-up
    page.get_by_label("Run", exact=True).select_option("tight")
    page.get_by_label("Laid over it, translucent").select_option(ODD)
    page.get_by_role("button", name="Watch together").click()
    page.wait_for_function("window.skisnowReplay")
    assert page.evaluate("[skisnowReplay.run.title, skisnowReplay.ghost.title]") == ["tight", ODD]
    page.evaluate("() => { skisnowReplay.pause(); skisnowReplay.seek(0); }")  # it opens playing
    slowly(page)
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("window.skisnowReplay.time > 0.2")
    page.get_by_role("button", name="Pause").click()
    page.get_by_label("Exaggeration of bending and twist").fill("5")
    replay = replay_of_file(runs / "tight", title="tight")
    moment = float(page.evaluate("skisnowReplay.time.toFixed(3)"))
    for link, name, expected in (
        ("Model that moves (glTF)", "tight.glb", moving_replay_model(replay, exaggeration=5.0)),
        ("Model of this moment (glTF)", f"tight-{moment:.2f}s.glb", replay_model(replay, moment, exaggeration=5.0)),
    ):
        with page.expect_download() as download:
            page.get_by_role("link", name=link).click()
        assert download.value.suggested_filename == name
        assert Path(download.value.path()).read_bytes() == expected


@pytest.mark.usefixtures("undrawn")
def test_the_command_writes_a_replay_beside_the_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["simulate", "carved-46m", "--set", "run.duration_s=0.05", "--out", str(tmp_path / "run"), "--replay"]
    assert main(words) == 0
    assert "<h1>carved-46m</h1>" in (tmp_path / "run" / "replay.html").read_text(encoding="utf-8")
    assert "replay.html" in capsys.readouterr().err
    assert 'href="replay.html"' in (tmp_path / "run" / "report.html").read_text(encoding="utf-8")


def test_a_replay_needs_a_folder(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["simulate", "carved-46m", "--replay"])
    assert ended.value.code == 2
    assert "--out" in capsys.readouterr().err
