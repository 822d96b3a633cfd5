"""Fixtures of this room."""

import json
from typing import Any

import pytest

from skisnow.report.run.file import write_run_file
from skisnow.scenario import scenario_values
from skisnow.scenario.keys import in_sections
from skisnow.simulation.run_summary import summary_dict

from ....report.runs import circle_run
from ..desk import in_this_process


@pytest.fixture(scope="module")
def run_files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Files of a turn as the command leaves them."""
    place, run = tmp_path_factory.mktemp("run") / "run.nc", circle_run(count=11)
    write_run_file(run, in_sections(scenario_values(run.scenario)), place)
    summary = json.dumps(summary_dict(run), allow_nan=False)
    return {"run.nc": place.read_bytes(), "summary.json": summary.encode()}


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Read sent files in this process; gives limits, work and its arguments."""
    return in_this_process(monkeypatch, "replay_addresses")
