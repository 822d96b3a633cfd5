"""Warnings about limits of the model: in Python with a code, in the terminal, and in the report."""

from __future__ import annotations

import json
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from skisnow import BootMoment, BootPose, Scenario, load_scenario, simulate
from skisnow._support.errors import ModelLimitWarning, ParameterError
from skisnow._support.units import DEGREE
from skisnow.cli import main
from skisnow.scenario.plausibility import model_limits
from skisnow.ski import ski_named, write_ski
from skisnow.ski.editing import SkiEdit, edit_stations


def turn(**changes: object) -> Scenario:
    return load_scenario("carved-46m", changes={"run.duration_s": 0.05} | changes)


def test_no_edge_angle_is_warned_of() -> None:
    for edge_angle in (0.0, 0.01, -1.0, 30.0):
        with warnings.catch_warnings():
            warnings.simplefilter("error", ModelLimitWarning)
            simulate(turn(**{"sledge.edge_angle_deg": edge_angle}))


@pytest.mark.parametrize(
    ("change", "codes"),
    [
        ({"base_bevel": 1.0 * DEGREE}, []),
        ({"side_edge": 88.0 * DEGREE}, ["side_edge_without_radius"]),
        ({"side_edge": 88.0 * DEGREE, "edge_radius": 1e-4}, ["edge_radius_unmeasured"]),
    ],
)
def test_grinding_without_a_measurement_is_warned_of(change: dict[str, Any], codes: list[str]) -> None:
    assert list(model_limits(replace(ski_named("giant-slalom"), **change))) == codes


def test_the_terminal_and_the_report_have_the_warning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ground = replace(ski_named("giant-slalom"), edge_radius=1e-4)
    write_ski(ground, tmp_path / "ground.toml")
    settings = ["--set", f"ski.file={tmp_path / 'ground.toml'}", "--set", "run.duration_s=0.05"]
    main(["simulate", "carved-46m", *settings, "--out", str(tmp_path / "out")])
    (text,) = model_limits(ground).values()
    assert capsys.readouterr().err.count(text) == 1
    assert text in json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))["warnings"]
    assert text in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_a_function_does_not_replace_a_skier_s_balance() -> None:
    def still(_: BootMoment) -> list[BootPose]:
        return [BootPose.of([0.0, side, 0.0], 0.0) for side in (0.2, -0.2)]

    with pytest.raises(ParameterError, match="with_"):
        simulate(load_scenario("skier-10deg"), boots=still)


@pytest.mark.parametrize("part", ["factors", "values"])
def test_an_unknown_column_of_an_edit_is_an_error(part: str) -> None:
    station = edit_stations(ski_named("slalom"))
    arguments: dict[str, Any] = {part: {"sidecut": 1.2 if part == "factors" else station}}
    with pytest.raises(ParameterError, match="sidecut"):
        SkiEdit(station, **arguments)
