"""What a run asks of upper packages, and hands back as they give it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from skisnow.scenario import read_scenario
from skisnow.simulate import run as run_module

from .straight_run import STRAIGHT, straight_run


@pytest.mark.parametrize(
    ("ask", "place", "told"),
    [
        (lambda run: run.plot(), ("report.run_drawings", "run_figure"), ("track",)),
        (lambda run: run.plot("motion"), ("report.run_drawings", "run_figure"), ("motion",)),
        (lambda run: run.report(Path("out")), ("report.run_folder", "write_run"), (Path("out"),)),
        (lambda run: run.to_dataframe(), ("report.run_frames", "run_dataframe"), ()),
        (lambda run: run.to_xarray(), ("report.run_frames", "run_dataset"), ()),
    ],
)
def test_what_is_drawn_and_written_comes_from_above(
    ask: Callable[[Any], Any], place: tuple[str, str], told: tuple[Any, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, answer = straight_run(read_scenario("carved-46m", changes=STRAIGHT)), object()
    asked: list[Any] = []

    def above(*names: str) -> Callable[..., object]:
        def answers(*given: Any) -> object:
            asked.append((names, given))
            return answer

        return answers

    monkeypatch.setattr(run_module, "from_above", above)
    assert ask(run) is answer
    ((names, (first, *others)),) = asked
    assert first is run
    assert (names, tuple(others)) == (place, told)
