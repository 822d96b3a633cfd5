"""Points made from their numbers are those of a list, and so is the study's fingerprint."""

from __future__ import annotations

import hashlib
import itertools
import json
import tracemalloc
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pytest

from skisnow._support.errors import ParameterError
from skisnow.studies import Study, read_study
from skisnow.studies.points import GridPoints, ListedPoints, Points, SampledPoints
from skisnow.studies.rows import StoredRows

HEAD = 'out = "t.csv"\n[fixed]\nski = "slalom"\npublished = "race-piste"\nunloading_ratio = 10\n'
GRID = (
    HEAD + "[grid]\nload_N = [400, 800]\nat_rest = [true, false]\nedge_angle_deg = { from = 10, to = 60, n = 1234 }\n"
)
SAMPLE = (
    HEAD.replace('ski = "slalom"\n', "") + '[latin_hypercube]\nn = 2345\nseed = 7\nski = ["slalom", "giant-slalom"]\n'
    "load_N = { from = 300, to = 1500, log = true }\nelements = { from = 40, to = 80 }\nedge_angle_deg = [20, 30]\n"
)


def study_of(text: str, folder: Path) -> Study:
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    return read_study(path)


def fingerprint_of_list(study: Study) -> str:
    """As documented: for everything at once."""
    text = json.dumps([version("skisnow"), study.columns, list(study.points)])
    return hashlib.sha256(text.encode()).hexdigest()[:16]


@pytest.mark.parametrize(("text", "kind"), [(GRID, GridPoints), (SAMPLE, SampledPoints)])
def test_a_study_has_the_fingerprint_of_the_list_of_its_points(text: str, kind: type[Points], tmp_path: Path) -> None:
    study = study_of(text, tmp_path)
    assert isinstance(study.points, kind)
    assert study.fingerprint() == fingerprint_of_list(study)
    listed = Study(study.file, study.out, study.subject, study.varied, list(study.points))
    assert isinstance(listed.numbered, ListedPoints)
    assert listed.fingerprint() == study.fingerprint()


def test_a_grid_is_every_combination_with_the_last_axis_fastest() -> None:
    axes: dict[str, list[Any]] = {"a": [1, 2], "b": ["x", "ü"], "c": [0.1, True, [1.0, 2.0]]}
    points = GridPoints({"fixed": 3}, axes)
    wanted = [{"fixed": 3, "a": a, "b": b, "c": c} for a, b, c in itertools.product(*axes.values())]
    assert points == wanted
    assert [points[number] for number in range(len(points))] == wanted == list(points)
    assert (points[-1], points[3:9:2]) == (wanted[-1], wanted[3:9:2])
    assert [list(point) for point in points] == [list(point) for point in wanted]  # the order of the columns, too
    with pytest.raises(IndexError):
        points[len(wanted)]
    assert f"[{', '.join(points.json_texts())}]" == json.dumps(wanted)
    assert (points.distinct("b"), points.distinct("fixed"), points.distinct("z")) == (["x", "ü"], [3], [])


def test_a_sample_holds_each_slice_of_each_axis_once(tmp_path: Path) -> None:
    points = study_of(SAMPLE, tmp_path).points
    loads = sorted(point["load_N"] for point in points)
    n = len(loads)
    assert all(300 * 5 ** (place / n) <= load <= 300 * 5 ** ((place + 1) / n) for place, load in enumerate(loads))
    assert {type(point["elements"]) for point in points[:9]} == {int}
    assert {point["ski"] for point in points} == {"slalom", "giant-slalom"}
    assert points[17] == list(points)[17]


def test_a_million_points_take_no_memory(tmp_path: Path) -> None:
    """Eight megabytes for each axis of a sample, next to nothing for a grid; a list of them would take 400 MB."""
    texts = (GRID.replace("[400, 800]", "{ from = 300, to = 900, n = 405 }"), SAMPLE.replace("n = 2345", "n = 100_000"))
    for text, most in zip(texts, (5e6, 10e6), strict=True):
        tracemalloc.start()
        study = study_of(text, tmp_path)
        assert tracemalloc.get_traced_memory()[1] < most, len(study.points)
        tracemalloc.stop()
    assert len(study_of(texts[0], tmp_path).points) == 405 * 2 * 1234


def test_rows_and_points_are_equal_to_sequences_alone() -> None:
    assert GridPoints({}, {"a": [1]}) != 3
    assert GridPoints({}, {"a": [1]}) != [{"a": 2}]

    class One(StoredRows):
        def block(self, number: int) -> list[dict[str, Any]]:
            return [{"a": number}]

    assert One(1) == [{"a": 0}]
    assert One(1) != 3


@pytest.mark.parametrize(
    ("grid", "points"),
    [
        ("edge_angle_deg = { from = 10, to = 60, n = 1_000_000_000_000 }", 1_000_000_000_000),
        ("edge_angle_deg = { from = 10, to = 60, n = 1001 }\nload_N = { from = 400, to = 800, n = 1000 }", 1_001_000),
        ("edge_angle_deg = [10, 20]\nload_N = { from = 400, to = 800, n = 500_001 }", 1_000_002),
    ],
)
def test_more_points_than_anybody_waits_for_take_no_memory(grid: str, points: int, tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=f"{points} points"):
        study_of(f"{HEAD}[grid]\n{grid}\n", tmp_path)
