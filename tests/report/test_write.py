"""The folder of a report: which files, contents, what stays and what goes."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib
import pytest

from skisnow._support.errors import OutputError
from skisnow._support.staging import write_file
from skisnow.campaign import Campaign
from skisnow.estimation.results import results_json
from skisnow.report import write_report
from skisnow.report.figures.drawing import FORMS
from tests.coded import raises

from ..conftest import only_drawn
from .conftest import Reported, first_series, reported

FIGURES = {
    "fig05_force_depth",
    "fig06_hardness_density",
    "fig07_shear_force_depth",
    "fig08_stress_angle",
    "fig09_machining",
    "fig10_stress_density",
    "fig11_stress_hardness",
    "model_rmse",
    "residuals",
    "seating",
}


def _contents(folder: Path) -> dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()
    }


def test_every_figure_and_table_is_there_in_both_forms(reference: Reported) -> None:
    names = set(_contents(reference.folder))
    assert {f"figures/{name}{ending}" for name in FIGURES for ending in (".svg", ".png", ".pdf", ".eps")} <= names
    tables = {name.removesuffix(".csv") for name in names if name.endswith(".csv")}
    assert {"tables/models_synthetic", "tables/sites_synthetic", "tables/regressions_synthetic"} <= tables
    assert {f"{table}.tex" for table in tables} <= names
    assert (reference.folder / "figures/seating.png").read_bytes().startswith(b"\x89PNG")


def test_results_json_is_that_of_the_estimates(reference: Reported) -> None:
    text = (reference.folder / "results.json").read_bytes()
    assert text == results_json(reference.results)
    assert json.loads(text) == json.loads(json.dumps(reference.results))


def test_the_same_results_give_the_same_bytes_whatever_the_user_has_set(
    reference: Reported, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The second time under other settings of the drawing library, which stay as they are."""
    written: list[str] = []
    said: list[str] = []

    def noting(path: Path, content: str | bytes) -> None:
        written.append(path.name)
        write_file(path, content)

    monkeypatch.setattr("skisnow.report.campaign.page.write_file", noting)
    others: Any = {"font.size": 31.0, "svg.fonttype": "path", "axes.grid": True}
    with matplotlib.rc_context(others), only_drawn("png", "svg"):
        write_report(reference.analysis, tmp_path, progress=said.append)
        assert matplotlib.rcParams["font.size"] == 31.0
        assert matplotlib.rcParams["svg.fonttype"] == "path"
        assert matplotlib.rcParams["axes.grid"]
    again, first = _contents(tmp_path), _contents(reference.folder)
    assert again.keys() == first.keys()
    assert [name for name in first if again[name] != first[name]] == []
    assert written[-2:] == ["report.html", "results.json"]
    assert written.count("results.json") == 1
    assert any("fig05" in each for each in said)
    assert said[-1] == "results.json"


@pytest.mark.usefixtures("undrawn")
def test_other_files_stay_and_those_of_an_earlier_report_go(campaign: Campaign, tmp_path: Path) -> None:
    (tmp_path / "figures").mkdir()
    mine = tmp_path / "figures" / "photo.png"
    mine.write_bytes(b"mine")
    reported(replace(campaign, penetration=None), tmp_path)
    assert list((tmp_path / "figures").glob("fig08_*.svg"))
    assert list((tmp_path / "tables").glob("shear_*"))
    reported(replace(campaign, name="real", shear=None, penetration=first_series(campaign, 2)), tmp_path)
    names = set(_contents(tmp_path))
    assert mine.read_bytes() == b"mine"
    gone = {f"figures/fig08_stress_angle.{form}" for form in FORMS} | {"tables/shear_experiments.csv"}
    assert not gone & names
    assert not [name for name in names if "synthetic" in name]
    assert "tables/models.csv" in names
    assert any(name.startswith("figures/fig05_") for name in names)


def test_a_place_that_cannot_be_written_is_a_clear_error(reference: Reported, tmp_path: Path) -> None:
    taken = tmp_path / "taken"
    taken.write_text("a file, not a folder")
    with raises(OutputError, "cannot_write"):
        write_report(reference.analysis, taken)
    assert taken.read_text() == "a file, not a folder"
