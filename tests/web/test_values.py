"""Values between the browser, the pages and the files of a study: addresses, ids, typed numbers, points of charts."""

from __future__ import annotations

import math
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import pytest

pytest.importorskip("nicegui", reason="the web lab is not installed")

from skisnow._support.errors import ParameterError, StoreError
from skisnow.studies import read_study
from skisnow.web.page_requests import analysis, carving, correcting, entering, export, required_id
from skisnow.web.studies import CARVE_S
from skisnow.web.study_fields import CARVE, Range, StudyQuestion
from skisnow.web.widgets import _short
from skisnow.web.words import typed_number
from tests.coded import raises


@pytest.mark.parametrize(
    ("address", "path", "query"),
    [
        (entering("ab12"), "/enter/ab12", {}),
        (entering("ab12", table="shear", test="s 1&2"), "/enter/ab12", {"table": ["shear"], "test": ["s 1&2"]}),
        (entering("a", table="b", head={"site": "A/B"}), "/enter/a", {"table": ["b"], "site": ["A/B"]}),
        (correcting("ab12", test="7"), "/correct/ab12", {"test": ["7"]}),
        (analysis("kept", "ab12"), "/analysis/kept/ab12", {}),
        (export("entry", "ab12"), "/export/entry/ab12.zip", {}),
        (carving("my ski"), "/carve", {"ski": ["my ski"]}),
        (carving("a/b", "c&d"), "/carve", {"ski": ["a/b"], "other": ["c&d"]}),
    ],
)
def test_what_is_asked_is_in_the_address(address: str, path: str, query: dict[str, list[str]]) -> None:
    parts = urlsplit(address)
    assert (parts.path, parse_qs(parts.query)) == (path, query)


@pytest.mark.parametrize(
    ("said", "fits"),
    [("0af3", True), ("f" * 64, True), ("0af", False), ("f" * 65, False), ("0AF3", False), ("../a", False)],
)
def test_an_id_is_four_to_sixty_four_letters_and_digits(said: str, fits: bool) -> None:
    if fits:
        assert required_id(said) == said
    else:
        with raises(StoreError, "no_campaign"):
            required_id(said)


@pytest.mark.parametrize(("text", "value"), [("0,5", 0.5), (" 12.25 ", 12.25), ("−3", -3.0), ("1e-3", 1e-3)])
def test_as_hands_write_them(text: str, value: float) -> None:
    assert typed_number("the length", text) == value


@pytest.mark.parametrize("text", ["", "1x", "1.5.2", "nan", "inf", "1 2"])
def test_what_is_none_is_told(text: str) -> None:
    with raises(ParameterError, "not_a_number", field="the length", value=text):
        typed_number("the length", text)


@pytest.mark.parametrize(
    ("values", "sent"),
    [
        ([12345.6789, -1.23456], [12346.0, -1.0]),
        ([0.0123456789, 0.001], [0.012346, 0.001]),
        ([1.0, None, math.inf, 0.123456], [1.0, None, None, 0.1235]),
        ([0.0, -0.0, None, math.nan], [0.0, 0.0, None, None]),
        ([None, math.inf], [None, None]),
        ([], []),
    ],
)
def test_five_digits_of_the_largest(values: list[float | None], sent: list[float | None]) -> None:
    assert _short(values) == sent


TURNS = StudyQuestion(
    CARVE,
    {"edge_angle_deg": Range(10.0, 70.0, 3), "H_V_N_per_mm3": Range(0.1, 10.0, 3, log=True)},
    {"ski": "slalom", "load_N": 800.0, "S_f_N_per_mm2": 0.5, "unloading_ratio": float("inf")},
    unit_s=CARVE_S,
)
RUNS = StudyQuestion(
    "carved-46m",
    {"start.speed_m_per_s": Range(6.0, 9.0, 2)},
    {"run.duration_s": 0.1, "ski.name": "slalom", "sledge.inertia_kg_m2": (6.0, 8.0, 10.0)},
    method="accurate",
    unit_s=0.1,
)


def test_its_file_asks_for_the_same_points(tmp_path: Path) -> None:
    for asked in (TURNS, RUNS):
        (tmp_path / "study.toml").write_bytes(asked.files()["study.toml"])
        study = read_study(tmp_path / "study.toml")
        assert study.varied == tuple(asked.varied)
        assert {name: study.points[0][name] for name in asked.fixed} == dict(asked.fixed)
    (tmp_path / "study.toml").write_text(TURNS.text(), encoding="utf-8")
    points = read_study(tmp_path / "study.toml").points
    assert [(each["edge_angle_deg"], round(each["H_V_N_per_mm3"], 9)) for each in points] == [
        (angle, hardness) for angle in (10.0, 40.0, 70.0) for hardness in (0.1, 1.0, 10.0)
    ]
