"""The examples on sand: a campaign of 9 x 7 readings, and the wheel's regression against scipy's."""

import runpy
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

from skisnow import analyse, read_campaign, results_dict
from skisnow.statistics import linear_fit

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT.parent / "shared" / "data" / "plates-in-sand"

pytestmark = pytest.mark.skipif(not DATA.exists(), reason="no ../shared")


def example(name: str) -> dict[str, Any]:
    return runpy.run_path(str(ROOT / "examples" / name))


def run(name: str, *arguments: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", [name, *arguments])
    runpy.run_path(str(ROOT / "examples" / name), run_name="__main__")


def test_plates_campaign(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "new" / "sand"
    run("plates_in_sand.py", str(DATA), "--out", str(folder), monkeypatch=monkeypatch)
    printed = capsys.readouterr().out
    assert printed.count("63 readings of 9 series") == 9
    assert "4 series at 2 " in printed
    campaign = read_campaign(folder)
    tests = campaign.penetration
    assert tests is not None
    assert np.array_equal(np.diff(tests.first), np.full(9, 7))
    assert set(tests.site) == {"sand box"}
    assert np.array_equal(tests.edge_angle, np.zeros(9))
    assert campaign.problems == ()
    assert campaign.shear is None
    areas = {name: float(tool.contact_area(0.01, 0.0)) for name, tool in campaign.tools.items()}
    assert areas == pytest.approx({f"disc {d} mm": np.pi * (d / 1000) ** 2 / 4 for d in (60, 80, 100)}, rel=1e-12)
    # first and last reading of trial 4, as printed in the data: 100 mm, 4.809 mm at 38.142 N to 18.924 mm at 266.735 N
    fourth = tests.series(tests.experiment.index("trial 4"))
    assert fourth.tool == "disc 100 mm"
    np.testing.assert_allclose(fourth.load[[0, -1]], [38.142, 266.735], rtol=1e-12)
    np.testing.assert_allclose(fourth.penetration_depth[[0, -1]], [4.809e-3, 18.924e-3], rtol=1e-12)


def test_the_ranking_and_the_active_bound(tmp_path: Path) -> None:
    """b of F = H_V b V and its rmse by a one-line division; a on its bound: load grows faster than depth."""
    example("plates_in_sand.py")["write_campaign"](DATA, tmp_path / "sand")
    results = results_dict(analyse(tmp_path / "sand"))["penetration"]
    rmse = {row["id"]: row["rmse_N"] for row in results["models"]}
    assert rmse["H_e:a=constant,b=constant"] > rmse["H_A:a=constant,b=constant"] > rmse["H_V:a=constant,b=constant"]
    table = np.genfromtxt(DATA / "plates_large_box_7level.csv", delimiter=",", names=True)
    depth, load = (table[name].reshape(9, 7) for name in ("depth_mm", "load_N"))
    law = load[:, -1:] * depth / depth[:, -1:]  # a disc's V is proportional to its depth
    b = float(np.sum(law * load) / np.sum(law**2))
    rows = {row["id"]: row for row in results["models"]}
    assert rows["H_V:a=none,b=constant"]["b0"] == pytest.approx(b, rel=1e-9)
    assert b < 1
    assert rows["H_V:a=none,b=constant"]["rmse_N"] == pytest.approx(np.sqrt(np.mean((b * law - load) ** 2)), rel=1e-9)
    assert rows["H_V:a=constant,b=constant"]["at_bound"] == ["a"]
    assert rows["H_V:a=linear,b=linear"]["b1"] is None


def test_an_existing_folder_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match="exists already"):
        example("plates_in_sand.py")["write_campaign"](DATA, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_wheel_regression_against_scipy(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    path = DATA / "wheel_lateral_smooth.csv"
    slip_angle, side_force = example("wheel_in_sand.py")["wheel_side_force"](path)
    assert len(slip_angle) == len(side_force) == 189
    # seven angles, 27 runs at each
    np.testing.assert_allclose(np.unique(np.round(np.degrees(slip_angle), 9)), [0, 15, 30, 45, 60, 75, 90], rtol=1e-12)
    fit = linear_fit(side_force, slip_angle)
    peer = stats.linregress(slip_angle, side_force)
    half = stats.t.ppf(0.975, 187) * peer.stderr
    assert fit.coefficients[1] == pytest.approx(peer.slope, rel=1e-10)
    assert fit.coefficients[0] == pytest.approx(peer.intercept, rel=1e-10)
    assert fit.intervals[1] == pytest.approx([peer.slope - half, peer.slope + half], rel=1e-9)
    assert fit.r2 == pytest.approx(peer.rvalue**2, rel=1e-10)
    run("wheel_in_sand.py", str(path), monkeypatch=monkeypatch)
    printed = capsys.readouterr().out
    assert f"{peer.slope:.2f} N per rad" in printed
    assert f"R2 = {peer.rvalue**2:.3f}, n = 189" in printed
