"""A skier and its ghost in a browser: parts between the joints, the gap at each gate, what is assumed in words."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from skisnow.replay import Replay, replay_of_run, write_replay
from skisnow.replay.skier import JOINTS

from ...replay.test_skier import run_of_skier
from .browsers import Watched, drawing_in_software

LATER = (0.25, -0.5)
"""By how much the ghost is later at each gate (s)."""


@pytest.fixture(scope="module")
def replay() -> Replay:
    return replay_of_run(run_of_skier(), title="A skier")


@pytest.fixture(scope="module")
def seen(chromium: Any, replay: Replay, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Watched]:
    assert replay.gate_times is not None
    ghost = replace(replay, title="its ghost", time=replay.time + 7.0, gate_times=replay.gate_times + np.array(LATER))
    page = write_replay(replay, tmp_path_factory.mktemp("page") / "replay.html", ghost=ghost)
    with drawing_in_software(chromium) as browser:
        watched = Watched(browser, page.as_uri())
        yield watched
        watched.close()


def test_parts_stand_between_the_joints(seen: Watched, replay: Replay) -> None:
    assert replay.skier is not None
    frame = 5
    turn = Rotation.from_quat(replay.attitude[frame], scalar_first=True)
    for part, joint in (("left thigh", "left knee"), ("right forearm", "right elbow"), ("head", "neck")):
        script = f"""replay.seek({replay.time[frame]});
            const part = replay.stage.skis.group.getObjectByName("{part}");
            part.updateWorldMatrix(true, false);
            const back = replay.stage.space.matrixWorld.clone().invert();
            return Array.from(part.matrixWorld.clone().premultiply(back).elements.slice(12, 15));"""
        expected = replay.place[frame] + turn.apply(replay.skier.joints[frame, JOINTS.index(joint)])
        assert seen.does(script) == pytest.approx(expected, abs=1e-4), part
    assert seen.page.get_by_text("Assumed: knees, trunk's bend, head, arms, poles").count() == 1
    red = seen.picture().reshape(-1, 3)
    assert ((red[:, 0] > 120) & (red[:, 1] < 90) & (red[:, 2] < 90)).sum() > 300  # the jacket
    assert seen.complaints == []


def test_the_gap_is_told_when_both_have_passed_a_gate(seen: Watched, replay: Replay) -> None:
    assert replay.gate_times is not None
    first, second = (replay.time[0] + replay.gate_times).tolist()
    told = []
    for time in (first + 0.2, first + 0.3, second + 0.01):
        seen.does(f"replay.seek({time})")
        told.append(seen.page.locator(".replay-large").last.inner_text().split("\n"))
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
