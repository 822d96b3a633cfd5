"""A ski as MJCF, without MuJoCo: the text's numbers."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow import load_scenario, read_ski
from skisnow._support.errors import ParameterError
from skisnow.cli import main
from skisnow.geometry.surfaces import Grid
from skisnow.interop.chrono import write_chrono_terrain
from skisnow.interop.mujoco import rigid_ski_geoms, ski_mjcf
from skisnow.scenario.snow_map import SnowMap
from tests.coded import raises


def test_compliances_and_masses_of_the_hinges_add_up(tmp_path: Path) -> None:
    ski, path = read_ski("carver"), tmp_path / "ski.xml"
    assert main(["export", "mjcf", "carver", "--out", str(path)]) == 0
    root = ET.fromstring(path.read_text(encoding="utf-8"))
    along = np.linspace(ski.station[-1], ski.station[0], 20_001)
    at = ski.at(along)
    mass = sum(float(each.attrib["mass"]) for each in root.iter("inertial"))
    assert mass == pytest.approx(np.trapezoid(at.mass_per_length, along), rel=1e-6)
    bend = [1.0 / float(each.attrib["stiffness"]) for each in root.iter("joint") if "front" in each.attrib["name"]
            and "bend" in each.attrib["name"]]  # fmt: skip
    front = along > 0.15
    # from the binding to the middle of the last segment
    whole = np.trapezoid(1.0 / at.bending_stiffness[front], along[front])
    last = (along > along[-1] - 0.5 * (along[-1] - 0.15) / len(bend)) & front
    assert sum(bend) == pytest.approx(whole - np.trapezoid(1.0 / at.bending_stiffness[last], along[last]), rel=1e-3)
    assert [each.attrib["name"] for each in root.iter("site")] == ["boot"]


def test_a_name_with_signs_of_xml_comes_back() -> None:
    name = 'a & b <c> "d" &amp;'
    assert ET.fromstring(ski_mjcf(replace(read_ski("carver"), name=name))).attrib["model"] == name


def test_what_cannot_be_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ski = read_ski("carver")
    changes: tuple[dict[str, Any], ...] = ({"segments": 2}, {"clamp_length": 3.0}, {"damping": -1.0})
    for change in changes:
        with raises(ParameterError, "out_of_range") as caught:
            ski_mjcf(ski, **change)
        assert min(change) in str(caught.value)
    assert main(["export", "mjcf", "carver", "--out", str(tmp_path / "ski.txt")]) == 1
    assert ".xml" in capsys.readouterr().err


def test_a_rigid_ski_is_boxes_that_touch_nothing() -> None:
    boxes = ET.fromstring(f"<ski>{rigid_ski_geoms(read_ski('slalom'), segments=10)}</ski>")
    assert len(boxes) == 10
    assert {box.attrib["contype"] for box in boxes} == {"0"}
    assert {box.attrib["mass"] for box in boxes} == {"0"}


def test_the_boxes_of_a_rigid_ski_lie_on_its_base() -> None:
    """Axes x ahead, y left, z up: a turn about y by a positive angle takes the front end down."""
    ski = read_ski("slalom")
    for box in ET.fromstring(f"<ski>{rigid_ski_geoms(ski, segments=10)}</ski>"):
        x, y, z = map(float, box.attrib["pos"].split())
        roll, pitch, yaw = map(float, box.attrib["euler"].split())
        half, wide, thick = map(float, box.attrib["size"].split())
        assert (y, roll, yaw) == (0.0, 0.0, 0.0)
        ends = ski.at(np.array([x - half, x, x + half]))
        assert wide == pytest.approx(ends.width[1] / 2.0)
        under = z - thick + np.array([1.0, -1.0]) * half * np.tan(pitch)
        assert under == pytest.approx(ends.base_height[[0, 2]], abs=1e-9)


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
