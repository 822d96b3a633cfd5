"""Methods of a run for which an upper package draws and writes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from skisnow.scenario import load_scenario

from .straight_run import STRAIGHT, straight_run


@pytest.mark.parametrize(
    ("method", "function", "arguments"),
    [
        (lambda run: run.plot(), "run.drawings.run_figure", ("track",)),
        (lambda run: run.plot("motion"), "run.drawings.run_figure", ("motion",)),
        (lambda run: run.report(Path("out")), "run.folder.write_run", (Path("out"),)),
        (lambda run: run.to_dataframe(), "run.file.run_dataframe", ()),
        (lambda run: run.to_xarray(), "run.file.run_dataset", ()),
    ],
)
def test_a_method_returns_the_result_of_the_upper_package(
    method: Callable[[Any], Any], function: str, arguments: tuple[Any, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, result = straight_run(load_scenario("carved-46m", changes=STRAIGHT)), object()
    calls: list[tuple[Any, ...]] = []

    def record(*given: Any) -> object:
        calls.append(given)
        return result

    monkeypatch.setattr(f"skisnow.report.{function}", record)
    assert method(run) is result
    assert calls == [(run, *arguments)]
