"""A measured track is stored, rejected in words, and drawn beside a run."""

from __future__ import annotations

import io
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import SkisnowError
from skisnow.replay import replay_of_run
from skisnow.web.lab_tracks import LARGEST_TRACK_BYTES, MOST_POINTS, Placing, TrackFolders
from tests.coded import raises

from ...report.runs import circle_run
from ..conftest import has_text
from .test_lab_page import kept

EARTH = 6_371_000.0  # m; a sphere is within half a percent of the ellipsoid's radii


def gpx(points: list[tuple[float, float]]) -> bytes:
    """Metres east and north of a point at 47° N, a second apart."""
    lines = []
    for second, (east, north) in enumerate(points):
        latitude = 47.0 + math.degrees(north / EARTH)
        longitude = 11.0 + math.degrees(east / (EARTH * math.cos(math.radians(47.0))))
        time = f"2026-02-01T10:00:{second:02d}Z"
        lines.append(f'<trkpt lat="{latitude:.9f}" lon="{longitude:.9f}"><time>{time}</time></trkpt>')
    text = f"<trk><trkseg>{''.join(lines)}</trkseg></trk>"
    return f'<gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1">{text}</gpx>'.encode()


def csv(points: list[tuple[float, float, float, float]]) -> bytes:
    rows = "".join(f"{t},{x},{y},{z}\n" for t, x, y, z in points)
    return f"time_s,x_m,y_m,z_m\n{rows}".encode()


def test_towards_the_fall_line_is_down_and_left_of_it_is_left(tmp_path: Path) -> None:
    """The slope falls to the east: north is left of who looks down it."""
    tracks, replay = TrackFolders(tmp_path), replay_of_run(circle_run(count=21))
    name, count = tracks.keep(io.BytesIO(gpx([(0, 0), (10, 0), (10, 5)])), Placing("Run 1.gpx", 90.0, 0.5))
    assert count == 3 and name.startswith("Run-1-") and tracks.names() == [name]
    beside = tracks.beside(name, replay)
    # without heights the points lie on the plane of 10°: 10 m from above are 10 m / cos 10° along it; sideways to
    # 0.1 mm: a circle of latitude is not quite straight
    down = 10.0 / math.cos(replay.tilt)
    assert replay.tilt == pytest.approx(math.radians(10.0))
    assert beside.place[:, :2] == pytest.approx(np.array([[0, 0], [down, 0], [down, 5]]), rel=5e-3, abs=1e-4)
    assert beside.time == pytest.approx([0.5, 1.5, 2.5])
    assert beside.name == "Run 1.gpx"


@pytest.mark.parametrize(
    ("content", "placing", "code"),
    [
        (b"no track at all", Placing("x.gpx"), ""),
        (b"", Placing("x.csv"), ""),
        (gpx([(0, 0)]), Placing("x.gpx", 0.0), "too_few_points"),
        (b" " * (LARGEST_TRACK_BYTES + 1), Placing("x.csv"), "too_large"),
        (csv([(i, i, 0, 0) for i in range(MOST_POINTS + 1)]), Placing("x.csv"), "too_many_points"),
    ],
)
def test_what_is_no_track_is_refused_and_leaves_nothing(
    tmp_path: Path, content: bytes, placing: Placing, code: str
) -> None:
    tracks = TrackFolders(tmp_path)
    with pytest.raises(SkisnowError) as refused:
        tracks.keep(io.BytesIO(content), placing)
    assert str(tmp_path) not in str(refused.value)
    assert refused.value.code == code
    assert tracks.names() == []
    assert list(tmp_path.glob("tracks/*")) == []


def test_a_name_that_leads_elsewhere_is_no_track(tmp_path: Path) -> None:
    tracks, replay = TrackFolders(tmp_path), replay_of_run(circle_run(count=21))
    tracks.keep(io.BytesIO(csv([(0, 0, 0, 0), (1, 1, 1, 0)])), Placing("x.csv"))
    for name in ("..", "../tracks", "", "nothing"):
        with raises(SkisnowError, "unknown_track"):
            tracks.beside(name, replay)


@pytest.mark.slow
def test_a_track_is_added_and_drawn_beside_a_run(served: Any, page: Any, tmp_path: Path) -> None:
    kept(served.store.parent / "lab", "turn")
    (tmp_path / "wrong <b>.gpx").write_bytes(b"<gpx>")
    (tmp_path / "measured.gpx").write_bytes(gpx([(2.0 * i, -3.0 * i) for i in range(5)]))
    address = f"{served.address.rstrip('/')}/replay"

    def add(file: str, azimuth: str) -> None:
        page.goto(address)
        page.locator("summary", has_text="Add a measured track").press("Enter")
        page.get_by_label("Track", exact=True).set_input_files(tmp_path / file)
        page.get_by_label("Direction of the fall line (°), clockwise from north").fill(azimuth)
        page.get_by_role("button", name="Add the track").press("Enter")

    add("wrong <b>.gpx", "")
    page.get_by_role("heading", name="This was not imported").wait_for()
    page.get_by_text("wrong <b>.gpx").wait_for()
    add("measured.gpx", "180")
    page.get_by_text("Choose the run to compare it with.").wait_for()
    (name,) = TrackFolders(served.store.parent / "lab").names()
    has_text(page.get_by_label("Measured track beside it"), name)
    page.get_by_role("button", name="Watch together").click()
    page.wait_for_function("window.skisnowReplay || document.querySelector('[role=alert]')")
    assert page.get_by_role("alert").all_inner_texts() == []
    page.get_by_text("Measured: measured.gpx").wait_for()
    last = page.evaluate("[...skisnowReplay.run.arrays.track_place.values].slice(-3)")
    # down to the south: 12 m along a plane of 10°, and to the left, which is east: 8 m
    assert last[:2] == pytest.approx([12.0 / math.cos(math.radians(10.0)), 8.0], rel=5e-3)
    assert page.evaluate("skisnowReplay.stage.track.mesh.visible") is True
    page.go_back()
    page.set_viewport_size({"width": 390, "height": 844})
    page.goto(address)
    page.locator("summary", has_text="Add a measured track").press("Enter")
    page.get_by_role("button", name="Add the track").wait_for()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390


def test_a_track_from_another_site_is_refused(served: Any) -> None:
    import urllib.error
    import urllib.request

    request = urllib.request.Request(
        f"{served.address.rstrip('/')}/replay/track", data=b"", headers={"Origin": "http://evil.example"}
    )
    with pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(request)
    refused.value.close()
    assert refused.value.code == 403
