"""The examples of carved skis: two skis on hard snow against their sidecut radii, and the study of the gallery."""

import re
import runpy
import sys
from pathlib import Path

import pytest

from skisnow import read_ski
from skisnow.studies import read_study

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def test_two_skis_turn_as_their_sidecuts(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """On hard snow R → R_sc cos ϑ; at 400 N each radius is within 0.5 % of it, so the ratio within 1 %."""
    monkeypatch.setattr(sys, "argv", ["two_skis.py"])
    runpy.run_path(str(EXAMPLES / "two_skis.py"), run_name="__main__")
    printed = re.search(r"turns (\S+) times", capsys.readouterr().out)
    assert printed is not None
    sidecuts = [read_ski(name).sidecut_radius_of_three_widths for name in ("giant-slalom", "slalom")]
    assert float(printed[1]) == pytest.approx(sidecuts[0] / sidecuts[1], rel=0.01)


def test_the_study_of_the_gallery_has_the_points_that_it_says() -> None:
    study = read_study(EXAMPLES / "carve_study.toml")
    assert len(study.points) == 450
    assert study.varied == ("ski", "published", "load_N", "edge_angle_deg")
