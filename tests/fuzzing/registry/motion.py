"""Readers of motions and of simulated runs: OpenSim, C3D, run.nc, replays."""

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from skisnow import load_scenario, simulate
from skisnow.interop.opensim import read_c3d, read_motion, read_trc
from skisnow.replay import replay_of_file
from skisnow.replay.page import replay_bytes
from skisnow.report.run.file import write_run_file
from skisnow.simulation.run_summary import summary_dict
from tests.interop.c3d_files import c3d_bytes

from ..binaries import BINARY
from ..netcdf import NETCDF
from ..reader import Reader, single_file
from ..texts import TEXT

_TRC = b"""PathFileType\t4\t(X/Y/Z)\ttwo.trc
DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames
100\t100\t3\t2\tmm\t100\t1\t3
Frame#\tTime\theel\t\t\ttoe\t\t
\t\tX1\tY1\tZ1\tX2\tY2\tZ2

1\t0.00\t1000\t200\t-30\t\t\t
2\t0.01\t1010\t200\t-30\t1300\t200\t-30
3\t0.02\t1020\t201\t-31\t1310\t201\t-31
"""
_MOT = b"""Coordinates
version=1
nRows=3
nColumns=3
inDegrees=yes
endheader
time\tknee\thip
0.0\t10.5\t2e-1
0.01\t11\t0.3
0.02\t12\t0.4
"""


@cache
def run_files() -> dict[str, bytes]:
    """A short run's run.nc, alone in its folder."""
    run = simulate(load_scenario("slalom-20-gates", changes={"run.duration_s": 0.2, "solver.method": "fast"}))
    with TemporaryDirectory() as name:
        write_run_file(run, summary_dict(run)["scenario"], Path(name) / "run.nc")
        return {"run.nc": (Path(name) / "run.nc").read_bytes()}


@cache
def _c3d() -> dict[str, bytes]:
    place = np.random.default_rng(1).normal(0.0, 1.0, (6, 3, 3))
    texts = {"LABELS": ("heel", "toe", "side"), "UNITS": ("m",), "ANGLES": ("knee",)}
    return {"a.c3d": c3d_bytes(place, texts)}


def _drawn(folder: Path) -> object:
    replay = replay_of_file(folder)
    return replay_bytes(replay)


READERS = (
    single_file(
        "markers.trc", _TRC, lambda path: repr(read_trc(path)), TEXT, "interop.opensim:read_trc",
        target="m.trc",
    ),
    single_file(
        "motion.mot", _MOT, lambda path: repr(read_motion(path)), TEXT, "interop.opensim:read_motion",
        target="m.mot",
    ),
    single_file(
        "markers.c3d", _c3d, lambda path: repr(read_c3d(path)), BINARY, "interop.opensim:read_c3d", target="a.c3d"
    ),
    Reader(
        name="run.nc", target="run.nc", files=run_files, mutations=NETCDF, read=_drawn,
        covers=("replay.run_file:replay_of_file",),
    ),
)  # fmt: skip
