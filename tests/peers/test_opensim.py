"""OpenSim's own library reads what we write, and we what it writes."""

from __future__ import annotations

import contextlib
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from skisnow import scenario, simulate
from skisnow.interop.opensim import Markers, MotionTable, read_motion, read_trc, write_motion, write_trc
from skisnow.simulate.boots_table import write_boots

with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):  # where it begins a log
    opensim: Any = pytest.importorskip("opensim", reason="OpenSim is not installed: pip install 'skisnow[peers]'")
    opensim.Logger.removeFileSink()

TIME: npt.NDArray[np.float64] = np.array([0.0, 0.01, 0.02, 0.03, 0.04])


def columns_of(table: Any) -> dict[str, list[float]]:
    return {
        name: [float(table.getDependentColumn(name)[i]) for i in range(table.getNumRows())]
        for name in table.getColumnLabels()
    }


@pytest.mark.parametrize("ending", [".mot", ".sto"])
def test_tables_both_ways(tmp_path: Path, ending: str) -> None:
    ours = MotionTable(TIME, {"knee_angle_r": TIME**2 / 3.0, "pelvis_tx": -TIME}, name="ours")
    write_motion(ours, tmp_path / f"ours{ending}")
    theirs = opensim.TimeSeriesTable(str(tmp_path / f"ours{ending}"))
    assert list(theirs.getIndependentColumn()) == TIME.tolist()
    assert columns_of(theirs) == {name: values.tolist() for name, values in ours.columns.items()}
    assert theirs.getTableMetaDataString("inDegrees") == "yes"
    opensim.STOFileAdapter.write(theirs, str(tmp_path / "theirs.sto"))
    again = read_motion(tmp_path / "theirs.sto")
    assert again.columns["knee_angle_r"] == pytest.approx(ours.columns["knee_angle_r"], rel=1e-12)


def test_forces_of_a_run_are_external_loads(tmp_path: Path) -> None:
    run = simulate(scenario("carved-46m").with_(duration_s=0.05))
    write_boots(run, tmp_path / "forces.sto")
    loads = opensim.Storage(str(tmp_path / "forces.sto"))
    assert loads.getSize() == len(run.time)
    assert run.boots is not None
    up = columns_of(opensim.TimeSeriesTable(str(tmp_path / "forces.sto")))["right_ski_force_vy"]
    assert up == pytest.approx(run.boots.force[:, 1, 2].tolist())


def test_markers_both_ways(tmp_path: Path) -> None:
    ours = Markers(TIME, ("heel", "toe"), np.random.default_rng(1).normal(size=(5, 2, 3)), 100.0)
    write_trc(ours, tmp_path / "ours.trc")
    theirs = opensim.MarkerData(str(tmp_path / "ours.trc"))
    assert (theirs.getNumFrames(), theirs.getNumMarkers(), theirs.getDataRate()) == (5, 2, 100.0)
    table = opensim.TimeSeriesTableVec3(str(tmp_path / "ours.trc"))
    toe = [[table.getDependentColumn("toe")[i][axis] for axis in range(3)] for i in range(5)]
    assert np.allclose(toe, ours.of("toe"), rtol=1e-12)
    opensim.TRCFileAdapter.write(table, str(tmp_path / "theirs.trc"))
    again = read_trc(tmp_path / "theirs.trc")
    assert again.names == ours.names
    assert np.allclose(again.place, ours.place, atol=1e-6)
