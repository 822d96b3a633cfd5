"""FMUs in FMPy, in a process without skisnow and without an environment: they are valid, and run as the run does."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from skisnow import load_scenario, simulate
from skisnow.interop import write_contact_fmu, write_sledge_fmu

from .with_fmpy import DURATION

fmpy = pytest.importorskip("fmpy", reason="FMPy is not installed: pip install 'skisnow[peers]'")


def test_fmpy_runs_them_in_an_empty_environment(tmp_path: Path) -> None:
    asked = load_scenario("carved-46m").with_(duration_s=DURATION)
    paths = [
        *(write_sledge_fmu(asked, tmp_path / f"sledge{fmi}.fmu", fmi=fmi) for fmi in (2, 3)),
        *(write_contact_fmu(asked, tmp_path / f"contact{fmi}.fmu", fmi=fmi, skis=4 - fmi) for fmi in (2, 3)),
    ]
    program = Path(__file__).with_name("with_fmpy.py")
    packages = os.pathsep.join(str(Path(str(each.__file__)).parents[1]) for each in (fmpy, np))
    command: list[str | Path] = [sys.executable, "-S", program, packages, *paths]
    done = subprocess.run(command, env={}, cwd=tmp_path, check=True, capture_output=True, text=True)
    sledge2, sledge3, pair, ski = json.loads(done.stdout.splitlines()[-1])
    run = simulate(asked)
    for end in (sledge2, sledge3):
        assert [end[f"position[{i}]"] for i in (1, 2, 3)] == pytest.approx(run.place[-1], abs=1e-9)
        assert [end[f"velocity[{i}]"] for i in (1, 2, 3)] == pytest.approx(run.velocity[-1], abs=1e-8)
    assert pair["left.force[3]"] == ski["ski.force[3]"] > 0.0
    assert np.isfinite([*pair.values(), *ski.values()]).all()
