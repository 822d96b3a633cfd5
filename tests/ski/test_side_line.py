"""Widths between the rows of a coarse table."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.carving.equilibrium import carve
from skisnow.ski import read_ski
from skisnow.ski.layout import layout_of_lengths
from skisnow.ski.outline import ArcOutline, width_of_table
from skisnow.ski.table_file import StationTable
from skisnow.snow import SnowProperties

if TYPE_CHECKING:
    from collections.abc import Callable

PAGE = Path(__file__).parents[2] / "docs" / "files" / "ski.md"
LAYOUT = layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458)
FRONT, REAR = LAYOUT.widest_points
EXAMPLE = "station_m,width_mm,EI_N_m2\n0.845,25,100\n0.729,116,100\n0,68,440\n-0.729,101,100\n-0.749,101,100\n"
WIDTHS = dict.fromkeys(("tip_width_mm", "waist_width_mm", "tail_width_mm"))


def table(station: list[float], width_mm: list[float]) -> StationTable:
    return StationTable(np.array(station), np.array(width_mm) * 1e-3)


def test_three_rows_are_the_side_line_of_three_widths() -> None:
    coarse = table([FRONT + 0.115, FRONT, 0.0, REAR, LAYOUT.tail], [25, 116, 68, 101, 101])
    arc = ArcOutline(layout=LAYOUT, tip_width=0.116, waist_width=0.068, tail_width=0.101)
    at = np.linspace(FRONT, REAR, 301)
    assert width_of_table(coarse, LAYOUT)(at) == pytest.approx(arc.width_at(at), abs=1e-12)


@pytest.mark.parametrize("rows", [3, 4, 5, 9, 30])
def test_a_parabola_is_kept_whatever_the_rows(rows: int) -> None:
    """Not evenly spaced, the ends of the sidecut not among them."""

    def width(s: np.ndarray) -> np.ndarray:
        return 0.07 + 0.004 * s + 0.066 * s**2

    station = np.sort(0.6 * np.sin(np.linspace(-1.5, 1.5, rows) + 0.05))[::-1]
    at = np.linspace(FRONT, REAR, 77)
    assert width_of_table(StationTable(station, width(station)), LAYOUT)(at) == pytest.approx(width(at), abs=1e-12)


def test_rows_stand_as_they_are_and_nothing_swings_beyond_them() -> None:
    """A straight middle between two arcs: between its rows it narrows by no more than a parabola does."""
    station, widths = [0.84, 0.729, 0.4, 0.2, -0.2, -0.4, -0.729], [30.0, 110, 80, 68, 68, 80, 110]
    found = width_of_table(table(station, widths), LAYOUT)
    assert found(np.array(station)) * 1e3 == pytest.approx(widths, abs=1e-9)
    middle = found(np.linspace(0.2, -0.2, 41)) * 1e3
    parabola = np.polyfit(station[1:], widths[1:], 2)[0]  # mm/m²
    assert middle.max() <= 68.0 + 1e-9
    assert middle.min() == pytest.approx(68.0 - parabola * 0.2**2, abs=1e-9)
    assert np.all(np.diff(found(np.linspace(0.729, 0.84, 50))) < 0.0)


@pytest.mark.parametrize(
    ("station", "told"),
    [
        ([0.845, 0.729, -0.729], "2 rows"),
        ([0.845, 0.8, -0.749], "0 rows"),
        ([0.84, 0.3, 0.2, 0.1, 0.0, -0.2, -0.74], "500 mm apart"),
    ],
)
def test_too_few_rows_in_the_sidecut_are_refused(station: list[float], told: str) -> None:
    with pytest.raises(ParameterError, match=f"the column width_mm has .*{told}.*3 rows or more over at least half"):
        width_of_table(table(station, [80.0] * len(station)), LAYOUT)


def test_the_example_of_the_page_carves_as_its_three_widths(ski_file: Callable[..., Path]) -> None:
    """The same ski from a table of five rows and from three widths; only the tip beyond the sidecut is another."""
    by_keys: dict[str, object] = {"EI_N_m2": None, "table": "rows.csv", "tail_overhang_mm": None, "length_mm": None}
    path = ski_file(**WIDTHS, **by_keys)
    (path.parent / "rows.csv").write_text(EXAMPLE, encoding="utf-8")
    by_table = read_ski(path)
    path = ski_file(**by_keys)
    stiffness = "\n".join(",".join(line.split(",")[::2]) for line in EXAMPLE.splitlines())
    (path.parent / "rows.csv").write_text(stiffness, encoding="utf-8")
    by_widths = read_ski(path)
    hard = SnowProperties(0.2e9, 0.35e6, source="x")
    found = [
        carve(ski, hard, edge_angle=math.radians(45.0), load=800.0, unloading_ratio=10.0)
        for ski in (by_table, by_widths)
    ]
    page = PAGE.read_text(encoding="utf-8")
    assert "\n".join(f"    {line}" for line in EXAMPLE.splitlines()) in page
    assert f"a boot radius of {found[0].turn_radius_boot:.2f} m" in page
    assert found[0].turn_radius_boot == pytest.approx(found[1].turn_radius_boot, rel=1e-4)
    assert by_table.sidecut_radius_of_edge_line == pytest.approx(by_widths.sidecut_radius_of_edge_line, rel=1e-9)


def test_what_a_ski_is_says_its_side_line() -> None:
    ski = read_ski("slalom")
    told = re.fullmatch(
        r"<Ski 'slalom': 1\.593 m, 116-68-101 mm, radius of the side line ([0-9.]+) m, 2\.231 kg>", repr(ski)
    )
    assert told is not None
    three_widths = 1.458**2 / (2.0 * (0.116 + 0.101 - 2.0 * 0.068))  # L²/8δ, δ a quarter of tip + tail - 2 waist
    assert float(told[1]) == pytest.approx(three_widths, rel=2e-3)
