"""Readers of the store and of the lab: the SQLite store, uploads, jobs, what a killed process left."""

import json
import sqlite3
from contextlib import closing, suppress
from dataclasses import asdict
from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from skisnow._support.errors import SkisnowError
from skisnow._support.staging import prepare_folder
from skisnow.campaign.store import Journals, Store, export_corrected, replay_journal, sync, write_campaign
from skisnow.web.lab_skis import read_ski_files
from skisnow.web.lab_tracks import Placing, TrackFolders
from skisnow.web.replay_addresses import RunFolders, _ski_of_job
from skisnow.web.runs import Job, Runs
from skisnow.web.settings import Limits
from skisnow.web.uploads import add_uploaded
from tests.campaign.store.test_journal import TOML as _ENTERED
from tests.campaign.store.test_journal import campaign_with

from ..archives import archive
from ..databases import SQLITE
from ..reader import Files, Reader
from ..texts import TABLE, TEXT
from ..trees import JSON, TOML
from .field import _campaign
from .motion import run_files
from .scenario import _SKI_TABLE, _WITH_TABLE

_WITH_SHAPE = b'shape = "ski-def.json"\nmass_kg = 2\nEI_N_m2 = [100, 440, 100]\nGJ_N_m2 = [60, 175, 60]\n'
_LIMITS = Limits(upload_bytes=10_000_000, unpacked_bytes=20_000_000, files=50)
_TRACK = b"time_s,x_m,y_m,z_m\n" + b"".join(b"%.1f,%d,0.5,0\n" % (0.1 * i, i) for i in range(12))


@cache
def _store() -> Files:
    """A store with an added campaign and one that was entered."""
    with TemporaryDirectory() as name:
        place, folder = Path(name) / "store.sqlite3", Path(name) / "day"
        folder.mkdir()
        for file, content in (
            ("campaign.toml", _ENTERED.encode()),
            ("penetration.csv", _campaign()["penetration.csv"]),
        ):
            (folder / file).write_bytes(content)
        with Store.open(place) as store:
            store.add(folder)
            campaign_with(Journals(store), "1.5", "2.25", "3")
        with closing(sqlite3.connect(place)) as database:
            database.execute("pragma wal_checkpoint(truncate)")
            database.execute("pragma journal_mode = delete")
        return {"store.sqlite3": place.read_bytes()}


@cache
def _two_stores() -> Files:
    with TemporaryDirectory() as name:
        place = Path(name) / "group.sqlite3"
        Store.open(place).close()
        with closing(sqlite3.connect(place)) as database:
            database.execute("pragma journal_mode = delete")
        return {**_store(), "group.sqlite3": place.read_bytes()}


def _every_use(folder: Path) -> object:
    """Everything that the command and the lab do with a store; each may be refused."""
    with Store.open(folder / "store.sqlite3", create=False) as store:
        with suppress(SkisnowError):
            for stored in store.list():
                with suppress(SkisnowError):
                    store.show(stored.id)
                    store.contents(stored.id, ("penetration.csv",))
                with suppress(SkisnowError):
                    export_corrected(store, stored.id, folder / f"kept-{stored.name[:20]}")
        with suppress(SkisnowError):
            for head in Journals(store).list():
                with suppress(SkisnowError):
                    (folder / "entered").mkdir(exist_ok=True)
                    write_campaign(replay_journal(Journals(store).entries(head.id)), folder / "entered")
        return store.verify()


def _synchronised(folder: Path) -> object:
    with Store.open(folder / "store.sqlite3") as here, Store.open(folder / "group.sqlite3") as there:
        return sync(here, there)


@cache
def _zipped() -> Files:
    import io
    import zipfile

    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as packed:
        for file in ("campaign.toml", "penetration.csv", "shear.csv"):
            packed.writestr(f"day/{file}", _campaign()[file])
    return {"0": stream.getvalue(), **{f"sound/{name}": content for name, content in _store().items()}}


def _member(rng: Random, name: str, content: bytes) -> bytes:
    return rng.choice(TOML if name.endswith(".toml") else TABLE)(rng, content)


def _uploaded(folder: Path) -> object:
    return add_uploaded(folder / "sound/store.sqlite3", str(folder), ["day.zip"], _LIMITS)


def _job(name: str) -> bytes:
    job = Job(name, "carved-46m", {"run.duration_s": "1"}, "2026-11-01T10:00:00+00:00", state="done")
    return json.dumps(asdict(job)).encode()


_SUMMARY = json.dumps({
    "outcome": "completed", "run_length_m": 12.5, "simulated_s": 1.0, "wall_s": 2.0, "remedy": "",
    "scenario": {"solver": {"method": "fast"}},
}).encode()  # fmt: skip


def _job_files() -> Files:
    return {"run-1/job.json": _job("run-1"), "run-1/summary.json": _SUMMARY}


def _read_jobs(folder: Path) -> object:
    runs = Runs(folder)
    for _ in runs.jobs():
        with suppress(StopIteration):  # it waits for nothing, so needs no event loop
            runs._ended_as(Job("run-1", "", {}, ""), "x", cancelled=False).send(None)
    return runs.jobs(), _ski_of_job(folder / "run-1/job.json")


def _placed(folder: Path) -> object:
    runs = RunFolders(folder)
    tracks = TrackFolders(folder)
    return [tracks.beside(name, runs.replay("run-1")) for name in tracks.names()], tracks.placings()


def _track_files() -> Files:
    placing = json.dumps(asdict(Placing("my track.csv", None, 0.0))).encode()
    return {"run-1/run.nc": run_files()["run.nc"], "tracks/t-1/about.json": placing, "tracks/t-1/track.csv": _TRACK}


_HIDDEN = ".skisnow-abcd1234"
_PLAN = {f"run/{_HIDDEN}/plan": b"summary.json\ntrack.csv\nfigures/a.svg", f"run/{_HIDDEN}/files/summary.json": b"{}"}

READERS = (
    Reader(
        name="plan of a killed process", target=f"run/{_HIDDEN}/plan", files=lambda: _PLAN, mutations=TEXT,
        read=lambda folder: prepare_folder(folder / "run"), covers=("_support.staging:_replace_files",),
    ),
    Reader(
        name="store.sqlite3", target="store.sqlite3", files=_store, read=_every_use, mutations=SQLITE,
        covers=("campaign.store.engine:_engine.open_file", "_support.sqlite_file:connect"),
    ),
    Reader(
        name="store sync", target="group.sqlite3", files=_two_stores, read=_synchronised, mutations=SQLITE,
        covers=("campaign.store.engine:_engine.open_file",),
    ),
    Reader(
        name="upload.zip", target="0", files=_zipped, read=_uploaded, mutations=archive(_member),
        covers=(
            "web.uploads:Unpacking.take_zip", "web.uploads:_unpacked_pieces", "web.uploads:add_uploaded",
            "campaign.store.folder:campaign_name",
        ),
    ),
    Reader(
        name="uploaded ski.toml", target="ski.toml", files=lambda: {"ski.toml": _WITH_TABLE, "table.csv": _SKI_TABLE},
        read=lambda folder: read_ski_files(str(folder), ["ski.toml", "table.csv"]), mutations=TOML,
        covers=("web.lab_skis:read_ski_files", "web.lab_skis:_require_own_files"),
    ),
    Reader(
        name="job.json", target="run-1/job.json", files=_job_files, read=_read_jobs, mutations=JSON,
        covers=("web.runs:Runs.jobs", "web.replay_addresses:_ski_of_job"),
    ),
    Reader(
        name="summary.json", target="run-1/summary.json", files=_job_files, read=_read_jobs, mutations=JSON,
        covers=("web.runs:Runs._ended_as",),
    ),
    Reader(
        name="placing of a track", target="tracks/t-1/about.json", files=_track_files, read=_placed, mutations=JSON,
        covers=("web.lab_tracks:TrackFolders.file", "web.lab_tracks:TrackFolders.placings"),
    ),
)  # fmt: skip
