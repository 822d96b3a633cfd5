"""Chrono's terrain files: keys as in those that Chrono brings along, numbers of the scenario; no Chrono reads them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from skisnow import load_scenario
from skisnow._support.errors import ParameterError
from skisnow.geometry.surfaces import Grid
from skisnow.interop.chrono import write_chrono_terrain
from skisnow.scenario.snow_map import SnowMap
from tests.coded import raises


def test_a_terrain_has_the_snow_of_the_scenario(tmp_path: Path) -> None:
    path = write_chrono_terrain(load_scenario("carved-46m"), tmp_path / "chrono", size=(4.0, 2.0), spacing=0.05)
    terrain = json.loads(path.read_text(encoding="utf-8"))
    assert terrain["Template"] == "SCMDeformableTerrain"
    assert terrain["Geometry"] == {"Height": 0.0, "Size": [4.0, 2.0], "Divisions": [80, 40]}
    soil = json.loads((path.parent / terrain["Soil Parameters"]["Input File"]).read_text(encoding="utf-8"))
    assert soil["Soil Parameters"] == {
        "Bekker Kphi": 2e8,
        "Bekker Kc": 0.0,
        "Bekker n": 1.0,
        "Mohr Cohesion": 5e5,
        "Mohr Friction": 0.0,
        "Janosi Shear": pytest.approx(2e-5),
        "Elastic K": 2e9,
        "Dampening R": 0.0,
    }


def test_snow_that_does_not_fit_is_refused(tmp_path: Path) -> None:
    elastic = load_scenario("carved-46m", changes={"snow.unloading_ratio": 1.0})
    with raises(ParameterError, "out_of_range", unloading_ratio=1.0):
        write_chrono_terrain(elastic, tmp_path)
    over = SnowMap(hardness=Grid.along(np.arange(4.0), np.full(4, 2e8)))
    with raises(ParameterError, "no_data"):
        write_chrono_terrain(load_scenario("carved-46m").with_(snow_map=over), tmp_path)
    with raises(ParameterError, "out_of_range", spacing=0.0):
        write_chrono_terrain(load_scenario("carved-46m"), tmp_path, spacing=0.0)
    assert not list(tmp_path.iterdir())
