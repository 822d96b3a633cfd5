"""The binary of a replay and its page."""

import re
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.replay import Replay, ReplayTrack, replay_bytes, replay_of_run, replay_page, write_replay
from skisnow.replay.page import MODULES, static_text
from skisnow.replay.page import _arrays_by_name as arrays_by_name
from tests.coded import raises

from ..report.runs import circle_run
from .held import held_replay, unpacked

TRACK = ReplayTrack(name="GNSS <1>", place=np.array([[0.0, 0.0, 0.1], [1.0, 2.0, np.nan]]), time=np.array([0.0, 0.5]))


@pytest.fixture(scope="module")
def replay() -> Replay:
    return replay_of_run(circle_run(), title="A turn, süß", track=TRACK, gates=[[1.0, 2.0]])


def header(content: bytes) -> dict[str, Any]:
    return unpacked(content)[0]


def test_what_comes_back_is_within_the_stated_error(replay: Replay) -> None:
    head, back = unpacked(replay_bytes(replay))
    wanted = arrays_by_name(replay)
    assert back.keys() == wanted.keys()
    assert len(back) == 8 + 10 + 7 + 3
    for name, values in wanted.items():
        difference = np.abs(back[name] - values)
        # the error is that of the encoder; reading multiplies and adds once more
        assert np.nan_to_num(difference).max() <= head["arrays"][name]["error"] + 1e-12, name
    assert (head["title"], head["tilt"]) == (replay.title, replay.tilt)
    assert list(map(tuple, head["facts"])) == list(replay.facts)


def test_errors_are_half_a_step_at_most_and_small_against_what_is_seen(replay: Replay) -> None:
    described = header(replay_bytes(replay))["arrays"]
    for name, each in described.items():
        if each["type"] == "uint16":
            assert each["error"] <= 0.5 * each["step"] * (1.0 + 1e-9), name
    # metres: a hundredth of a millimetre on the snow, a micrometre along the ski; N/m: a thousandth of the stated value
    assert described["place"]["error"] < 1e-5
    assert described["bending"]["error"] < 1e-6
    assert described["force_per_length"]["error"] < 0.02
    assert described["attitude"]["error"] < 1e-7


def test_numbers_of_a_later_reader_are_where_the_text_says(replay: Replay) -> None:
    """Decoded with nothing but the module's text: offsets from the end of the header, value = lowest + step n."""
    content = replay_bytes(replay)
    (length,) = struct.unpack("<I", content[4:8])
    each = header(content)["arrays"]["force_per_length"]
    time, ski, station = 17, 1, 30
    place = 8 + length + each["start"] + 2 * ((time * 2 + ski) * each["shape"][2] + station)
    (number,) = struct.unpack("<H", content[place : place + 2])
    value = each["lowest"] + each["step"] * number
    assert value == pytest.approx(replay.skis.force_per_length[time, ski, station], abs=each["error"] * 1.001)
    assert (8 + length) % 4 == 0
    assert all(item["start"] % 4 == 0 for item in header(content)["arrays"].values())


def test_a_track_without_heights_lies_on_the_snow(replay: Replay) -> None:
    head, back = unpacked(replay_bytes(replay))
    assert head["track_name"] == "GNSS <1>"
    assert back["track_place"] == pytest.approx(np.array([[0.0, 0.0, 0.1], [1.0, 2.0, 0.0]]), abs=1e-6)
    assert back["track_time"].tolist() == [0.0, 0.5]


@pytest.mark.parametrize("count", [802, 2002])
def test_fine_outputs_are_thinned_and_both_ends_stay(count: int) -> None:
    """200 or 500 a second become 100; the last comes besides."""
    replay = replay_of_run(circle_run(count=count, duration=4.0))
    _, back = unpacked(replay_bytes(replay))
    assert 380 <= len(back["time"]) <= 402
    assert back["time"][[0, -1]] == pytest.approx([0.0, 4.0])
    assert back["place"][-1] == pytest.approx(replay.place[-1], abs=1e-5)
    assert back["bending"].shape == (len(back["time"]), 2, 61)


def test_five_seconds_are_below_a_megabyte() -> None:
    assert len(replay_bytes(replay_of_run(circle_run(count=501, duration=5.0)))) < 1_000_000


def test_one_moment_is_enough_and_none_is_rejected() -> None:
    one = replay_of_run(circle_run(count=3))
    over = {
        name: getattr(one, name)[:1] for name in ("time", "place", "attitude", "speed", "curvature", "heading", "depth")
    }
    histories = ("bending", "twist", "edge_depth", "force_per_length", "force", "normal_force")
    skis = replace(one.skis, **{name: getattr(one.skis, name)[:1] for name in histories})
    assert len(unpacked(replay_bytes(replace(one, skis=skis, **over)))[1]["time"]) == 1
    with raises(ParameterError, "no_data"):
        replay_of_run(replace(circle_run(count=3), time=np.zeros(0)))


STATIC = Path(__file__).resolve().parents[2] / "src" / "skisnow" / "replay" / "static"


def test_the_runs_are_inside_to_the_byte(tmp_path: Path) -> None:
    run, ghost = replay_of_run(circle_run()), replay_of_run(circle_run(unloading_ratio=1.0), title="elastic")
    path = write_replay(run, tmp_path / "deep" / "replay.html", ghost=ghost)
    assert held_replay(path, "run") == replay_bytes(run)
    assert held_replay(path, "ghost") == replay_bytes(ghost)


def test_every_module_is_inside_after_those_that_it_imports() -> None:
    for place, name in enumerate(MODULES):
        for wanted in re.findall(r'(?:from|import)\s*"\./([^"]+)"', static_text(name)):
            assert wanted in MODULES[:place], f"{name} imports {wanted}"
    assert {path.name for path in STATIC.glob("*.js")} == set(MODULES)


def test_nothing_is_loaded_from_elsewhere() -> None:
    page = replay_page(replay_of_run(circle_run(count=5)))
    outside_scripts = re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL)
    assert not re.findall(r"(?:src|href)=\"(?!data:,)", outside_scripts)
    assert "@import" not in outside_scripts
    assert "url(" not in outside_scripts


def test_a_title_is_text() -> None:
    page = replay_page(replay_of_run(circle_run(count=5), title='</script><script>alert("x")</script>'))
    assert "<script>alert" not in page
    assert page.count("<script") == 1 + 1 + len(MODULES)


def test_titles_go_to_whom_has_none_yet(tmp_path: Path) -> None:
    replay = replay_of_run(circle_run(count=5))
    with raises(ParameterError, "not_together"):
        write_replay(replay, tmp_path / "x.html", title="other")
    written = write_replay(circle_run(count=5), tmp_path / "x.html", title="other").read_text(encoding="utf-8")
    assert "<h1>other</h1>" in written
    with raises(ParameterError, "cannot_read"):
        write_replay(tmp_path / "nowhere", tmp_path / "y.html")
    assert not (tmp_path / "y.html").exists()


def test_three_js_is_the_version_that_is_reported_and_has_its_licence() -> None:
    assert 'const t="180"' in static_text("three.core.min.js")
    licence = (STATIC / "LICENSE-three.txt").read_text(encoding="utf-8")
    assert "MIT License" in licence
    assert "three.js authors" in licence


def test_a_replay_without_a_groove_is_shown() -> None:
    """Nothing was left in the snow: no piece."""
    replay = replay_of_run(circle_run(count=5))
    groove = replay.groove
    names = ("middle", "left", "width", "depth", "residual_depth", "time", "ski")
    empty = replace(groove, **{name: getattr(groove, name)[:0] for name in names})
    assert replay_page(replace(replay, groove=empty))
