"""Readers of studies: STUDY.toml, tables, and the databases of finished points."""

import sqlite3
from contextlib import closing
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from skisnow import read_study
from skisnow._support.processes.kept_rows import KeptRows, json_text
from skisnow.design import Measured, measured_ski, read_design
from skisnow.studies import read_table, run_study
from skisnow.studies.run import StudyRows

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
def _partial() -> Files:
    """The finished points of a study that was stopped before its last one."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "study.toml").write_text(_STUDY % "table.csv")
        study = read_study(folder / "study.toml")
        kept, rows = KeptRows.opened(study.partial, study.fingerprint()), StudyRows.of(study)
        kept.add((number, json_text(rows(study.points[number]))) for number in range(5))
        kept.close()
        with closing(sqlite3.connect(study.partial)) as database:
            database.execute("pragma journal_mode = delete")
        return {"table.csv.partial": study.partial.read_bytes(), "study.toml": (_STUDY % "table.csv").encode()}


def _read_back(folder: Path, out: str) -> object:
    study = read_study(folder / "study.toml")
    table = read_table(folder / out, study.subject.keys, varied=study.varied)
    return table.counts(), table.answers(), table.csv(), repr(table), table.rows[-1:]


def _gone_on_with(folder: Path) -> object:
    return run_study(read_study(folder / "study.toml"), workers=1).counts()


def _table(out: str, mutations: tuple[Mutation, ...], *covers: str) -> Reader:
    return Reader(
        name=f"study {out}", target=out, files=lambda: _computed(out), read=lambda folder: _read_back(folder, out),
        mutations=mutations, covers=covers,
    )  # fmt: skip


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
    Reader(
        name="study .partial", target="table.csv.partial", files=_partial, read=_gone_on_with, mutations=SQLITE,
        covers=("_support.processes.kept_rows:KeptRows.__init__",),
    ),
)  # fmt: skip
