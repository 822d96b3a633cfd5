"""Readers of studies: STUDY.toml, tables, and the databases of finished points."""

import sqlite3
from collections.abc import Callable
from contextlib import closing
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from skisnow import read_study
from skisnow.design import Measured, measured_ski, read_design
from skisnow.studies import merge_shards, read_table, run_shard, run_study

from ..databases import SQLITE
from ..reader import Files, Reader, single_file
from ..texts import TABLE, Mutation
from ..trees import TOML

_STUDY = """out = "%s"
[fixed]
ski = "slalom"
published = "race-piste"
load_N = 800
unloading_ratio = 10
elements = 20
[latin_hypercube]
n = 6
seed = 1
edge_angle_deg = [30, 60]
"""


@cache
def _computed(out: str) -> Files:
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "study.toml").write_text(_STUDY % out)
        run_study(folder / "study.toml", workers=1)
        return {out: (folder / out).read_bytes(), "study.toml": (_STUDY % out).encode()}


@cache
def _parts() -> Files:
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "study.toml").write_text(_STUDY % "table.csv")
        for number in (1, 2):
            run_shard(folder / "study.toml", f"{number}/2", workers=1)
        return {each.name: _one_file(each) for each in sorted(folder.glob("*shard-?-of-2"))}


def _one_file(place: Path) -> bytes:
    with closing(sqlite3.connect(place)) as database:
        database.execute("pragma journal_mode = delete")
    return place.read_bytes()


@cache
def _partial() -> Files:
    """Both parts in one file, as a study that was stopped before its last point leaves it."""
    one, other = _parts().values()
    with TemporaryDirectory() as name:
        place, beside = Path(name) / "one", Path(name) / "other"
        place.write_bytes(one)
        beside.write_bytes(other)
        with closing(sqlite3.connect(place, isolation_level=None)) as database:
            database.execute("attach ? as other", (str(beside),))
            database.execute("insert into rows select * from other.rows")
        return {"table.csv.partial": _one_file(place), "study.toml": (_STUDY % "table.csv").encode()}


def _read_back(folder: Path, out: str) -> object:
    study = read_study(folder / "study.toml")
    table = read_table(folder / out, study.subject.keys, varied=study.varied)
    return table.counts(), table.answers(), table.csv(), repr(table), table.rows[-1:]


def _gone_on_with(folder: Path) -> object:
    return run_study(read_study(folder / "study.toml"), workers=1).counts()


def _merged(folder: Path) -> object:
    return merge_shards(folder / "merged.csv", sorted(folder.glob("*shard-?-of-2"))).counts()


def _table(out: str, mutations: tuple[Mutation, ...], *covers: str) -> Reader:
    return Reader(
        name=f"study {out}", target=out, files=lambda: _computed(out), read=lambda folder: _read_back(folder, out),
        mutations=mutations, covers=covers,
    )  # fmt: skip


def _rows(name: str, target: str, files: Callable[[], Files], read: Callable[[Path], object], *covers: str) -> Reader:
    return Reader(name=name, target=target, files=files, read=read, mutations=SQLITE, covers=covers)


_DESIGN = """ski = "slalom"
monotone = ["EI_N_m2"]
starts = 8
seed = 1
[variables]
waist_width_mm = [64, 72]
"EI_N_m2[2]" = [200, 300]
[[conditions]]
published = "race-piste"
unloading_ratio = 10
edge_angle_deg = [30, 60]
load_N = 800
[[goals]]
output = "turn_radius_boot_m"
target = 12.0
over = "worst"
[[constraints]]
terms = { tip_width_mm = 1, waist_width_mm = -1 }
at_least = 20
"""

_WIDTHS = """x (mm),width (mm),EI (N m²)
1700,30,100
1580,119.5,120
1200,84,300
840,70.8,450
400,83,300
50,105,120
0,104,100
"""

READERS = (
    single_file("design.toml", _DESIGN.encode(), lambda path: repr(read_design(path)), TOML, "design.task:read_design"),
    single_file(
        "measured ski.csv", _WIDTHS.encode(),
        lambda path: measured_ski(Measured(name="mine", tables=(path,), stations_from="tail", boot=0.8)),
        TABLE, "design.ski_tables:read_ski_table", target="ski.csv",
    ),
    single_file(
        "study.toml", (_STUDY % "table.csv").encode(), lambda path: repr(read_study(path)), TOML,
        "studies.study:read_study",
    ),
    _table("table.csv", TABLE, "studies.table:read_table"),
    _rows("study .partial", "table.csv.partial", _partial, _gone_on_with,
          "_support.processes.kept_rows:KeptRows.__init__"),
    _rows("study shard", "table.csv.shard-1-of-2", _parts, _merged, "_support.processes.kept_rows:KeptRows.__init__"),
)  # fmt: skip
