"""The examples run and give what they state."""

import math
import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest
from tests.present import present

import skisnow
from skisnow import read_ski
from skisnow.interop.opensim import read_motion
from skisnow.studies import read_study

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples" / "campaign_to_turn.py"


@pytest.mark.slow
def test_chain_from_campaign_to_report(tmp_path: Path) -> None:
    """Both turns carve, and the one on snow that springs back is the wider and draws more on its grip.

    By hand: 80 kg at the 6.7 m/s of the end on 15 m and a slope of 5° ask for at most 80 (6.7²/15 + 9.81 sin 5°) =
    308 N to the side. On elastic snow with H_V 0.44 N/mm³ and S_f 0.14 N/mm² both skis under 400 N each, on 1.5 m at
    40°, are e = √(2 · 400 tan 40° / (H_V · 1.5)) = 1.0 mm deep and hold 2 S_f e · 1.5 m = 410 N; in a groove that stays
    the afterbody carries little, the forebody goes deeper and both find more to hold on to.
    """
    skisnow.write_reference(tmp_path / "campaign", seed=1)
    words = [str(tmp_path / "campaign"), str(tmp_path / "turn"), "--runs", "4"]
    done = subprocess.run([sys.executable, str(EXAMPLE), *words], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    told = done.stdout
    assert re.search(r"“elastic” is wider .*[0-9.]+ %", told)
    assert "is higher:" in told and "is smaller" in told
    shares = present(re.search(r"grip utilisation is higher: ([0-9]\.[0-9]+) against ([0-9]\.[0-9]+)", told))
    elastic, hypoplastic = map(float, shares.groups())
    assert 0.2 < hypoplastic < elastic < 308 / 410
    page = (tmp_path / "turn" / "report.html").read_text(encoding="utf-8")
    assert "Synthetic data." in page
    assert "Grip holds" in page
    assert re.search(r"run (\d+) of \1\b", done.stderr)


def test_example_and_demonstration_use_public_names_alone() -> None:
    assert re.findall(r"^(?:from|import) (skisnow.*)$", EXAMPLE.read_text(encoding="utf-8"), re.MULTILINE) == [
        "skisnow"
    ]
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    recipe = makefile.partition("\ndemo:")[2].partition("\n\n")[0]
    assert re.findall(r"\$\(BIN\)/(\w+)", recipe) == ["skisnow"] * 5  # the last one in what it prints


def test_two_skis_turn_as_their_sidecuts(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """On hard snow R → R_sc cos ϑ; at 400 N each radius is within 0.5 % of it, so the ratio within 1 %."""
    monkeypatch.setattr(sys, "argv", ["two_skis.py"])
    runpy.run_path(str(ROOT / "examples" / "two_skis.py"), run_name="__main__")
    printed = present(re.search(r"turns (\S+) times", capsys.readouterr().out))
    sidecuts = [read_ski(name).sidecut_radius_of_three_widths for name in ("giant-slalom", "slalom")]
    assert float(printed[1]) == pytest.approx(sidecuts[0] / sidecuts[1], rel=0.01)


def test_the_study_of_the_gallery_has_the_points_that_it_says() -> None:
    study = read_study(ROOT / "examples" / "carve_study.toml")
    assert len(study.points) == 450
    assert study.varied == ("ski", "published", "load_N", "edge_angle_deg")


def test_forces_that_are_late_feed_a_swing() -> None:
    """Flat skis at 0.5 ms: taken in turn they rest on the snow, taken a step late they leap."""
    swing = runpy.run_path(str(ROOT / "examples" / "explicit_coupling.py"))["swing"]
    assert swing(0.2, 5e-4, edge_angle=0.0, late=False) < 0.1
    assert swing(0.2, 5e-4, edge_angle=0.0, late=True) > 1.0
    assert swing(0.2, 1e-3, edge_angle=math.radians(45.0), late=False) < 0.1


@pytest.mark.slow
def test_the_page_has_the_table() -> None:
    table = runpy.run_path(str(ROOT / "examples" / "explicit_coupling.py"))["table"]()
    assert table in (ROOT / "docs" / "how-to" / "other-programs.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_forces_of_a_capture_are_those_of_the_run_that_was_captured(tmp_path: Path) -> None:
    rows = runpy.run_path(str(ROOT / "examples" / "forces_on_a_measured_skier.py"))["main"](tmp_path)
    (_, mean, rms), *noisy = rows
    assert (abs(mean), rms) < (0.002, 0.005)
    assert [row[2] for row in noisy] == sorted(row[2] for row in noisy)
    page = (ROOT / "docs" / "how-to" / "boots.md").read_text(encoding="utf-8")
    for noise, mean, rms in rows:
        assert f"{noise:19.1f} {100.0 * mean:23.1f} {100.0 * rms:29.1f}\n" in page
    forces = read_motion(tmp_path / "forces.sto").columns
    assert forces["left_ski_force_vy"].max() > 500.0


def test_a_straight_glide_gains_what_friction_leaves() -> None:
    """v² = v₀² + 2 g (sin α - μ cos α) s; the shovels take a thousandth of it, since they press a groove."""
    sledge = runpy.run_path(str(ROOT / "examples" / "rigid_sledge_on_contact.py"))
    rows = sledge["glide"](0.3)
    way, speed, energy, work = rows[-1]
    slope = math.radians(10.0)
    assert speed**2 == pytest.approx(1.0 + 2.0 * 9.81 * (math.sin(slope) - 0.05 * math.cos(slope)) * way, rel=1.5e-3)
    lost = rows[0][2] - energy, work - rows[0][3]
    assert lost[0] == pytest.approx(lost[1], rel=5e-3)
    assert lost[0] > lost[1]
