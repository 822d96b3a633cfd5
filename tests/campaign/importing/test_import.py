"""Import of workbooks in everyday layouts: the right numbers, or an error that names the option."""

import hashlib
import io
import tomllib
from collections.abc import Callable
from typing import Any

import pytest
from openpyxl import Workbook
from openpyxl.cell.rich_text import CellRichText, TextBlock
from openpyxl.cell.text import InlineFont
from openpyxl.styles import Font
from tests.present import present

from skisnow._support.errors import ParameterError
from skisnow.campaign.importing.answers import Answers
from skisnow.campaign.importing.proposal import Proposal, propose
from skisnow.campaign.importing.sheets import read_sheets
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


def test_everyday_workbook_needs_no_answer() -> None:
    proposal = propose(FILE, bytes_of(everyday()))
    require_right(proposal)
    campaign = campaign_of_files(proposal.files)
    assert campaign.gauge_resolution == pytest.approx(1e-5)
    assert campaign.observers == ("A", "B")
    assert read_sheets(FILE, proposal.files["original/Hang.xlsx"]) == read_sheets(FILE, bytes_of(everyday()))
    rows = ["experiment,site,tool,edge_angle_deg,load_N,depth_mm,time,remark"]
    for name, angle, mass, depth in (
        (1, 30, 10, 0.63), (1, 30, 20, 0.89), (1, 30, 50, 1.41), (2, 45, 10, 0.72), (2, 45, 20, 1.03), (2, 45, 50, 1.59)
    ):  # fmt: skip
        rows.append(f"{name},Hang oben,ski 200 x 62 mm,{angle},{mass * G:.10g},{depth},2026-02-14,")
    assert proposal.files["penetration.csv"].decode().splitlines() == rows
    assert proposal.files["shear.csv"].decode().splitlines() == [
        "experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm,time",
        "S1,Hang oben,100 mm,90,5.8,250,23.1,2026-02-14",
    ]
    head = tomllib.loads(proposal.files["campaign.toml"].decode())
    template = head.pop("import")
    assert head == {
        "name": "Hang", "observers": ["A", "B"], "gauge_resolution_mm": 0.01,
        "tool": [{"name": "ski 200 x 62 mm", "shape": "ski", "length_mm": 200, "width_mm": 62}],
        "plate": [{"name": "100 mm", "length_mm": 100}],
    }  # fmt: skip
    assert [note[: note.index(":")] for note in template["notes"]] == [
        *(f"Hang oben, {row}" for row in (1, 2, 4, 14)), "Notizen, 1",
    ]  # fmt: skip
    assert template["sha256"] == hashlib.sha256(proposal.files["original/Hang.xlsx"]).hexdigest()
    assert [row.source for row in proposal.tables[0].rows] == [7, 8, 9, 10, 11, 12]
    assert template["unit"]["shear.Hebelarm"] == "cm"
    assert list(template["column"].values())[:6] == [
        *rows[0].split(",")[0:1],
        *rows[0].split(",")[3:6],
        "remark",
        "experiment",
    ]


def test_sheet_named_like_a_table_is_imported_once() -> None:
    book = everyday()
    book["Hang oben"].title = "shear"
    proposal = propose(FILE, bytes_of(book), Answers(site={"shear": "Hang oben"}))
    require_right(proposal)


def _set(sheet: str, cell: str, value: Any) -> Callable[[Workbook], None]:
    def change(book: Workbook) -> None:
        book[sheet][cell] = value

    return change


def _insert_row(row: int, cells: list[Any]) -> Callable[[Workbook], None]:
    def change(book: Workbook) -> None:
        for column, cell in enumerate(cells, start=1):
            book["Hang oben"].cell(row, column, cell)

    return change


def _unmerge(book: Workbook) -> None:
    for area in list(book["Hang oben"].merged_cells.ranges):
        book["Hang oben"].unmerge_cells(str(area))


def _numbers(book: Workbook) -> None:
    """Numbers as numbers, not as text."""
    for cells in book["Hang oben"].iter_rows(min_row=7, min_col=3, max_col=5):
        for cell in cells:
            if isinstance(cell.value, str) and cell.value.replace(",", "").isdigit():
                cell.value = float(cell.value.replace(",", "."))


def _load_first(book: Workbook) -> None:
    """Loads in the first column, where the title of the next table is, too."""
    sheet = book["Hang oben"]
    for first in (7, 10):
        sheet.unmerge_cells(f"A{first}:A{first + 2}")
    for row in range(5, 13):
        sheet[f"A{row}"], sheet[f"C{row}"] = sheet[f"C{row}"].value, sheet[f"A{row}"].value
    for first in (7, 10):
        sheet.merge_cells(f"C{first}:C{first + 2}")


def _grams(book: Workbook) -> None:
    for row in range(7, 13):
        cell = book["Hang oben"][f"C{row}"]
        cell.value = f"{str(cell.value)[:2]}.000,0"
    book["Hang oben"]["C6"] = "g"


def _units_in_headings(book: Workbook) -> None:
    sheet = book["Hang oben"]
    for column, unit in zip("BCD", ("[°]", "(kg)", "/ mm"), strict=True):
        sheet[f"{column}5"] = f"{sheet[f'{column}5'].value} {unit}"
        sheet[f"{column}6"] = None
    sheet["A6"] = None


def _second_sheet(book: Workbook) -> None:
    copy = book.copy_worksheet(book["Hang oben"])
    copy.title = "Alle Daten"
    copy["A1"] = "Alle Daten"


def _in_language(*words: str) -> Callable[[Workbook], None]:
    """Headings of both tables in another language."""

    def translate(book: Workbook) -> None:
        german = ("Versuch", "Kantwinkel", "Last", "Eindringtiefe", "Bemerkung", "Tiefe", "Hebelarm", "Drehmoment")
        for cells in book["Hang oben"].iter_rows(min_row=5, max_row=16):
            for cell in cells:
                if cell.value in german:
                    cell.value = words[german.index(cell.value)]

    return translate


def _scaled(column: str, factor: float, unit: str | None) -> Callable[[Workbook], None]:
    """Numbers of a column of the first table in another unit, as text with a decimal comma."""

    def scale(book: Workbook) -> None:
        for row in range(7, 13):
            cell = book["Hang oben"][f"{column}{row}"]
            cell.value = f"{float(str(cell.value).replace(',', '.')) * factor:.10g}".replace(".", ",")
        book["Hang oben"][f"{column}6"] = unit

    return scale


def _exchanged(first: int, last: int) -> Callable[[Workbook], None]:
    """Loads and depths exchanged in some rows."""

    def exchange(book: Workbook) -> None:
        for row in range(first, last + 1):
            left, right = (book["Hang oben"][f"{column}{row}"] for column in "CD")
            left.value, right.value = right.value, left.value

    return exchange


def _dates_as_text(book: Workbook) -> None:
    for row, text in zip(range(5, 13), ["Datum", None, *["14.02.2026"] * 6], strict=True):
        book["Hang oben"][f"F{row}"] = text


def _merged_to_the_right(book: Workbook) -> None:
    for area in ("A1:H1", "A2:H2", "A4:E4", "A14:E14", "E7:E9"):
        book["Hang oben"].merge_cells(area)


def _density_with_pressures(book: Workbook) -> None:
    """A column of densities, and no heading that states the load: not a table of densities."""
    for place, text in (("C5", "Druck"), ("C6", "kPa"), ("E5", "Dichte"), ("E6", "kg/m³"), ("E7", 410), ("E10", 410)):
        book["Hang oben"][place] = text


def _without_units(book: Workbook) -> None:
    for column in "ABCD":
        book["Hang oben"][f"{column}6"] = None


def _hidden_copy(book: Workbook) -> None:
    _second_sheet(book)
    book["Alle Daten"].sheet_state = "hidden"


def _empty_column(place: int) -> Callable[[Workbook], None]:
    """A blank column within both tables."""

    def insert(book: Workbook) -> None:
        sheet = book["Hang oben"]
        _unmerge(book)
        for row in range(7, 13):
            first = 7 if row < 10 else 10
            sheet[f"A{row}"], sheet[f"B{row}"] = sheet[f"A{first}"].value, sheet[f"B{first}"].value
        sheet.insert_cols(place)

    return insert


def _excluded_row(*, is_struck: bool) -> Callable[[Workbook], None]:
    """A third reading of a test, which its author struck through or hid."""

    def exclude(book: Workbook) -> None:
        sheet = book["Hang oben"]
        for column, value in zip("ABCD", ("3", 45, "50,0", "0,50"), strict=True):
            sheet[f"{column}13"] = value
            sheet[f"{column}13"].font = Font(strike=is_struck)
        sheet.row_dimensions[13].hidden = not is_struck

    return exclude


def _partly_struck(book: Workbook) -> None:
    """A further test with a depth that its author replaced within the cell."""
    _excluded_row(is_struck=False)(book)
    sheet = book["Hang oben"]
    sheet.row_dimensions[13].hidden = False
    sheet["D13"] = CellRichText(TextBlock(InlineFont(strike=True), "0,5"), "1")


def _hidden_column(book: Workbook) -> None:
    """A hidden column with other loads."""
    sheet = book["Hang oben"]
    for row, value in enumerate(("Last", "kg", *["99"] * 6), start=5):
        sheet[f"F{row}"] = value
    sheet.column_dimensions["F"].hidden = True


def _hidden_measurements(book: Workbook) -> None:
    """A hidden sheet with other depths."""
    _second_sheet(book)
    for row in range(7, 13):
        book["Alle Daten"][f"D{row}"] = "0,50"
    book["Alle Daten"]["E17"] = "11,5"
    book["Alle Daten"].sheet_state = "hidden"


TOOLS = "Werkzeug: Skistück 20 x 6,2 cm; Scherblatt 10 cm"


@pytest.mark.parametrize(
    "change",
    [
        _numbers,
        _load_first,
        _grams,
        _units_in_headings,
        _in_language("Test", "Edge angle", "Load", "Penetration depth", "Remark", "Depth", "Lever arm", "Torque"),
        _in_language(
            "Essai", "Angle de carre", "Charge", "Profondeur", "Remarque", "Profondeur", "Bras de levier", "Moment"
        ),
        _in_language("Prova", "Angolo", "Carico", "Profondità", "Note", "Profondità", "Braccio", "Momento"),
        _scaled("C", G, "N"),
        _scaled("C", G / 10.0, "daN"),
        _scaled("D", 0.1, "cm"),
        _exchanged(5, 12),
        _dates_as_text,
        _merged_to_the_right,
        _empty_column(2),
        _empty_column(3),
        _empty_column(4),
        _set("Hang oben", "A3", "Ort: Hang oben"),
        _set("Hang oben", "C5", "Gewicht"),
        _set("Hang oben", "C5", "Masse"),
        _set("Hang oben", "C6", "[kg]"),
        _set("Notizen", "A1", TOOLS),
        _set("Hang oben", "F8", "gut"),
    ],
    ids=lambda change: getattr(change, "__name__", "cell"),
)
def test_variants_with_the_same_statements_give_the_same_numbers(change: Callable[[Workbook], None]) -> None:
    book = everyday()
    change(book)
    if change.__name__ == "change" and book["Hang oben"]["F8"].value:
        assert {problem.code for problem in propose(FILE, bytes_of(book)).problems} == {"no_heading"}
        return
    require_right(propose(FILE, bytes_of(book)))


OPEN = [
    (_scaled("C", G, None), {"unit": {"penetration.Last": "N"}}),
    (_scaled("D", 0.1, None), {"unit": {"penetration.Eindringtiefe": "cm"}}),
    (_exchanged(5, 6), {}),
    (_density_with_pressures, {}),
    (_without_units, {"unit": {"penetration.Kantwinkel": "°", "penetration.Last": "kg",
        "penetration.Eindringtiefe": "mm"}}),
    (_hidden_copy, {"table": {"Alle Daten:5": "-", "Alle Daten:15": "-"}}),
    (_insert_row(13, ["ab hier Stempel 2,1 kg dazu"]), {"ignore": {"Hang oben!13": "yes"}}),
    (_set("Hang oben", "C6", None), {"unit": {"penetration.Last": "kg"}}),
    (_set("Hang oben", "C6", "lbs"), {}),
    (_set("Hang oben", "D16", None), {}),
    (_set("Hang oben", "C5", "Zusatz"), {"column": {"Zusatz": "load_N"}}),
    (_set("Hang oben", "D5", "Tiefe der Messuhr"), {"column": {"Tiefe der Messuhr": "depth_mm"}}),
    (_set("Hang oben", "E5", "Tiefe"), {"column": {"Tiefe": "-", "shear.Tiefe": "depth_mm"}}),
    (_set("Hang oben", "A1", "Schneemessung am 14.02.2026"), {"site": {"Hang oben": "Hang oben"}}),
    (_set("Hang oben", "A3", "Ort: Gletscher"), {"site": {"Hang oben": "Hang oben"}}),
    (_set("Notizen", "A1", "Scherblatt 100 mm"), {"tool": {"": "ski 200 x 62 mm"}}),
    (_set("Notizen", "A1", "Skistück 200 x 62; Scherblatt 100 mm"), {"tool": {"": "ski 200 x 62 mm"}}),
    (_set("Notizen", "A1", "Skistück 62 x 200 mm; Scherblatt 100 mm"), {"ignore": {"Notizen!1": "yes"},
        "tool": {"": "ski 200 x 62 mm"}, "plate": {"": "100 mm"}}),
    (_set("Notizen", "A1", "Skistück 200 x 62 mm; Scherblatt 100 mm, ab S4 80 mm"), {"ignore": {"Notizen!1": "yes"},
        "tool": {"": "ski 200 x 62 mm"}, "plate": {"": "100 mm"}}),
    (_set("Notizen", "A2", "Last ohne Stempel (2,1 kg)"), {"ignore": {"Notizen!2": "yes"}}),
    (_set("Notizen", "A2", "Last in N"), {}),
    (_unmerge, {"cells": {"fill-down": "yes"}}),
    (_insert_row(13, ["Mittelwert", 30, "30,0", "1,2"]), {"ignore": {"Hang oben!13": "yes"}}),
    (_set("Hang oben", "D7", "0.63"), {}),
    (_set("Hang oben", "D7", "ca. 0,63"), {}),
    (_set("Hang oben", "F9", "1,59"), {"ignore": {"Hang oben!F": "yes"}}),
    (_excluded_row(is_struck=True), {"cells": {"struck": "no"}}),
    (_excluded_row(is_struck=False), {"cells": {"hidden": "no"}}),
    (_hidden_measurements, {"cells": {"hidden": "no"}}),
    (_hidden_column, {"cells": {"hidden": "no"}}),
    (_partly_struck, {"ignore": {"Hang oben!13": "yes"}}),
    (_second_sheet, {"table": {"Alle Daten:5": "-", "Alle Daten:15": "-"}}),
]  # fmt: skip


ISSUES: list[list[str]] = [
    ["unit penetration.Last= 5 Hang oben:5 None Last"],
    ["unit penetration.Eindringtiefe= 6 Hang oben:5 None Eindringtiefe"],
    ["implausible_hardness None Hang.xlsx None"],
    ["table Hang oben:5=penetration 5 Hang oben:5 None Versuch, Kantwinkel, Druck, Eindringtiefe, Dichte"],
    [
        "unit penetration.Kantwinkel= 2 Hang oben:5 None Kantwinkel",
        "unit penetration.Last= 5 Hang oben:5 None Last",
        "unit penetration.Eindringtiefe= 6 Hang oben:5 None Eindringtiefe",
    ],
    [
        "cells hidden= 2 Alle Daten:5 7",
        "repeated_table None Alle Daten:5 None Hang oben:5",
        "repeated_table None Alle Daten:15 None Hang oben:15",
    ],
    ["ignore Hang oben!13= 0 Hang oben 13 ab hier Stempel 2,1 kg dazu"],
    ["unit penetration.Last= 5 Hang oben:5 None Last"],
    ["unit penetration.Last= 5 Hang oben:5 None lbs"],
    ["unit shear.Hebelarm= 6 Hang oben:15 None Hebelarm"],
    ["table Hang oben:5=penetration 5 Hang oben:5 None Versuch, Kantwinkel, Zusatz, Eindringtiefe, Bemerkung"],
    ["table Hang oben:5=penetration 5 Hang oben:5 None Versuch, Kantwinkel, Last, Tiefe der Messuhr, Bemerkung"],
    [
        "column penetration.Eindringtiefe=depth_mm 2 Hang oben:5 None Eindringtiefe",
        "column penetration.Tiefe=depth_mm 2 Hang oben:5 None Tiefe",
        "unit penetration.Tiefe= 6 Hang oben:5 None Tiefe",
    ],
    ["site Hang oben=Hang oben 0 Hang oben:5 None"],
    ["site Hang oben=Hang oben 2 Hang oben:5 None Gletscher, Hang oben"],
    ["tool =ski 200 x 62 mm 0 Hang oben:5 None"],
    ["tool =ski 200 x 62 mm 0 Hang oben:5 None"],
    ["tool =ski 200 x 62 mm 0 Hang oben:5 None"],
    ["tool =ski 200 x 62 mm 0 Hang oben:5 None", "plate =100 mm 0 Hang oben:15 None"],
    ["ignore Notizen!2= 0 Notizen 2 Last ohne Stempel (2,1 kg)"],
    ["other_unit Last Hang oben:5 None kg, n"],
    ["cells fill-down=yes 1 Hang oben:5 8"],
    ["ignore Hang oben!13= 0 Hang oben:5 13 Mittelwert"],
    [
        "cells decimal= 2 Hang oben:5 None , .",
        "not_a_number Last Hang oben 7 10,0",
        "not_a_number Last Hang oben 8 20,0",
        "not_a_number Eindringtiefe Hang oben 8 0,89",
        "not_a_number Last Hang oben 9 50,0",
        "not_a_number Eindringtiefe Hang oben 9 1,41",
        "not_a_number Last Hang oben 10 10,0",
        "not_a_number Eindringtiefe Hang oben 10 0,72",
        "not_a_number Last Hang oben 11 20,0",
        "not_a_number Eindringtiefe Hang oben 11 1,03",
        "not_a_number Last Hang oben 12 50,0",
        "not_a_number Eindringtiefe Hang oben 12 1,59",
    ],
    ["not_a_number Eindringtiefe Hang oben 7 ca. 0,63"],
    ["no_heading F Hang oben 9 1,59"],
    ["cells struck= 2 Hang oben:5 13"],
    ["cells hidden= 2 Hang oben:5 13"],
    ["cells hidden= 2 Alle Daten:5 7"],
    ["cells hidden= 2 Hang oben:5 None"],
    ["ignore Hang oben!13= 0 Hang oben:5 13"],
    ["repeated_table None Alle Daten:5 None Hang oben:5", "repeated_table None Alle Daten:15 None Hang oben:15"],
]
"""Of each case above: option, key, proposed answer and number of choices, or code and column; place, row and value."""


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


@pytest.mark.parametrize(
    ("change", "answers", "expected"), [(*case, found) for case, found in zip(OPEN, ISSUES, strict=True)]
)
def test_an_unstated_fact_is_an_error(
    change: Callable[[Workbook], None], answers: dict[str, dict[str, str]], expected: list[str]
) -> None:
    book = everyday()
    change(book)
    data = bytes_of(book)
    rejected = propose(FILE, data)
    assert issues(rejected) == expected
    assert not rejected.files
    for question in rejected.questions:
        assert f"--{question.option}" in str(question.problem)
    if answers:
        require_right(propose(FILE, data, Answers(**answers)))


def test_the_only_unknown_heading_is_proposed_for_the_only_missing_column() -> None:
    book = everyday()
    book["Hang oben"]["D5"] = "Anzeige"
    answers = Answers(table={"Hang oben:5": "penetration"})
    (question,) = propose(FILE, bytes_of(book), answers).questions
    assert (question.key, question.proposed) == ("penetration.Anzeige", "depth_mm")
    require_right(propose(FILE, bytes_of(book), answers.with_("column", question.key, question.proposed)))


def test_tests_of_one_name_and_site_on_two_sheets_are_an_error() -> None:
    book = everyday()
    first = book["Hang oben"]
    first["A3"] = "Ort: Hang"
    second = book.copy_worksheet(first)
    first.title, second.title, second["E17"].value = "Tag 1", "Tag 2", "23,2"
    for row in range(7, 13):
        second[f"D{row}"] = f"1,{row:02d}"
    proposal = propose(FILE, bytes_of(book))
    assert {problem.code for problem in proposal.problems} == {"mixed_experiment"}
    assert not proposal.files


def test_thousands_separators_are_not_decimal_marks() -> None:
    book = everyday()
    sheet = book["Hang oben"]
    _numbers(book)
    for row in range(7, 13):
        sheet[f"C{row}"] = "12,500"
    sheet["C6"] = "g"
    assert [question.key for question in propose(FILE, bytes_of(book)).questions] == ["decimal"]
    with_comma = propose(FILE, bytes_of(book), Answers(cells={"decimal": ","}))
    campaign = campaign_of_files(with_comma.files)
    assert present(campaign.penetration).load[0] == pytest.approx(12.5e-3 * G)


def test_points_between_thousands_are_asked_for_where_commas_are_decimal_marks() -> None:
    book = everyday()
    for row in range(7, 13):
        cell = book["Hang oben"][f"C{row}"]
        cell.value = f"{str(cell.value)[:2]}.000"
    book["Hang oben"]["C6"] = "g"
    proposal = propose(FILE, bytes_of(book))
    assert ([question.key for question in proposal.questions], proposal.files) == (["thousands"], {})
    require_right(propose(FILE, bytes_of(book), Answers(cells={"thousands": "."})))


def test_each_table_of_a_sheet_has_the_site_above_it() -> None:
    rows = "Ort: oben\nVersuch;Kantwinkel;Last;Tiefe\n;°;kg;mm\n1;30;50;1,41\n\n"
    text = f"Skistück 200 x 62 mm\n{rows}{rows.replace('oben', 'unten').replace('1,41', '1,59')}"
    campaign = campaign_of_files(propose("Hang.csv", text.encode()).files)
    assert present(campaign.penetration).site == ("oben", "unten")
    unnamed = propose("Hang.csv", text.replace("Ort: ", "").encode(), Answers(site={"Hang:3": "A", "Hang:8": "B"}))
    campaign = campaign_of_files(unnamed.files)
    assert present(present(campaign.penetration)).site == ("A", "B")


def test_csv_with_titles_is_read_with_its_separator() -> None:
    text = (
        "Messung, Hang oben, 14.02.2026, Skistück 200 x 62 mm\n\nVersuch;Kantwinkel;Last;Tiefe\n;°;kg;mm\n"
        "1;30;10,0;0,63\n1;30;50,0;1,41\n"
    )
    proposal = propose("Hang oben.csv", text.encode("cp1252"))
    assert not proposal.problems
    campaign = campaign_of_files(proposal.files)
    assert (experiment_hardness(campaign) / 1e9).tolist() == pytest.approx([hardness(50, 1.41, 30)])
    split = text.replace(";", ",").replace("Hang oben, ", "Hang oben; ")
    assert not propose("Hang oben.csv", split.encode()).files
    with_texts = split.replace("Tiefe\n", "Tiefe,Bemerkung,Wetter\n")
    assert "split_number" in {problem.code for problem in propose("Hang oben.csv", with_texts.encode()).problems}


def test_force_at_a_lever_arm_is_no_penetration_test() -> None:
    """The depth and force of a shear test by a spring balance would otherwise be read as those of a penetration."""
    text = "Versuch;Kantwinkel (°);Tiefe (mm);Hebelarm (cm);Kraft (kg)\nS1;45;5,8;25;9,42\n"
    proposal = propose("Scherung.csv", text.encode())
    assert [question.option for question in proposal.questions] == ["table"]


def test_the_error_of_a_damaged_workbook_names_it() -> None:
    with pytest.raises(ParameterError, match=r"one\.xlsx: "):
        read_sheets("one.xlsx", b"PK\3\4 and no more")
