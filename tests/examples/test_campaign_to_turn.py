"""The example from an analysed campaign to a turn: the chain that make demo runs, on fewer runs."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from skisnow.estimate import analyse, results_dict
from skisnow.estimate.results_text import results_json
from skisnow.field.reference import reference_campaign

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "campaign_to_turn.py"


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("results") / "results.json"
    path.write_bytes(results_json(results_dict(analyse(reference_campaign(1).campaign(), n_resamples=100))))
    return path


def run(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, str(EXAMPLE), *words], capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_chain_from_results_to_report(results: Path, tmp_path: Path) -> None:
    """Both turns carve, and the one on snow that springs back is the wider and draws more on its grip.

    By hand: 80 kg at the 6.7 m/s of the end on 15 m and a slope of 5° ask for at most 80 (6.7²/15 + 9.81 sin 5°) =
    308 N to the side. On elastic snow with H_V 0.44 N/mm³ and S_f 0.14 N/mm² both skis under 400 N each, on 1.5 m at
    40°, are e = √(2 · 400 tan 40° / (H_V · 1.5)) = 1.0 mm deep and hold 2 S_f e · 1.5 m = 410 N; in a groove that stays
    the afterbody carries little, the forebody goes deeper and both find more to hold on to.
    """
    done = run(str(results), str(tmp_path), "--runs", "4", "--workers", "2")
    assert done.returncode == 0, done.stderr
    told = done.stdout
    assert re.search(r"contact “elastic” is wider than that with “hypoplastic, .*”, by [0-9.]+ %", told)
    assert re.search(r"It uses more of its grip: .* Both hold their edges.", told)
    assert "Its afterbody lies less deep" in told
    shares = re.search(r"its grip: ([0-9]\.[0-9]+) against ([0-9]\.[0-9]+)", told)
    assert shares is not None
    elastic, hypoplastic = map(float, shares.groups())
    assert 0.2 < hypoplastic < elastic < 308 / 410
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Synthetic data." in page
    assert "Both hold their edges." in page
    assert "run 5 of 5" in done.stderr
    assert {path.name for path in (tmp_path / "figures").glob("*.png")} == {
        "contacts.png", "along_ski.png", "grip.png", "band.png",
    }  # fmt: skip


def test_site_without_shear_tests_is_refused_in_words(results: Path, tmp_path: Path) -> None:
    experiments = json.loads(results.read_text(encoding="utf-8"))["shear"]["experiments"]
    assert "site A" not in {row["site"] for row in experiments}
    done = run(str(results), str(tmp_path), "--site", "site A", "--runs", "3")
    assert done.returncode == 1
    assert "S_f" in done.stderr
