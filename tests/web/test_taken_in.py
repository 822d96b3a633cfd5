"""Files that are sent to the lab: what is taken in, where the page goes on, what is told in the reader's language."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest

pytest.importorskip("nicegui", reason="the web lab is not installed")

import httpx
from fastapi import FastAPI

from skisnow._support.errors import FieldDataError, ParameterError
from skisnow.campaign.store import Store
from skisnow.ski import read_ski
from skisnow.web import layout
from skisnow.web.lab_skis import LabSkis
from skisnow.web.lab_tracks import TrackFolders
from skisnow.web.replay_addresses import add_track_uploads
from skisnow.web.settings import Lab
from skisnow.web.ski_uploads import add_ski_uploads

from .finished import finished

SKI = LabSkis(Path("nowhere")).texts("carver")[0].encode()
TRACK = b"time_s,x_m,y_m\n0,1,2\n1,3,4\n"


def answer(
    app: FastAPI, path: str, files: list[tuple[str, bytes]], field: str, language: str = "en", **texts: str
) -> httpx.Response:
    async def asked() -> httpx.Response:
        transport = httpx.ASGITransport(app=app)
        async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
            sent = [(field, (name, content)) for name, content in files]
            return await client.post(path, data=texts, files=sent, headers={"accept-language": language})

    return finished(asked())


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    return Lab(Store.open(tmp_path / "store.sqlite3"), tmp_path / "runs")


def test_a_ski_is_taken_in_under_its_new_name(lab: Lab) -> None:
    app = FastAPI()
    add_ski_uploads(app, lab)
    found = answer(app, "/skis/add", [("ski.toml", SKI)], "files", name="my ski")
    assert (found.status_code, found.headers["location"]) == (303, "/skis?ski=my%20ski&added=1")
    assert read_ski(LabSkis(lab.runs).word("my ski")).name == "my ski"
    again = answer(app, "/skis/add", [("ski.toml", SKI)], "files", name="my ski")
    assert again.status_code == 400
    assert "Nothing was stored: there is a ski my ski already" in again.text


@pytest.mark.parametrize(
    ("files", "english", "german"),
    [
        ([("", b"")], "no file was chosen", "Datei"),
        ([("a.toml", b"x")] * 4, "at most 3 files at once are taken in", "höchstens 3 Dateien auf einmal"),
    ],
)
def test_skis_that_are_not_taken_in(lab: Lab, files: list[tuple[str, bytes]], english: str, german: str) -> None:
    app = FastAPI()
    add_ski_uploads(app, lab)
    for language, said in (("en", english), ("de", german)):
        found = answer(app, "/skis/add", files, "files", language, name="mine")
        assert found.status_code == 400
        assert said in found.text
        assert f'lang="{language}"' in found.text
    assert LabSkis(lab.runs).saved() == []


def test_a_track_is_taken_in_with_what_places_it(tmp_path: Path) -> None:
    app, tracks = FastAPI(), TrackFolders(tmp_path)
    add_track_uploads(app, tracks)
    found = answer(app, "/replay/track", [("Hang 1.csv", TRACK)], "file", azimuth="", start="2.5")
    (name,) = tracks.names()
    assert (found.status_code, found.headers["location"]) == (303, f"/replay?track={name}")
    assert name.startswith("Hang-1")
    for language, said in (("en", "This was not taken in"), ("de", "Das wurde nicht angenommen")):
        wrong = answer(app, "/replay/track", [("a.csv", TRACK)], "file", language, azimuth="north")
        assert wrong.status_code == 400
        assert said in wrong.text
        twice = answer(app, "/replay/track", [("a.csv", TRACK)] * 2, "file", language)
        assert twice.status_code == 400
        assert said in twice.text
    assert tracks.names() == [name]


def test_an_error_of_ours_says_what_to_do_and_another_has_a_reference(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = logging.getLogger("skisnow.test-of-errors")
    monkeypatch.setattr(layout, "LOG", log)
    layout.log_to(tmp_path / "new" / "lab.log")
    assert layout.error_sentence(ParameterError("write it so")) == "write it so"
    assert layout.error_sentence(FieldDataError(["a", "b"])) == "The campaign cannot be used as it is: a\nb"
    try:
        raise KeyError("inside")
    except KeyError as error:
        told = layout.error_sentence(error)
    reference = told.rsplit("Reference: ", 1)[1].rstrip(".")
    kept = (tmp_path / "new" / "lab.log").read_text(encoding="utf-8")
    assert f"ERROR reference {reference}" in kept
    assert "KeyError: 'inside'" in kept
    assert "inside" not in told
    assert log.level == logging.INFO
    assert not log.propagate
    for handler in log.handlers:
        handler.close()
