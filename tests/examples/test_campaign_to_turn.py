"""The example from a campaign to a turn: the chain that make demo runs, on fewer runs."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import skisnow

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
    shares = re.search(r"grip utilisation is higher: ([0-9]\.[0-9]+) against ([0-9]\.[0-9]+)", told)
    assert shares is not None
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
