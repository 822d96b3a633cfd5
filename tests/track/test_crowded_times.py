"""A track whose times stand still is rejected before the fits take minutes."""

from __future__ import annotations

from pathlib import Path

import pytest

from skisnow import read_track, track_summary
from skisnow._support.errors import ParameterError
from skisnow.track.smoothing import MOST_IN_WINDOW


def test_more_points_at_one_time_than_a_window_holds(tmp_path: Path) -> None:
    path = tmp_path / "crowded.csv"
    rows = [f"{time},{10 * time},0,0" for time in (0, 1, 2, *[3] * (MOST_IN_WINDOW + 5), 4, 5, 6)]
    path.write_text("\n".join(["time_s,x_m,y_m,z_m", *rows]))
    track = read_track(path)
    with pytest.raises(ParameterError, match=r"crowded\.csv.*points are within"):
        track_summary(track)
