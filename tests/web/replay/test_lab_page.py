"""The replay in the lab: its page, languages, and a skier."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from skisnow._support.errors import ParameterError
from skisnow.cli import main
from skisnow.replay import Replay, replay_of_run, write_replay
from skisnow.replay.page import page_words
from skisnow.replay.skier import JOINTS
from skisnow.report.run.file import write_run_file
from skisnow.scenario import scenario_values
from skisnow.scenario.keys import in_sections
from tests.present import present

from ...replay.test_skier import run_of_skier
from ...report.runs import circle_run
from .browsers import Watched, slowly

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
    page.get_by_label("Second run, translucent").select_option(ODD)
    page.get_by_role("button", name="Watch together").click()
    page.wait_for_function("window.skisnowReplay")
    assert page.evaluate("[skisnowReplay.run.title, skisnowReplay.ghost.title]") == ["tight", ODD]
    page.evaluate("() => { skisnowReplay.pause(); skisnowReplay.seek(0); }")  # it opens playing
    slowly(page)
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("window.skisnowReplay.time > 0.2")
    page.get_by_role("button", name="Pause").click()


@pytest.mark.usefixtures("undrawn")
def test_the_command_writes_a_replay_beside_the_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["simulate", "carved-46m", "--set", "run.duration_s=0.05", "--out", str(tmp_path / "run"), "--replay"]
    assert main(words) == 0
    assert "<h1>carved-46m</h1>" in (tmp_path / "run" / "replay.html").read_text(encoding="utf-8")
    assert "replay.html" in capsys.readouterr().err
    assert 'href="replay.html"' in (tmp_path / "run" / "report.html").read_text(encoding="utf-8")


TOLD = """return [...document.querySelectorAll("#replay *")].flatMap((each) => [
    each.getAttribute("aria-label"), each.getAttribute("aria-valuetext"), each.children.length ? "" : each.textContent,
  ]).filter(Boolean)"""


def test_all_that_the_program_says_has_its_german_text() -> None:
    words = page_words("de")
    assert {"Speed of play", "{} m left", "0.5"} <= set(words)
    assert [text for text, german in words.items() if text == german and len(text) > 8] == ["Film (WebM)"]


def test_a_page_in_german(drawing_chromium: Any, tmp_path: Path) -> None:
    run = replay_of_run(circle_run(), title="Ein Schwung")
    page = write_replay(run, tmp_path / "replay.html", ghost=replay_of_run(circle_run(radius=13.0)), language="de")
    seen = Watched(drawing_chromium, page.as_uri())
    seen.does("replay.show('forces', true); replay.seek(2.0)")
    told = seen.does(TOLD)
    assert seen.page.locator("html").get_attribute("lang") == "de"
    seen.close()
    for words in (
        "12,0 m links",
        "8,00 m/s",
        "2,00 Sekunden",
        "Replay von Ein Schwung",
        "Gesamtkraft auf den linken Ski",
    ):
        assert words in told
    assert any("Kantwinkel" in each for each in told)
    english = {text for text, words in page_words("de").items() if text not in (words, "0.5")}
    assert english & set(told) == set()
    assert seen.complaints == []


def test_a_language_without_texts_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(ParameterError):
        write_replay(circle_run(), tmp_path / "replay.html", language="xx")
    assert not list(tmp_path.iterdir())


LATER = (0.25, -0.5)
"""By how much the ghost is later at each gate (s)."""


@pytest.fixture(scope="module")
def replay() -> Replay:
    return replay_of_run(run_of_skier(), title="A skier")


@pytest.fixture(scope="module")
def seen(drawing_chromium: Any, replay: Replay, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Watched]:
    ghost = replace(
        replay, title="its ghost", time=replay.time + 7.0, gate_times=present(replay.gate_times) + np.array(LATER)
    )
    page = write_replay(replay, tmp_path_factory.mktemp("page") / "replay.html", ghost=ghost)
    watched = Watched(drawing_chromium, page.as_uri())
    yield watched
    watched.close()


def test_parts_stand_between_the_joints(seen: Watched, replay: Replay) -> None:
    frame = 5
    turn = Rotation.from_quat(replay.attitude[frame], scalar_first=True)
    for part, joint in (("left thigh", "left knee"), ("right forearm", "right elbow"), ("head", "neck")):
        script = f"""replay.seek({replay.time[frame]});
            const part = replay.stage.skis.group.getObjectByName("{part}");
            part.updateWorldMatrix(true, false);
            const back = replay.stage.space.matrixWorld.clone().invert();
            return Array.from(part.matrixWorld.clone().premultiply(back).elements.slice(12, 15));"""
        expected = replay.place[frame] + turn.apply(present(replay.skier).joints[frame, JOINTS.index(joint)])
        assert seen.does(script) == pytest.approx(expected, abs=1e-4), part
    assert seen.page.get_by_text("Assumed: knees").count() == 1
    red = seen.picture().reshape(-1, 3)
    assert ((red[:, 0] > 120) & (red[:, 1] < 90) & (red[:, 2] < 90)).sum() > 150  # the jacket
    assert seen.complaints == []


def test_load_shares_and_turned_skis_are_numbers_beside_bars(seen: Watched, replay: Replay) -> None:
    assert replay.skier is not None and replay.skis.boots is not None
    frame = 5
    weights = np.linalg.norm(replay.skis.force[frame].sum(axis=0)) / replay.skier.weight
    left, right = (100.0 * replay.skis.normal_force[frame] / replay.skis.normal_force[frame].sum()).round()
    step, (w, x, y, z) = np.diff(replay.place, axis=0)[frame], replay.skis.boots.attitude[frame, 0]
    skis = np.arctan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (y * y + z * z))
    turned = np.degrees(skis - np.arctan2(step[1], step[0]))
    assert abs(turned) > 2.0 and left != right
    seen.does(f"replay.seek({replay.time[frame]})")
    lines = [line.inner_text().split("\n") for line in seen.page.locator(".replay-readings > div").all()]
    told = dict(line for line in lines if len(line) == 2)
    assert told["Load in body weights"] == f"{weights:.1f}"
    assert told["Skis turned from path"] == f"{abs(turned):.0f}° {'left' if turned > 0.0 else 'right'}"
    assert told["Skis turned from body"] == "0°"
    for name, share in (("Load on left ski", left), ("Load on right ski", right)):
        assert told[name] == f"{share:.0f} %"
        bar = seen.page.get_by_role("meter", name=name)
        assert bar.get_attribute("aria-valuenow") == f"{share:.0f}"
        assert bar.evaluate("each => getComputedStyle(each).backgroundImage").count(f" {share:.0f}%") == 2


def test_the_gap_is_reported_when_both_have_passed_a_gate(seen: Watched, replay: Replay) -> None:
    first, second = (replay.time[0] + present(replay.gate_times)).tolist()
    told = []
    for time in (first + 0.2, first + 0.3, second + 0.01):
        seen.does(f"replay.seek({time})")
        told.append(seen.page.locator(".replay-large", has_text="Gap").inner_text().split("\n"))
    assert told == [
        ["Gap at the first gate", "not yet"],
        ["Gap at gate 1", "0.25 s ahead"],
        ["Gap at gate 2", "0.50 s behind"],
    ]


def test_both_begin_together(seen: Watched, replay: Replay) -> None:
    """The ghost's clock begins 7 s later: it is on the same place all the same."""
    script = f"""replay.seek({replay.time[3]});
        return [replay.stage.skis, replay.stage.ghostSkis].map(({{ group }}) => {{
          const part = group.getObjectByName("trunk");
          part.updateWorldMatrix(true, false);
          return Array.from(part.matrixWorld.elements.slice(12, 15));
        }});"""
    own, ghost = seen.does(script)
    assert own == pytest.approx(ghost, abs=1e-3)
    assert seen.value("end") == pytest.approx(float(replay.time[-1]), abs=1e-3)


def test_the_first_page_s_replay_leaves_time_for_other_things(served: Any, page: Any) -> None:
    page.emulate_media(reduced_motion="no-preference")
    page.goto(served.address)
    page.wait_for_function("window.skisnowReplay && skisnowReplay.frames > 0")
    gaps = page.evaluate(
        """async () => {
            const times = [];
            const { draw } = Object.getPrototypeOf(skisnowReplay);
            skisnowReplay.draw = () => { times.push(performance.now()); draw.call(skisnowReplay); };
            skisnowReplay.stage.drawn = () => new Promise((done) => setTimeout(done, 40));
            while (times.length < 5) await new Promise(requestAnimationFrame);
            return times.slice(2).map((time, i) => time - times[i + 1]);
        }"""
    )
    assert min(gaps) > 100  # a third of the time for drawing, less the rounding of timers
    root = "document.getElementById('first-replay').style.marginTop"
    page.evaluate(f"{root} = '9000px'")
    page.wait_for_timeout(1000)
    frames = page.evaluate("skisnowReplay.frames")
    page.wait_for_timeout(500)
    assert page.evaluate("skisnowReplay.frames") == frames
    page.evaluate(f"{root} = ''")
    page.wait_for_function(f"skisnowReplay.frames > {frames}")
