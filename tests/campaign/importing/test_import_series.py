"""Series in neighbouring columns and headings on two rows are not imported without an answer."""

from typing import Any

import pytest
from openpyxl import Workbook

from skisnow.campaign.importing.answers import Answers
from skisnow.campaign.importing.proposal import propose

from .test_import import FILE, bytes_of

PAIR = ["Last [kg]", "Tiefe [mm]"]
PAIRS: list[list[Any]] = [PAIR * 2, [10, 0.63, 10, 0.72], [50, 1.41, 50, 1.59]]
ROWS = [["1", 30, 10, 0.63], ["1", 30, 50, 1.41], ["2", 45, 10, 0.72], ["2", 45, 50, 1.59]]
ASKED = [
    [["Versuch", 1, None, 2], ["Kantwinkel [°]", 30.0, None, 45.0], [None, *PAIR * 2],
        [None, *PAIRS[1]], [None, *PAIRS[2]]],
    [["Versuch", 1, 2], ["Kantwinkel [°]", 30, 45], ["Last [kg]", "Tiefe [mm]", "Tiefe [mm]"], [10, 0.63, 0.72],
        [50, 1.41, 1.59]],
    [["Versuch", "Kantwinkel [°]", *PAIR] * 2, [1, 30, 10, 0.63, 2, 45, 10, 0.72], [1, 30, 50, 1.41, 2, 45, 50, 1.59]],
    [["Versuch", "Kant-", "Last", "Eindring-"], ["Nr.", "winkel [°]", "[kg]", "tiefe [mm]"], *ROWS],
    [["Test", "Edge", "Load", "Penetration"], ["no.", "angle [°]", "[kg]", "depth [mm]"], *ROWS],
    [["Hang oben"], *PAIRS],
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
    [["Versuch", "Kantwinkel", "Last", "Tiefe"], ["A", "30°", "100 N", "0,5 mm"], ["A", "30°", "200 N", "0,9 mm"]],
]  # fmt: skip


def _book(rows: list[list[Any]]) -> bytes:
    book = Workbook()
    sheet = book.active
    sheet.title = "Hang oben"
    for row in rows:
        sheet.append(row)
    book.create_sheet("Notizen").append(["Skistück 200 x 62 mm"])
    return bytes_of(book)


@pytest.mark.parametrize("rows", ASKED)
def test_unclear_series_and_headings_are_errors_with_an_option(rows: list[list[Any]]) -> None:
    proposal = propose(FILE, _book(rows), Answers(site={"Hang oben": "Hang oben"}))
    assert not proposal.files
    assert any(f"--{question.option}" in str(question.problem) for question in proposal.questions)
