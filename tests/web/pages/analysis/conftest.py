"""Fixtures of this room."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from skisnow.web import campaign_analysis as analyses_module
from skisnow.web.campaign_analysis import FigureImage
from skisnow.web.pages import analysis as page_module
from skisnow.web.subprocesses import Worker

from .shared import Drawing, points


@pytest.fixture
def drawing(monkeypatch: pytest.MonkeyPatch) -> Drawing:
    """The gate is open at first. Of three figures the second has no data; the third is wide."""
    made = Drawing()
    made.gate.set()

    def drawn(analysis: Any, number: int, _language: str) -> FigureImage | None:
        if number == 1:
            return None
        return FigureImage(
            f"fig{number}", f"{points(analysis)} points", f"<b>Figure {number}.</b> A", f"data:{number}", number == 2
        )

    def written(analysis: Any, out: str, language: str) -> None:
        made.reports.append((Path(out).name, language))
        (Path(out) / "figures").mkdir(parents=True)
        (Path(out) / "figures" / "one.svg").write_text("<svg/>", encoding="utf-8")
        rows = analysis.results["penetration"]["experiments"]
        (Path(out) / "report.html").write_text(f"{[row['used'] for row in rows]}", encoding="utf-8")
        (Path(out) / "results.json").write_text("{}", encoding="utf-8")

    async def do(_self: Worker, work: Callable[..., Any], *given: Any) -> Any:
        made.asked.append((work.__name__, *given[1:]))
        if work is drawn:
            if made.held in (0, points(given[0])):
                await made.gate.wait()
            made.done += 1
        return work(*given)

    monkeypatch.setattr(analyses_module, "figure", drawn)
    monkeypatch.setattr(analyses_module, "N_FIGURES", 3)
    monkeypatch.setattr(page_module, "write_whole_report", written)
    monkeypatch.setattr(Worker, "do", do)
    return made
