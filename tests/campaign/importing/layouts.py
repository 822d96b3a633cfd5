"""Workbooks in everyday layouts, changes to them, and what a right import of them gives."""

import io
from collections.abc import Callable
from typing import Any

import pytest
from openpyxl import Workbook
from openpyxl.cell.rich_text import CellRichText, TextBlock
from openpyxl.cell.text import InlineFont
from openpyxl.styles import Font
from tests.present import present

from skisnow.campaign.importing.proposal import Proposal
from skisnow.campaign.reading.campaign import campaign_of_files
from skisnow.estimation.result_rows import experiment_hardness

G = 9.80665
DEPTHS = {"1": ("0,63", "0,89", "1,41"), "2": ("0,72", "1,03", "1,59")}
ANGLES = {"1": 30, "2": 45}
FILE = "Hang.xlsx"


def everyday() -> Workbook:
    """A sheet with titles, two tables, units, merged cells, kg and cm, decimal commas, and a sheet with notes."""
    book = Workbook()
    sheet = book.active
    sheet.title = "Hang oben"
    sheet.append(["Schneemessung, Hang oben, 14.02.2026, Beobachter: A / B"])
    sheet.append(["Luft -6 °C, Korn rund 0,3 mm. Achtung: Messuhr 0,01 mm"])
    sheet.append([])
    sheet.append(["Eindringversuche"])
    sheet.append(["Versuch", "Kantwinkel", "Last", "Eindringtiefe", "Bemerkung"])
    sheet.append(["Nr.", "°", "kg", "mm"])
    for name, depths in DEPTHS.items():
        first = sheet.max_row + 1
        for mass, depth in zip(("10,0", "20,0", "50,0"), depths, strict=True):
            is_first = mass == "10,0"
            sheet.append([name if is_first else None, ANGLES[name] if is_first else None, mass, depth])
        for column in "AB":
            sheet.merge_cells(f"{column}{first}:{column}{first + 2}")
    sheet.append([])
    sheet.append(["Scherversuche"])
    sheet.append(["Versuch", "Kantwinkel", "Tiefe", "Hebelarm", "Drehmoment"])
    sheet.append(["Nr.", "°", "mm", "cm", "Nm"])
    sheet.append(["S1", 90, "5,8", 25, "23,1"])
    book.create_sheet("Notizen").append(["Werkzeug: Skistück 200 x 62 mm; Scherblatt 100 mm"])
    return book


def bytes_of(book: Workbook) -> bytes:
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def hardness(mass_kg: float, depth_mm: float, angle_deg: float) -> float:
    """H_V (N/mm³) of a 200 x 62 mm piece by the library's own wedge, from numbers that the test converts."""
    from skisnow.geometry import SkiPiece

    volume = SkiPiece(0.2, 0.062).displaced_volume(depth_mm * 1e-3, angle_deg * 3.141592653589793 / 180)
    return mass_kg * G / float(volume) / 1e9


def require_right(proposal: Proposal) -> None:
    assert not proposal.problems, [str(problem) for problem in proposal.problems]
    campaign = campaign_of_files(proposal.files)
    expected = [hardness(50, 1.41, 30), hardness(50, 1.59, 45)]
    assert (experiment_hardness(campaign) / 1e9).tolist() == pytest.approx(expected, rel=1e-9)
    assert present(campaign.penetration).load.tolist() == pytest.approx([10 * G, 20 * G, 50 * G] * 2)
    assert campaign.shear is not None
    assert (campaign.shear.lever_arm[0], campaign.shear.moment[0], campaign.shear.penetration_depth[0]) == (
        pytest.approx(0.25),
        23.1,
        pytest.approx(5.8e-3),
    )
    assert campaign.plates[campaign.shear.plate[0]] == pytest.approx(0.1)
    assert set(present(campaign.penetration).site) == {"Hang oben"}


def issues(proposal: Proposal) -> list[str]:
    """Questions and errors in their order."""
    asked = {
        item.problem: f"{item.option} {item.key}={item.proposed} {len(item.choices)}" for item in proposal.questions
    }
    return [
        f"{asked.get(problem, f'{problem.code} {problem.column}')} {problem.file} {problem.row} "
        f"{problem.value if type(problem.value) is str else ''}".rstrip()
        for problem in proposal.problems
    ]


def set_cell(sheet: str, cell: str, value: Any) -> Callable[[Workbook], None]:
    def change(book: Workbook) -> None:
        book[sheet][cell] = value

    return change


def insert_row(row: int, cells: list[Any]) -> Callable[[Workbook], None]:
    def change(book: Workbook) -> None:
        for column, cell in enumerate(cells, start=1):
            book["Hang oben"].cell(row, column, cell)

    return change


def unmerge(book: Workbook) -> None:
    for area in list(book["Hang oben"].merged_cells.ranges):
        book["Hang oben"].unmerge_cells(str(area))


def as_numbers(book: Workbook) -> None:
    """Numbers as numbers, not as text."""
    for cells in book["Hang oben"].iter_rows(min_row=7, min_col=3, max_col=5):
        for cell in cells:
            if isinstance(cell.value, str) and cell.value.replace(",", "").isdigit():
                cell.value = float(cell.value.replace(",", "."))


def load_first(book: Workbook) -> None:
    """Loads in the first column, where the title of the next table is, too."""
    sheet = book["Hang oben"]
    for first in (7, 10):
        sheet.unmerge_cells(f"A{first}:A{first + 2}")
    for row in range(5, 13):
        sheet[f"A{row}"], sheet[f"C{row}"] = sheet[f"C{row}"].value, sheet[f"A{row}"].value
    for first in (7, 10):
        sheet.merge_cells(f"C{first}:C{first + 2}")


def in_grams(book: Workbook) -> None:
    for row in range(7, 13):
        cell = book["Hang oben"][f"C{row}"]
        cell.value = f"{str(cell.value)[:2]}.000,0"
    book["Hang oben"]["C6"] = "g"


def units_in_headings(book: Workbook) -> None:
    sheet = book["Hang oben"]
    for column, unit in zip("BCD", ("[°]", "(kg)", "/ mm"), strict=True):
        sheet[f"{column}5"] = f"{sheet[f'{column}5'].value} {unit}"
        sheet[f"{column}6"] = None
    sheet["A6"] = None


def second_sheet(book: Workbook) -> None:
    copy = book.copy_worksheet(book["Hang oben"])
    copy.title = "Alle Daten"
    copy["A1"] = "Alle Daten"


def in_language(*words: str) -> Callable[[Workbook], None]:
    """Headings of both tables in another language."""

    def translate(book: Workbook) -> None:
        german = ("Versuch", "Kantwinkel", "Last", "Eindringtiefe", "Bemerkung", "Tiefe", "Hebelarm", "Drehmoment")
        for cells in book["Hang oben"].iter_rows(min_row=5, max_row=16):
            for cell in cells:
                if cell.value in german:
                    cell.value = words[german.index(cell.value)]

    return translate


def scaled(column: str, factor: float, unit: str | None) -> Callable[[Workbook], None]:
    """Numbers of a column of the first table in another unit, as text with a decimal comma."""

    def scale(book: Workbook) -> None:
        for row in range(7, 13):
            cell = book["Hang oben"][f"{column}{row}"]
            cell.value = f"{float(str(cell.value).replace(',', '.')) * factor:.10g}".replace(".", ",")
        book["Hang oben"][f"{column}6"] = unit

    return scale


def exchanged(first: int, last: int) -> Callable[[Workbook], None]:
    """Loads and depths exchanged in some rows."""

    def exchange(book: Workbook) -> None:
        for row in range(first, last + 1):
            left, right = (book["Hang oben"][f"{column}{row}"] for column in "CD")
            left.value, right.value = right.value, left.value

    return exchange


def dates_as_text(book: Workbook) -> None:
    for row, text in zip(range(5, 13), ["Datum", None, *["14.02.2026"] * 6], strict=True):
        book["Hang oben"][f"F{row}"] = text


def merged_to_the_right(book: Workbook) -> None:
    for area in ("A1:H1", "A2:H2", "A4:E4", "A14:E14", "E7:E9"):
        book["Hang oben"].merge_cells(area)


def density_with_pressures(book: Workbook) -> None:
    """A column of densities, and no heading that states the load: not a table of densities."""
    for place, text in (("C5", "Druck"), ("C6", "kPa"), ("E5", "Dichte"), ("E6", "kg/m³"), ("E7", 410), ("E10", 410)):
        book["Hang oben"][place] = text


def without_units(book: Workbook) -> None:
    for column in "ABCD":
        book["Hang oben"][f"{column}6"] = None


def hidden_copy(book: Workbook) -> None:
    second_sheet(book)
    book["Alle Daten"].sheet_state = "hidden"


def empty_column(place: int) -> Callable[[Workbook], None]:
    """A blank column within both tables."""

    def insert(book: Workbook) -> None:
        sheet = book["Hang oben"]
        unmerge(book)
        for row in range(7, 13):
            first = 7 if row < 10 else 10
            sheet[f"A{row}"], sheet[f"B{row}"] = sheet[f"A{first}"].value, sheet[f"B{first}"].value
        sheet.insert_cols(place)

    return insert


def excluded_row(*, is_struck: bool) -> Callable[[Workbook], None]:
    """A third reading of a test, which its author struck through or hid."""

    def exclude(book: Workbook) -> None:
        sheet = book["Hang oben"]
        for column, value in zip("ABCD", ("3", 45, "50,0", "0,50"), strict=True):
            sheet[f"{column}13"] = value
            sheet[f"{column}13"].font = Font(strike=is_struck)
        sheet.row_dimensions[13].hidden = not is_struck

    return exclude


def partly_struck(book: Workbook) -> None:
    """A further test with a depth that its author replaced within the cell."""
    excluded_row(is_struck=False)(book)
    sheet = book["Hang oben"]
    sheet.row_dimensions[13].hidden = False
    sheet["D13"] = CellRichText(TextBlock(InlineFont(strike=True), "0,5"), "1")


def hidden_column(book: Workbook) -> None:
    """A hidden column with other loads."""
    sheet = book["Hang oben"]
    for row, value in enumerate(("Last", "kg", *["99"] * 6), start=5):
        sheet[f"F{row}"] = value
    sheet.column_dimensions["F"].hidden = True


def hidden_measurements(book: Workbook) -> None:
    """A hidden sheet with other depths."""
    second_sheet(book)
    for row in range(7, 13):
        book["Alle Daten"][f"D{row}"] = "0,50"
    book["Alle Daten"]["E17"] = "11,5"
    book["Alle Daten"].sheet_state = "hidden"
