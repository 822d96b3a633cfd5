"""OpenSim's own library reads what we write, and we what it writes."""

import contextlib
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow import load_scenario, simulate
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.interop.opensim import Markers, MotionTable, read_motion, read_trc, write_motion, write_trc
from skisnow.simulation.run_tables import write_boots

with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):  # where it begins a log
    opensim: Any = pytest.importorskip("opensim", reason="OpenSim is not installed: pip install 'skisnow[peers]'")
    opensim.Logger.removeFileSink()

TIME: FloatArray = np.array([0.0, 0.01, 0.02, 0.03, 0.04])


def columns_of(table: Any) -> dict[str, list[float]]:
    return {
        name: [float(table.getDependentColumn(name)[i]) for i in range(table.getNumRows())]
        for name in table.getColumnLabels()
    }


@pytest.mark.parametrize("ending", [".mot", ".sto"])
def test_tables_both_ways(tmp_path: Path, ending: str) -> None:
    ours = MotionTable(TIME, {"knee_angle_r": TIME**2 / 3.0, "pelvis_tx": -TIME}, in_degrees=True, name="ours")
    write_motion(ours, tmp_path / f"ours{ending}")
    theirs = opensim.TimeSeriesTable(str(tmp_path / f"ours{ending}"))
    assert list(theirs.getIndependentColumn()) == TIME.tolist()
    assert columns_of(theirs) == {name: values.tolist() for name, values in ours.columns.items()}
    assert theirs.getTableMetaDataString("inDegrees") == "yes"
    opensim.STOFileAdapter.write(theirs, str(tmp_path / "theirs.sto"))
    again = read_motion(tmp_path / "theirs.sto")
    assert again.columns["knee_angle_r"] == pytest.approx(ours.columns["knee_angle_r"], rel=1e-12)


HEADS = {
    "stated": "Coordinates\nversion=1\ninDegrees=yes\n",
    "denied": "Coordinates\nversion=1\ninDegrees=no\n",
    "abbreviated": "Coordinates\nversion=1\ninDegrees = Y\n",
    "silent": "Coordinates\nversion=1\n",
    "adapter": "DataType=double\nversion=3\nOpenSimVersion=4.4\n",
    "old": "Coordinates\n",
    "first line": "inDegrees=yes\nversion=1\n",
}


@pytest.mark.parametrize("ending", [".mot", ".sto"])
@pytest.mark.parametrize("head", HEADS)
def test_angles_are_in_degrees_where_opensim_reads_degrees(tmp_path: Path, head: str, ending: str) -> None:
    path = tmp_path / f"a{ending}"
    table = "nRows=2\nnColumns=2\nendheader\ntime\tknee_angle_r\n0\t0.5\n0.1\t0.7\n"
    path.write_text(HEADS[head] + table, encoding="utf-8")
    if (head, ending) == ("old", ".mot"):  # OpenSim guesses by the ending
        with pytest.raises(ParameterError):
            read_motion(path)
        return
    assert read_motion(path).in_degrees == opensim.Storage(str(path)).isInDegrees()
    write_motion(read_motion(path), tmp_path / "again.sto")
    assert opensim.Storage(str(tmp_path / "again.sto")).isInDegrees() == opensim.Storage(str(path)).isInDegrees()


def test_forces_of_a_run_are_external_loads(tmp_path: Path) -> None:
    run = simulate(load_scenario("carved-46m").with_(duration_s=0.05))
    write_boots(run, tmp_path / "forces.sto")
    loads = opensim.Storage(str(tmp_path / "forces.sto"))
    assert loads.getSize() == len(run.time)
    assert run.boots is not None
    up = columns_of(opensim.TimeSeriesTable(str(tmp_path / "forces.sto")))["right_ski_force_vy"]
    assert up == pytest.approx(run.boots.force[:, 1, 2].tolist())
    named = opensim.ExternalLoads(str(tmp_path / "forces_external_loads.xml"), True)
    assert named.getSize() == 2
    assert named.get(1).get_applied_to_body() == "calcn_r"
    assert named.getDataFileName() == "forces.sto"


def test_markers_survive_export_and_import(tmp_path: Path) -> None:
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
