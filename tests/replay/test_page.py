"""One file that holds everything, and says nothing that a title could smuggle in."""

from __future__ import annotations

import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

from skisnow._support.errors import ParameterError
from skisnow.replay import replay_bytes, replay_of_run, replay_page, write_replay
from skisnow.replay.page import MODULES, static_text
from tests.coded import raises

from ..report.runs import circle_run
from .held import held_replay

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


def test_three_js_is_the_version_that_is_said_and_has_its_licence() -> None:
    assert 'const t="180"' in static_text("three.core.min.js")
    licence = (STATIC / "LICENSE-three.txt").read_text(encoding="utf-8")
    assert "MIT License" in licence
    assert "three.js authors" in licence


def test_a_file_is_written_without_the_web_framework() -> None:
    """The command line writes replay.html where only the plain package is installed."""
    code = "import sys, skisnow.replay; sys.exit(bool({'nicegui', 'fastapi', 'starlette'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_replay_without_a_groove_is_shown() -> None:
    """Nothing was left in the snow: no piece."""
    replay = replay_of_run(circle_run(count=5))
    groove = replay.groove
    names = ("middle", "left", "width", "depth", "residual_depth", "time", "ski")
    empty = replace(groove, **{name: getattr(groove, name)[:0] for name in names})
    assert replay_page(replace(replay, groove=empty))
