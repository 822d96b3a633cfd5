"""track.csv: the contract's columns in their units."""

import csv
import io
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skisnow.scenario import load_scenario
from skisnow.simulation.run_tables import COLUMNS, track_csv, write_track

from .straight_run import STRAIGHT, straight_run

HEAD = (
    "time_s,x_m,y_m,z_m,speed_m_per_s,heading_deg,turn_radius_m,"
    "left_x_m,left_y_m,left_depth_mm,right_x_m,right_y_m,right_depth_mm,"
    "left_total_force_N,right_total_force_N,left_normal_force_N,right_normal_force_N"
)


def rows_of(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text)))


def test_columns_are_those_of_the_contract() -> None:
    text = track_csv(straight_run(load_scenario("carved-46m", changes=STRAIGHT)))
    assert text.splitlines()[0] == HEAD == ",".join(COLUMNS)
    assert len(rows_of(text)) == 201  # 2 s in steps of 10 ms, both ends


def test_numbers_have_their_units_and_all_digits() -> None:
    run = straight_run(load_scenario("carved-46m", changes={**STRAIGHT, "y_m": 3.0}))
    turned = replace(run, heading=np.full(len(run.time), -math.pi / 6.0))
    row = rows_of(track_csv(turned))[100]
    assert float(row["time_s"]) == 1.0
    # 5 t + a t²/2 with a = 9.81 (sin 10° - 0.05 cos 10°), by hand
    assert float(row["x_m"]) == pytest.approx(5.0 + (1.703488622912587 - 0.483048202852488) / 2.0, rel=1e-12)
    assert float(row["speed_m_per_s"]) == pytest.approx(5.0 + 1.703488622912587 - 0.483048202852488, rel=1e-12)
    assert float(row["heading_deg"]) == pytest.approx(-30.0, rel=1e-12)
    assert float(row["left_y_m"]) - float(row["right_y_m"]) == pytest.approx(0.5, rel=1e-12)
    assert (float(row["left_depth_mm"]), float(row["right_depth_mm"])) == pytest.approx((4.0, 8.0), rel=1e-12)
    assert row["left_x_m"] == row["right_x_m"] == row["x_m"] == repr(float(run.place[100, 0]))


def test_radius_is_empty_where_the_path_is_straight() -> None:
    run = straight_run(load_scenario("carved-46m", changes=STRAIGHT))
    radius = run.turn_radius.copy()
    radius[1] = -12.5
    found = [row["turn_radius_m"] for row in rows_of(track_csv(replace(run, turn_radius=radius)))]
    assert found[:3] == ["", "-12.5", ""]


def test_file_is_the_text(tmp_path: Path) -> None:
    run = straight_run(load_scenario("carved-46m", changes=STRAIGHT))
    write_track(run, tmp_path / "track.csv")
    assert (tmp_path / "track.csv").read_text(encoding="utf-8") == track_csv(run)
    assert [path.name for path in tmp_path.iterdir()] == ["track.csv"]
