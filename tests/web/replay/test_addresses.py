"""A server gives out only runs of the list, whatever is requested."""

import io
import math
import os
import re
from csv import DictReader
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import SkisnowError
from skisnow._support.messages import translated
from skisnow.replay import replay_of_run
from skisnow.track.path_estimate import estimate_path
from skisnow.track.read import read_track
from skisnow.web.lab_tracks import Placing, TrackFolders
from tests.coded import raises

from ...report.runs import circle_run

pytest.importorskip("fastapi", reason="the web lab is not installed: pip install 'skisnow[web]'")
pytest.importorskip("httpx", reason="requests of the test need httpx")

import httpx
from fastapi import FastAPI

from skisnow._support.errors import ParameterError
from skisnow.report.run.file import write_run_file
from skisnow.scenario import scenario_values
from skisnow.scenario.keys import in_sections
from skisnow.web.elements import error_sentence
from skisnow.web.replay_addresses import RunFolders, add_addresses, show_address

from ..finished import finished

ODD = 'a "b" <i>&c%2e'


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("lab") / "runs"
    run = circle_run(count=11)
    for name, when in (("older", 1_000_000_000), (ODD, 1_100_000_000), ("../outside", 1_200_000_000)):
        place = folder / name / "run.nc"
        place.parent.mkdir(parents=True)
        write_run_file(run, in_sections(scenario_values(run.scenario)), place)
        os.utime(place, (when, when))
    (folder / "no run").mkdir()
    (folder / "lab.log").write_text("words", encoding="utf-8")
    return folder


class Client:
    """Asks the application itself: no socket, no server."""

    def __init__(self, app: FastAPI) -> None:
        self.app = app

    def get(self, address: str, params: dict[str, str] | None = None, language: str = "en") -> httpx.Response:
        async def asked() -> httpx.Response:
            transport = httpx.ASGITransport(app=self.app)
            async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
                return await client.get(address, params=params, headers={"accept-language": language})

        return finished(asked())


@pytest.fixture
def client(runs: Path) -> Client:
    app = FastAPI()
    add_addresses(app, RunFolders(runs))
    return Client(app)


@pytest.mark.parametrize("name", ["../outside", "..", "", ".", "no run", "lab.log", "/etc", "older/../older"])
def test_only_names_of_the_list_lead_anywhere(runs: Path, client: Client, name: str) -> None:
    with raises(ParameterError, "unknown_run"):
        RunFolders(runs).folder_of(name)
    assert client.get("/replay/show", params={"run": name}).status_code == 404
    assert client.get("/replay/show", params={"run": "older", "ghost": name or "?"}).status_code == 404
    escaped = name.replace("/", "%2F") or "%20"
    assert client.get(f"/replay/data/{escaped}").status_code == 404


def test_a_kept_track_is_read_in_another_process(runs: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A file that cannot be read is reported under its own name; test_confined.py ends the other process."""
    app, folder, tracks = FastAPI(), RunFolders(tmp_path), TrackFolders(tmp_path)
    add_addresses(app, folder)
    (tmp_path / "older").symlink_to(runs / "older")
    name = tracks.keep(io.BytesIO(b"time_s,x_m,y_m\n0,1,2\n1,3,4\n"), Placing("x.csv"))
    with monkeypatch.context() as patched:
        patched.setattr("skisnow.web.lab_tracks.read_track", lambda _: pytest.fail("it is read here"))
        beside = folder.replay("older", name).track
    assert beside is not None and beside.place[:, :2].tolist() == [[1.0, 2.0], [3.0, 4.0]]
    (tmp_path / "tracks" / name / "track.csv").rename(tmp_path / "tracks" / name / "track.gpx")
    (tmp_path / "tracks" / name / "track.gpx").write_bytes(b"<gpx>" + b"<extensions>" * 2000)
    monkeypatch.setattr("skisnow.web.replay_addresses.confined", lambda _, work, *arguments: work(*arguments))
    answer = Client(app).get("/replay/data/older", params={"track": name})
    assert answer.status_code == 404 and "x.csv" in answer.text


def test_an_odd_name_is_text_on_its_page_and_its_address_leads_there(client: Client) -> None:
    answer = client.get(show_address(ODD, "older"))
    assert answer.status_code == 200
    assert "<i>" not in answer.text
    assert "&lt;i&gt;" in answer.text
    assert client.get("/replay/data/a%20%22b%22%20%3Ci%3E%26c%252e").status_code == 200
    assert "/replay/data/a%20%22b%22%20%3Ci%3E%26c%252e" in answer.text


def test_files_of_the_program_and_no_others(client: Client) -> None:
    assert client.get("/replay/files/replay.css").status_code == 200
    for name in ("show.html", "..%2Fpage.py", "page.py", "LICENSE-three.txt"):
        assert client.get(f"/replay/files/{name}").status_code == 404


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


def test_a_rejected_track_is_explained_in_german_without_a_code(tmp_path: Path) -> None:
    with pytest.raises(ParameterError) as refused:
        TrackFolders(tmp_path).keep(io.BytesIO(b"time_s,x_m,y_m\n0,1,5,2,5\n"), Placing("Lauf 1.csv"))
    german = translated(error_sentence(refused.value), "de")
    assert german.startswith("Lauf 1.csv, Zeile 2: gefunden '2'; erlaubt: 3 Zellen")
    assert "too_many" not in german + str(refused.value)


def test_a_name_that_leads_elsewhere_is_no_track(tmp_path: Path) -> None:
    tracks, replay = TrackFolders(tmp_path), replay_of_run(circle_run(count=21))
    tracks.keep(io.BytesIO(csv([(0, 0, 0, 0), (1, 1, 1, 0)])), Placing("x.csv"))
    for name in ("..", "../tracks", "", "nothing"):
        with raises(SkisnowError, "unknown_track"):
            tracks.beside(name, replay)


@pytest.mark.usefixtures("undrawn")
def test_a_kept_track_has_a_page_of_turns_in_both_languages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Half circles of 12 m at 6 m/s, left then right: two turns, with radius and speed in the table."""
    way = np.arange(0.0, 2.0 * math.pi * 12.0, 1.2)
    heading = np.where(way < math.pi * 12.0, way / 12.0, 2.0 * math.pi - way / 12.0)
    x, y = np.cumsum(1.2 * np.cos(heading)), np.cumsum(1.2 * np.sin(heading))
    places = [(k * 0.2, a, b, 0.0) for k, (a, b) in enumerate(zip(x.tolist(), y.tolist(), strict=True))]
    name = TrackFolders(tmp_path).keep(io.BytesIO(csv(places)), Placing("x.csv"))
    # each process would import the package again; another test checks that they are separate
    monkeypatch.setattr("skisnow.web.replay_addresses.confined", lambda _, work, *arguments: work(*arguments))
    estimates: list[Any] = []

    def estimate_once(*given: Any) -> Any:
        estimates[1:] = []
        estimates.extend([] if estimates else [estimate_path(*given)])
        return estimates[0]

    monkeypatch.setattr("skisnow.track.curvature.estimate_path", estimate_once)  # of one track, eight times
    app = FastAPI()
    add_addresses(app, RunFolders(tmp_path))
    client, page = Client(app), f"/replay/turns?track={name}"
    english, german = client.get(page), client.get(page, language="de")
    assert english.status_code == german.status_code == 200
    sides = [
        [word for word in ("left", "right", "links", "rechts") if f">{word}<" in each.text]
        for each in (english, german)
    ]
    assert sides == [["left", "right"], ["links", "rechts"]]
    assert 'href="/replay"' in english.text  # back to the list of tracks
    radii = [float(each) for each in re.findall(r'data-name="Minimum radius \(m\)">([\d.]+)', english.text)]
    assert radii == pytest.approx([12.0, 12.0], rel=0.05)
    table = client.get(f"/replay/turns/turns.csv?track={name}")
    assert [row["side"] for row in DictReader(io.StringIO(table.text))] == ["left", "right"]
    assert table.headers["content-disposition"].endswith(f"{name}-turns.csv")
    assert client.get(f"/replay/turns/track.gpx?track={name}").status_code == 404  # in the axes of a slope
    both = client.get(f"{page}&other={name}", language="de")
    assert both.status_code == 200 and both.text.count("<img ") == 1 and both.text.count('id="table-turns_') == 2
    assert "from above" not in both.text
    assert client.get(f"{page}&other=nothing").status_code == 404
    found = [client.get(f"/replay/turns{file}?track=nothing").status_code for file in ("", "/turns.csv")]
    assert found == [404, 404]
    assert client.get(f"/replay/turns/about.json?track={name}").status_code == 404


def test_a_kept_track_of_a_receiver_is_a_gpx_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    places = [(8.0 * k, 0.0) for k in range(30)]
    name = TrackFolders(tmp_path).keep(io.BytesIO(gpx(places)), Placing("x.gpx"))
    monkeypatch.setattr("skisnow.web.replay_addresses.confined", lambda _, work, *arguments: work(*arguments))
    app = FastAPI()
    add_addresses(app, RunFolders(tmp_path))
    answer = Client(app).get(f"/replay/turns/track.gpx?track={name}")
    assert answer.status_code == 200
    (tmp_path / "again.gpx").write_text(answer.text, encoding="utf-8")
    assert len(read_track(tmp_path / "again.gpx").time) == 30
