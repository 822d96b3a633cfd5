"""What the report of a skier's run says, beside that of a sledge."""

from __future__ import annotations

from markupsafe import Markup

from skisnow import load_scenario, simulate
from skisnow.report.figures.drawing import Picture
from skisnow.report.run.drawings import run_drawings
from skisnow.report.run.page import FIGURES, FURTHER, run_page
from skisnow.simulation.run_summary import summary_dict


def test_the_page_has_every_figure_of_a_skier_and_calls_nobody_a_sledge() -> None:
    run = simulate(load_scenario("skier-10deg").with_(duration_s=0.05, method="fast"))
    pictures = [
        Picture(each.name, Markup(""), f"the figure {each.name}", True, "<svg/>", b"") for each in run_drawings(run)
    ]
    assert {each.name for each in pictures} == {*FIGURES, *FURTHER} - {"course", "boots"}
    page = run_page(run, summary_dict(run), pictures)
    assert [name for name in (*FIGURES, "balance") if f"the figure {name}" not in page] == []
    assert "A simulated run of a skier on two flexible skis" in page
    assert "edged by the skier" in page
