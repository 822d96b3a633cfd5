"""Sample files: readable, the same for a seed, and those that the pages show."""

import importlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from skisnow import check_campaign, read_ski, read_track, track_summary
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import OutputError
from skisnow.campaign import read_snow_micro_pen
from skisnow.campaign.caaml import read_caaml
from skisnow.campaign.smet import read_smet
from skisnow.cli import main
from skisnow.identification.data_tables import read_photo_cells
from skisnow.samples import glide_time, write_samples

SHIPPED = Path(__file__).resolve().parents[2] / "src" / "skisnow" / "samples" / "files"


@pytest.fixture(scope="module")
def samples(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("samples")
    write_samples(folder)
    return folder


def test_the_same_seed_writes_the_same_bytes(samples: Path, tmp_path: Path) -> None:
    again, other = tmp_path / "again", tmp_path / "other"
    paths = write_samples(again, seed=1)
    assert [path.relative_to(again) for path in paths] == sorted(
        path.relative_to(samples) for path in samples.rglob("*") if path.is_file()
    )
    assert all(path.read_bytes() == (samples / path.relative_to(again)).read_bytes() for path in paths)
    write_samples(other, seed=2)
    assert (other / "measured.csv").read_bytes() != (samples / "measured.csv").read_bytes()


def test_a_folder_with_files_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine", encoding="utf-8")
    with pytest.raises(OutputError):
        write_samples(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_campaigns_have_the_errors_that_are_stated(samples: Path) -> None:
    def errors(folder: str) -> list[str]:
        return [problem.code for problem in check_campaign(samples / folder) if problem.severity == "error"]

    assert errors("plan") == ["out_of_range", "not_a_number"]
    assert errors("2024-01-12") == errors("campaign") == []


def test_tracks_of_a_day(samples: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skisnow.track.curvature.estimate_path", lambda *_: None)  # seconds, and only for the speed
    day = track_summary(read_track(samples / "day.gpx"))
    assert (len(day.day.runs), len(day.day.lifts)) == (3, 2)
    assert main(["track", str(samples / "run.gpx"), "--course", str(samples / "course.gpx"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["gates_passed"] == 8
    assert len(read_track(samples / "measured.csv").time) == len(read_track(samples / "measured.gpx").time) == 51


def test_snow_is_read(samples: Path) -> None:
    assert len(read_caaml(samples / "pit.caaml").layers) == 2
    assert float(np.nanmax(read_smet(samples / "weather.smet").fields["TA"])) == pytest.approx(272.0, abs=1.0)
    force = read_snow_micro_pen(samples / "snow_micro_pen.PNT").force
    assert float(force[:7000].max()) < 0.05
    assert float(force[8000:].min()) > 1.0


def test_a_ski_is_measured(samples: Path, tmp_path: Path) -> None:
    tables = [word for name in ("widths.csv", "flex.csv") for word in ("--table", str(samples / name))]
    stations = ("--stations-from", "tail", "--boot-mm", "780")
    assert main(["new", "ski", str(tmp_path / "mine.toml"), *tables, *stations]) == 0
    ski = read_ski(tmp_path / "mine.toml")
    assert ski.length == pytest.approx(1.593)
    middle = ski.bending_stiffness[np.argmin(np.abs(ski.station + 0.06))]
    assert middle == pytest.approx(196.2 * 0.4**3 / (48 * 0.98e-3), rel=0.15)  # F L³/(48 w) of a uniform ski


def test_identification_files_are_read(samples: Path) -> None:
    assert [len(run.station) for run in read_photo_cells(samples / "cells.csv").runs] == [7, 7]


def test_glides_take_the_time_of_the_motion() -> None:
    """Against the equation of motion, integrated: v dv/ds = g (sin α − μ cos α) − ρ C_dA v²/(2 m)."""

    def slowness_and_change(_: float, state: FloatArray) -> list[float]:
        speed = state[1]
        pull = 9.81 * (np.sin(slope) - 0.03 * np.cos(slope)) - 1.2 * 0.42 / (2.0 * 80.0) * speed**2
        return [1.0 / speed, pull / speed]

    slope = np.radians(10.0)
    motion = solve_ivp(slowness_and_change, (0.0, 80.0), [0.0, 2.0], t_eval=[5.0, 80.0], rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(glide_time(np.array([5.0, 80.0]), speed=2.0, slope_angle=slope), motion.y[0], rtol=1e-8)


@pytest.mark.parametrize(
    ("page", "name", "shipped"),
    [
        ("how-to/study.md", "grip.toml", "grip.toml"),
        ("how-to/simulate.md", "runs.toml", "runs.toml"),
        ("how-to/boots.md", "edges.csv", "edges.csv"),
        ("how-to/enter-a-campaign.md", "campaign.toml", "plan/campaign.toml"),
        ("how-to/enter-a-campaign.md", "penetration.csv", "plan/penetration.csv"),
        ("how-to/enter-a-campaign.md", "shear.csv", "plan/shear.csv"),
    ],
)
def test_files_that_pages_show_are_the_samples(page: str, name: str, shipped: str) -> None:
    numbers: Any = importlib.import_module("page_numbers")
    assert numbers.page_files(page)[name] == (SHIPPED / shipped).read_text(encoding="utf-8")
