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
    """On snow as hard and as weak in shear as site C's the edge holds at first and then slides across.

    By the grip of an edge in balance: on elastic snow it holds to e = 2 S_f/H_V = 0.6 mm, and 400 N on 1.5 m at 30°
    press it 0.8 mm deep; a groove that stays holds twice as much. So both tracks are wider than the carved one, whose
    heading passes 90° within 5 s, and the elastic one is the wider of the two.
    """
    done = run(str(results), str(tmp_path), "--runs", "4", "--workers", "2")
    assert done.returncode == 0, done.stderr
    apart = re.search(r"up to ([0-9.]+) m apart", done.stdout)
    assert apart is not None
    assert 0.3 < float(apart[1]) < 3.0
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Synthetic data." in page
    numbers = re.findall(r'<th scope="row">(?:hypoplastic|elastic).*?</tr>', page, re.DOTALL)
    turned = [float(re.findall(r'<td class="n">([^<]*)</td>', row)[2]) for row in numbers]
    assert len(turned) == 2
    assert turned[1] < turned[0] < 120.0  # the carved turn of the scenario: 161°
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
