"""Data of figures as CSV: the numbers that were drawn, with panels, names and units."""

import csv
import io

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from skisnow.report.figures.figure_data import MOST_CELLS, figure_data


def rows_of(figure: Figure) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(figure_data(figure))))


def test_lines_bars_and_clouds_have_their_numbers_and_names() -> None:
    figure = Figure()
    left, right = figure.subplots(1, 2, sharey=True)
    left.set(xlabel="time (s)", ylabel="depth\n(mm)")
    left.plot([0.0, 1.0], [2.0, np.nan], label="series")
    left.axhline(7.0)
    left.plot([3.0], [4.5], color="red", marker="o")
    right.scatter([1.0], [2.0], c=[0.25])
    right.bar([10.0], [0.5], width=2.0)
    figure.legend(handles=[Line2D([], [], color="red", marker="o", label="soft")])
    shown = [(row["panel"], row["series"], row["x"], row["y"], row["value"]) for row in rows_of(figure)]
    assert sorted(shown) == [
        ("a", "series", "0", "2", ""), ("a", "series", "1", "", ""), ("a", "soft", "3", "4.5", ""),
        ("b", "1", "1", "2", "0.25"), ("b", "2", "10", "0.5", ""),
    ]  # fmt: skip
    assert {(row["x_axis"], row["y_axis"]) for row in rows_of(figure)} == {
        ("time (s)", "depth (mm)"),
        ("", "depth (mm)"),
    }


def test_words_at_an_axis_name_their_rows() -> None:
    figure = Figure()
    axes = figure.subplots()
    axes.plot([0.5, 0.7], [0.1, 0.9], "o")
    axes.set_yticks([0, 1], ["site A", "site B"])
    assert [(row["x"], row["y"]) for row in rows_of(figure)] == [("0.5", "site A"), ("0.7", "site B")]


def test_maps_have_the_middles_of_their_cells_and_the_name_of_the_colour() -> None:
    figure = Figure()
    axes = figure.subplots()
    mesh = axes.pcolormesh([0.0, 2.0, 4.0], [0.0, 1.0], [[5.0, np.nan]])
    figure.colorbar(mesh, ax=axes, label="force (N)")
    (row,) = rows_of(figure)
    assert (row["series"], row["x"], row["y"], row["value"]) == ("force (N)", "1", "0.5", "5")
    figure = Figure()
    figure.subplots().pcolormesh(np.ones((200, 201)))
    assert len(rows_of(figure)) <= MOST_CELLS
