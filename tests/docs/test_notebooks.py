"""The notebooks run, and their pages show what they print today."""

import importlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
write_notebooks: Any = importlib.import_module("write_notebooks")
NAMES = tuple(write_notebooks.names_of_all())


def text_of_page(name: str) -> str:
    return (DOCS / "tutorials" / f"{name}.md").read_text(encoding="utf-8")


def test_there_are_four_of_about_a_dozen_cells() -> None:
    assert NAMES == ("estimating", "study", "track", "turn")
    for name in NAMES:
        code = [cell for cell in write_notebooks.cells_of(name) if cell.kind == "code"]
        assert 6 <= len(code) <= 12, name
        assert any(cell.alt for cell in code), name  # a figure that shows in place


@pytest.mark.parametrize("name", NAMES)
def test_kept_without_outputs_and_page_has_every_cell(name: str) -> None:
    """A notebook that was run and saved would be of that machine and day."""
    notebook = json.loads((DOCS / "tutorials" / f"{name}.ipynb").read_text(encoding="utf-8"))
    assert (notebook["nbformat"], notebook["nbformat_minor"]) == (4, 5)
    for cell in notebook["cells"]:
        assert cell["id"]
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            assert cell["execution_count"] is None
    page, place = text_of_page(name), 0
    for cell in write_notebooks.cells_of(name):
        found = page.find(cell.text, place)
        assert found >= place, cell.text
        place = found


def test_study() -> None:
    """Carved radii follow R_sc cos ϑ; weaker snow lets go at a lower angle; the sample fills its ranges evenly."""
    cells, names = write_notebooks.executed("study")
    assert write_notebooks.page("study", cells) == text_of_page("study")
    rows = [row for row in names["table"].rows if row["published"] == "race-piste"]
    for row in rows[:6]:
        carved = row["sidecut_radius_of_three_widths_m"] * np.cos(np.radians(row["edge_angle_deg"]))
        assert row["turn_radius_boot_m"] == pytest.approx(carved, rel=0.12)
    held = {
        snow: max(row["edge_angle_deg"] for row in names["table"].rows if row["published"] == snow and row["holds"])
        for snow in ("race-piste", "spring-snow")
    }
    assert held["spring-snow"] < held["race-piste"]
    share = np.sort([(row["edge_angle_deg"] - 20.0) / 50.0 for row in names["answers"].rows])
    assert np.floor(12 * share).astype(int).tolist() == list(range(12))


def test_estimating() -> None:
    """Planted mistakes are found, then gone; sites are in order of the drawn hardness, the snow is the table's."""
    cells, names = write_notebooks.executed("estimating")
    assert write_notebooks.page("estimating", cells) == text_of_page("estimating")
    tool, unit = names["tool"] + 1, names["unit"] + 1
    assert {(each.code, each.row) for each in names["problems"]} >= {("unknown_tool", tool), ("not_a_number", unit)}
    assert [cell.printed for cell in cells if cell.text.endswith('len(skisnow.check_campaign("campaign"))')] == ["0\n"]
    means = [row["mean"] for row in names["sites"]]
    assert means == sorted(means)
    assert names["snow"].snow_hardness / 1e9 == pytest.approx(means[2])
    assert names["answer"].side_force > names["answer"].side_force_limit


@pytest.mark.slow
def test_turn() -> None:
    """A carved turn of about R_sc cos ϑ; weak snow lets the edge go; energies balance."""
    cells, names = write_notebooks.executed("turn")
    assert write_notebooks.page("turn", cells) == text_of_page("turn")
    assert names["run"].turn_radius_quantile(0.5) == pytest.approx(names["rule"], rel=0.1)
    assert names["now"] > 2 * names["before"]
    assert names["run"].energy_balance_error < 1e-3


@pytest.mark.slow
def test_track() -> None:
    """The true values of the track are found within the intervals, and the rest is the receiver's noise."""
    cells, names = write_notebooks.executed("track")
    assert write_notebooks.page("track", cells) == text_of_page("track")
    for name, truth in (("mu_0", 0.04), ("drag_area", 0.45)):
        low, high = names["found"][name].interval
        assert low < truth < high
    # 51 x 3 errors of 20 mm, of which the fit and the places between points take a little
    assert names["after"].time.numbers.rms == pytest.approx(0.02 * np.sqrt(3), rel=0.2)
