"""One synthetic campaign of the paper's design, analysed and reported once for all tests of this package."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest

from skisnow.campaign import Campaign, PenetrationTests, ShearTests
from skisnow.campaign.reference import reference_campaign
from skisnow.estimation import Analysis, analyse
from skisnow.report import write_report
from tests.present import present

from ..conftest import only_drawn


@dataclass(frozen=True)
class Reported:
    """An analysis and the folder of its report."""

    analysis: Analysis
    folder: Path

    @property
    def results(self) -> dict[str, Any]:
        return self.analysis.results

    @property
    def html(self) -> str:
        return (self.folder / "report.html").read_text(encoding="utf-8")


def analysis_of(campaign: Campaign) -> Analysis:
    """Few resamples: the tests hold the report against the results, whatever these are."""
    return analyse(campaign, n_resamples=100)


def results_of(campaign: Campaign) -> dict[str, Any]:
    return analysis_of(campaign).results


def altered(analysis: Analysis, results: dict[str, Any]) -> Analysis:
    """The same, with results that say something else."""
    other = replace(analysis)
    vars(other)["results"] = results
    return other


def reported(campaign: Campaign, folder: Path) -> Reported:
    """Its pictures are only SVG; every form is drawn in test_drawing.py, and a whole report in a slow test."""
    analysis = analysis_of(campaign)
    with only_drawn("svg"):
        write_report(analysis, folder)
    return Reported(analysis, folder)


def first_series(campaign: Campaign, count: int) -> PenetrationTests:
    """The first penetration experiments."""
    tests = present(campaign.penetration)
    readings = int(tests.first[count])
    keys = ("experiment", "site", "tool", "spot", "edge_angle", "snow_density", "drop_cone_depth", "cancelled")
    by_series: dict[str, Any] = {name: getattr(tests, name)[:count] for name in keys}
    by_reading: dict[str, Any] = {
        name: getattr(tests, name)[:readings] for name in ("load", "penetration_depth", "row")
    }
    back = tests.unloading
    assert back is not None
    kept = int(back.first[count])
    cut = {name: getattr(back, name)[:kept] for name in ("load", "penetration_depth", "row")}
    back = replace(back, **cut, first=back.first[: count + 1]) if kept else None
    return replace(tests, **by_series, **by_reading, first=tests.first[: count + 1], further={}, unloading=back)


def first_shear(campaign: Campaign, count: int) -> ShearTests:
    """The first shear experiments."""
    tests = present(campaign.shear)
    whole = ("further", "turning")
    columns: dict[str, Any] = {name: getattr(tests, name)[:count] for name in ShearTests.__slots__ if name not in whole}
    return replace(tests, **columns, further={})


@pytest.fixture(scope="session")
def campaign() -> Campaign:
    return reference_campaign(1).campaign()


@pytest.fixture(scope="session")
def reference(campaign: Campaign, tmp_path_factory: pytest.TempPathFactory) -> Reported:
    return reported(campaign, tmp_path_factory.mktemp("report"))
