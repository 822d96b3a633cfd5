"""Import of series in neighbouring columns, and of headings on two rows."""

from typing import Any

import pytest
from openpyxl import Workbook

from skisnow.campaign.importing.answers import Answers
from skisnow.campaign.importing.proposal import propose
from skisnow.campaign.importing.sections import find_sections
from skisnow.campaign.importing.sheets import read_sheets
from skisnow.campaign.reading.campaign import campaign_of_files
from skisnow.estimation.result_rows import experiment_hardness

from .layouts import FILE, G, bytes_of, hardness, issues

PAIR = ["Last [kg]", "Tiefe [mm]"]
PAIRS: list[list[Any]] = [PAIR * 2, [10, 0.63, 10, 0.72], [50, 1.41, 50, 1.59]]
ROWS = [["1", 30, 10, 0.63], ["1", 30, 50, 1.41], ["2", 45, 10, 0.72], ["2", 45, 50, 1.59]]
RIGHT = [
    # series in neighbouring columns
    ([["Hang oben"], ["Versuch 1", None, "Versuch 2"], ["Kantwinkel 30°", None, "Kantwinkel: 45 °"], *PAIRS], {}),
    ([["Versuch 1, Kantwinkel 30°", None, "Versuch 2, Kantwinkel 45°"], *PAIRS], {}),
    ([["Versuch", 1, None, 2], ["Kantwinkel [°]", 30.0, None, 45.0], [None, *PAIR * 2],
        [None, *PAIRS[1]], [None, *PAIRS[2]]], {}),
    ([["Hang oben"], [1, None, 2], [30, None, 45], *PAIRS], {
        "column": {"Hang oben:2": "experiment", "Hang oben:3": "edge_angle_deg"}, "unit": {"Hang oben:3": "°"}}),
    ([["Versuch", 1, 2], ["Kantwinkel [°]", 30, 45], ["Last [kg]", "Tiefe [mm]", "Tiefe [mm]"], [10, 0.63, 0.72],
        [50, 1.41, 1.59]], {}),
    ([["Versuch 1", None, "Versuch 2"], ["Kantwinkel 30°", None, "Kantwinkel 45°"], [*PAIR, "Last [N]", "Tiefe [cm]"],
        [10, 0.63, 10 * G, 0.072], [50, 1.41, 50 * G, 0.159]], {}),
    ([["Versuch", "Kantwinkel [°]", *PAIR] * 2, [1, 30, 10, 0.63, 2, 45, 10, 0.72], [1, 30, 50, 1.41, 2, 45, 50, 1.59]],
        {}),
    # headings on two rows
    ([["Versuch", "Kant-", "Last", "Eindring-"], ["Nr.", "winkel [°]", "[kg]", "tiefe [mm]"], *ROWS], {}),
    ([["Versuch", "Kant-", "Last", "Eindring-"], ["Nr.", "winkel", None, "tiefe"], [None, "°", "kg", "mm"], *ROWS], {}),
    ([["Test", "Edge", "Load", "Penetration"], ["no.", "angle [°]", "[kg]", "depth [mm]"], *ROWS], {}),
    ([[None, None, "Last"], ["Versuch", "Kantwinkel [°]", "[kg]", "Tiefe [mm]"], *ROWS], {}),
    ([["Versuch", "Kantwinkel", "Last", "Tiefe"], [None, None, "in kg", "in mm"], *ROWS],
        {"unit": {"Kantwinkel": "°"}}),
    # a row of units with words
    ([["Versuch", "Kantwinkel", "Last", "Tiefe"], ["Nr.", "Grad (°)", "Masse [kg]", "[mm]"], *ROWS], {}),
    ([["Versuch", "Kant-", "Last", "Tiefe"], ["Nr.", "winkel", None, None], [None, "°", "Masse [kg]", "mm"],
        *ROWS], {}),
]  # fmt: skip
ASKED = [
    [["Hang oben"], *PAIRS],
    [PAIR, [10, 0.63], [50, 1.41]],
    [["Hang oben"], ["A", None, "B"], [30, None, 45], *PAIRS],
    [["Versuch 1", None, "Versuch 2"], ["Kantwinkel 30°"], *PAIRS],
    [["Versuch 1", None, "Versuch 2"], ["Kantwinkel", 30, "Kantwinkel 45°"], *PAIRS],
    [["Versuch 1", None, "Versuch 2"], ["Kantwinkel 30°", None, "Kantwinkel 45°"], [*PAIR, *PAIR[::-1]], *PAIRS[1:]],
    [["Versuch", "Kantwinkel [°]", *PAIR, "Tiefe [mm]"], [1, 30, 10, 0.63, 0.72], [1, 30, 50, 1.41, 1.59]],
    [["Versuch", "Kant-", "Last", "Nach-"], ["Nr.", "winkel [°]", "[kg]", "tiefe [mm]"], *ROWS],
    [[None, None, None, "Nach-"], ["Versuch", "Kantwinkel [°]", "Last [kg]", "tiefe [mm]"], *ROWS],
    [[None, None, "Auflast", "Kegel"], ["Versuch", "Kantwinkel [°]", "Last [kg]", "Tiefe [mm]"], *ROWS],
    [["Versuch", "Kantwinkel", "Last", None, "Tiefe"], ["Nr.", "°", "Masse [kg]", "Kraft [N]", "mm"],
        ["1", 30, 10, 98.1, 0.63]],
    [["Versuch", "Kantwinkel", "Last", "Tiefe"], ["Nr.", "°", "Masse [lb]", "mm"], *ROWS],
    [["Versuch", "Kantwinkel", "Last", "Tiefe"], ["A", "30°", "100 N", "0,5 mm"], ["A", "30°", "200 N", "0,9 mm"]],
]  # fmt: skip


SECTIONS: list[list[str]] = [
    [
        "Hang oben:4 4 6 (0, 1, 5, 6) Last [kg], Tiefe [mm], Versuch, Kantwinkel | , , , ° | range(1, 3)",
        "Hang oben:4 4 6 (2, 3, 7, 8) Last [kg], Tiefe [mm], Versuch, Kantwinkel | , , , ° | range(1, 3)",
    ],
    [
        "Hang oben:2 2 4 (0, 1, 5, 6) Last [kg], Tiefe [mm], Versuch, Kantwinkel | , , , ° | range(0, 1)",
        "Hang oben:2 2 4 (2, 3, 7, 8) Last [kg], Tiefe [mm], Versuch, Kantwinkel | , , , ° | range(0, 1)",
    ],
    [
        "Hang oben:3 3 5 (1, 2, 6, 7) Last [kg], Tiefe [mm], Versuch, Kantwinkel [°] | , , ,  | range(0, 2)",
        "Hang oben:3 3 5 (3, 4, 8, 9) Last [kg], Tiefe [mm], Versuch, Kantwinkel [°] | , , ,  | range(0, 2)",
    ],
    [
        "Hang oben:4 4 6 (0, 1, 5, 6) Last [kg], Tiefe [mm], Hang oben:2, Hang oben:3 | , , ,  | range(1, 3)",
        "Hang oben:4 4 6 (2, 3, 7, 8) Last [kg], Tiefe [mm], Hang oben:2, Hang oben:3 | , , ,  | range(1, 3)",
    ],
    [
        "Hang oben:3 3 5 (0, 1, 4, 5) Last [kg], Tiefe [mm], Versuch, Kantwinkel [°] | , , ,  | range(0, 2)",
        "Hang oben:3 3 5 (0, 2, 6, 7) Last [kg], Tiefe [mm], Versuch, Kantwinkel [°] | , , ,  | range(0, 2)",
    ],
    [
        "Hang oben:3 3 5 (0, 1, 5, 6) Last [kg], Tiefe [mm], Versuch, Kantwinkel | , , , ° | range(0, 2)",
        "Hang oben:3 3 5 (2, 3, 7, 8) Last [N], Tiefe [cm], Versuch, Kantwinkel | , , , ° | range(0, 2)",
    ],
    [
        "Hang oben:1 1 3 (0, 1, 2, 3) Versuch, Kantwinkel [°], Last [kg], Tiefe [mm] |  | range(0, 0)",
        "Hang oben:1 1 3 (4, 5, 6, 7) Versuch, Kantwinkel [°], Last [kg], Tiefe [mm] |  | range(0, 0)",
    ],
    ["Hang oben:1 2 6 (0, 1, 2, 3) Versuch, Kantwinkel [°], Last, Eindringtiefe [mm] | Nr., , kg,  | range(0, 0)"],
    ["Hang oben:1 3 7 (0, 1, 2, 3) Versuch, Kantwinkel, Last, Eindringtiefe | Nr., °, kg, mm | range(0, 0)"],
    ["Hang oben:1 2 6 (0, 1, 2, 3) Test, Edge angle [°], Load, Penetration depth [mm] | no., , kg,  | range(0, 0)"],
    ["Hang oben:1 2 6 (0, 1, 2, 3) Versuch, Kantwinkel [°], Last, Tiefe [mm] | , , kg,  | range(0, 0)"],
    ["Hang oben:1 2 6 (0, 1, 2, 3) Versuch, Kantwinkel, Last in kg, Tiefe in mm | , , ,  | range(0, 0)"],
    ["Hang oben:1 2 6 (0, 1, 2, 3) Versuch, Kantwinkel, Last, Tiefe | Nr., °, kg, mm | range(0, 0)"],
    ["Hang oben:1 3 7 (0, 1, 2, 3) Versuch, Kantwinkel, Last, Tiefe | Nr., °, kg, mm | range(0, 0)"],
]
"""Of each right case: heading row, first data row, row behind the last, columns, headings, units, rows of titles."""
ISSUES: list[list[str]] = [
    ["table Hang oben:2=penetration 5 Hang oben:2 None Last [kg], Tiefe [mm]"],
    ["table Hang oben:1=penetration 5 Hang oben:1 None Last [kg], Tiefe [mm]"],
    ["table Hang oben:4=penetration 5 Hang oben:4 None Last [kg], Tiefe [mm], Hang oben:2, Hang oben:3"],
    [
        "table Hang oben:3=penetration 5 Hang oben:3 None Last [kg], Tiefe [mm]",
        "ignore Hang oben!2= 0 Hang oben 2 Kantwinkel 30°",
    ],
    [
        "table Hang oben:3=penetration 5 Hang oben:3 None Last [kg], Tiefe [mm]",
        "ignore Hang oben!2= 0 Hang oben 2 Kantwinkel: 30: Kantwinkel 45°",
    ],
    [
        "table Hang oben:3=penetration 5 Hang oben:3 None Last [kg], Tiefe [mm], Tiefe [mm], Last [kg]",
        "ignore Hang oben!2= 0 Hang oben 2 Kantwinkel 30°: Kantwinkel 45°",
    ],
    [
        "column penetration.Tiefe [mm]=depth_mm 2 Hang oben:1 None Tiefe [mm]",
        "ignore Hang oben!E= 0 Hang oben:1 None Tiefe [mm]",
    ],
    ["table Hang oben:1=penetration 5 Hang oben:1 None Versuch, Kantwinkel [°], Last, Nachtiefe [mm]"],
    ["table Hang oben:1=penetration 5 Hang oben:1 None Versuch, Kantwinkel [°], Last [kg], Nachtiefe [mm]"],
    ["ignore Hang oben!1= 0 Hang oben 1 Auflast: Kegel"],
    ["table Hang oben:1=penetration 5 Hang oben:1 None Versuch, Kantwinkel, Last"],
    ["unit penetration.Last= 5 Hang oben:1 None Masse [lb]"],
    [
        "unit penetration.Kantwinkel= 2 Hang oben:1 None 30°",
        "unit penetration.Last= 5 Hang oben:1 None 100 N",
        "unit penetration.Tiefe= 6 Hang oben:1 None 0,5 mm",
    ],
]
"""Of each case that is asked about, as in test_import."""


def _book(rows: list[list[Any]]) -> bytes:
    book = Workbook()
    sheet = book.active
    sheet.title = "Hang oben"
    for row in rows:
        sheet.append(row)
    book.create_sheet("Notizen").append(["Skistück 200 x 62 mm"])
    return bytes_of(book)


@pytest.mark.parametrize(("rows", "answers"), RIGHT)
def test_series_side_by_side_under_two_heading_rows(rows: list[list[Any]], answers: dict[str, dict[str, str]]) -> None:
    proposal = propose(FILE, _book(rows), Answers(**{"site": {"Hang oben": "Hang oben"}, **answers}))
    assert not proposal.problems, [str(problem) for problem in proposal.problems]
    campaign = campaign_of_files(proposal.files)
    assert campaign.penetration is not None
    assert campaign.penetration.load.tolist() == pytest.approx([10 * G, 50 * G] * 2)
    expected = [hardness(50, 1.41, 30), hardness(50, 1.59, 45)]
    assert (experiment_hardness(campaign) / 1e9).tolist() == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("rows", "expected"), list(zip([rows for rows, _ in RIGHT], SECTIONS, strict=True)))
def test_tables_on_a_sheet(rows: list[list[Any]], expected: list[str]) -> None:
    sections = find_sections(read_sheets(FILE, _book(rows))[0], {})
    assert [
        f"{part.key} {part.start} {part.end} {part.columns} {', '.join(part.headings)} | {', '.join(part.units)} | "
        f"{part.titles}"
        for part in sections
    ] == expected
    assert [part.is_last for part in sections] == [False] * (len(sections) - 1) + [True]


@pytest.mark.parametrize(("rows", "expected"), list(zip(ASKED, ISSUES, strict=True)))
def test_unclear_series_and_headings_are_errors_with_an_option(rows: list[list[Any]], expected: list[str]) -> None:
    proposal = propose(FILE, _book(rows), Answers(site={"Hang oben": "Hang oben"}))
    assert not proposal.files
    assert issues(proposal) == expected
    assert any(f"--{question.option}" in str(question.problem) for question in proposal.questions)
