"""Import of workbooks in everyday layouts: the right numbers, or an error that names the option."""

import hashlib
import tomllib
from collections.abc import Callable

import pytest
from openpyxl import Workbook
from tests.present import present

from skisnow._support.errors import ParameterError
from skisnow.campaign.importing.answers import Answers
from skisnow.campaign.importing.proposal import propose
from skisnow.campaign.importing.sheets import read_sheets
from skisnow.campaign.reading.campaign import campaign_of_files
from skisnow.estimation.result_rows import experiment_hardness

from . import layouts
from .layouts import FILE, G, bytes_of, everyday, hardness, in_language, issues, require_right, set_cell


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


TOOLS = "Werkzeug: Skistück 20 x 6,2 cm; Scherblatt 10 cm"


@pytest.mark.parametrize(
    "change",
    [
        layouts.as_numbers,
        layouts.load_first,
        layouts.in_grams,
        layouts.units_in_headings,
        in_language("Test", "Edge angle", "Load", "Penetration depth", "Remark", "Depth", "Lever arm", "Torque"),
        in_language(
            "Essai", "Angle de carre", "Charge", "Profondeur", "Remarque", "Profondeur", "Bras de levier", "Moment"
        ),
        in_language("Prova", "Angolo", "Carico", "Profondità", "Note", "Profondità", "Braccio", "Momento"),
        layouts.scaled("C", G, "N"),
        layouts.scaled("C", G / 10.0, "daN"),
        layouts.scaled("D", 0.1, "cm"),
        layouts.exchanged(5, 12),
        layouts.dates_as_text,
        layouts.merged_to_the_right,
        layouts.empty_column(2),
        layouts.empty_column(3),
        layouts.empty_column(4),
        set_cell("Hang oben", "A3", "Ort: Hang oben"),
        set_cell("Hang oben", "C5", "Gewicht"),
        set_cell("Hang oben", "C5", "Masse"),
        set_cell("Hang oben", "C6", "[kg]"),
        set_cell("Notizen", "A1", TOOLS),
        set_cell("Hang oben", "F8", "gut"),
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
    (layouts.scaled("C", G, None), {"unit": {"penetration.Last": "N"}}),
    (layouts.scaled("D", 0.1, None), {"unit": {"penetration.Eindringtiefe": "cm"}}),
    (layouts.exchanged(5, 6), {}),
    (layouts.density_with_pressures, {}),
    (layouts.without_units, {"unit": {"penetration.Kantwinkel": "°", "penetration.Last": "kg",
        "penetration.Eindringtiefe": "mm"}}),
    (layouts.hidden_copy, {"table": {"Alle Daten:5": "-", "Alle Daten:15": "-"}}),
    (layouts.insert_row(13, ["ab hier Stempel 2,1 kg dazu"]), {"ignore": {"Hang oben!13": "yes"}}),
    (set_cell("Hang oben", "C6", None), {"unit": {"penetration.Last": "kg"}}),
    (set_cell("Hang oben", "C6", "lbs"), {}),
    (set_cell("Hang oben", "D16", None), {}),
    (set_cell("Hang oben", "C5", "Zusatz"), {"column": {"Zusatz": "load_N"}}),
    (set_cell("Hang oben", "D5", "Tiefe der Messuhr"), {"column": {"Tiefe der Messuhr": "depth_mm"}}),
    (set_cell("Hang oben", "E5", "Tiefe"), {"column": {"Tiefe": "-", "shear.Tiefe": "depth_mm"}}),
    (set_cell("Hang oben", "A1", "Schneemessung am 14.02.2026"), {"site": {"Hang oben": "Hang oben"}}),
    (set_cell("Hang oben", "A3", "Ort: Gletscher"), {"site": {"Hang oben": "Hang oben"}}),
    (set_cell("Notizen", "A1", "Scherblatt 100 mm"), {"tool": {"": "ski 200 x 62 mm"}}),
    (set_cell("Notizen", "A1", "Skistück 200 x 62; Scherblatt 100 mm"), {"tool": {"": "ski 200 x 62 mm"}}),
    (set_cell("Notizen", "A1", "Skistück 62 x 200 mm; Scherblatt 100 mm"), {"ignore": {"Notizen!1": "yes"},
        "tool": {"": "ski 200 x 62 mm"}, "plate": {"": "100 mm"}}),
    (set_cell("Notizen", "A1", "Skistück 200 x 62 mm; Scherblatt 100 mm, ab S4 80 mm"), {"ignore": {"Notizen!1": "yes"},
        "tool": {"": "ski 200 x 62 mm"}, "plate": {"": "100 mm"}}),
    (set_cell("Notizen", "A2", "Last ohne Stempel (2,1 kg)"), {"ignore": {"Notizen!2": "yes"}}),
    (set_cell("Notizen", "A2", "Last in N"), {}),
    (layouts.unmerge, {"cells": {"fill-down": "yes"}}),
    (layouts.insert_row(13, ["Mittelwert", 30, "30,0", "1,2"]), {"ignore": {"Hang oben!13": "yes"}}),
    (set_cell("Hang oben", "D7", "0.63"), {}),
    (set_cell("Hang oben", "D7", "ca. 0,63"), {}),
    (set_cell("Hang oben", "F9", "1,59"), {"ignore": {"Hang oben!F": "yes"}}),
    (layouts.excluded_row(is_struck=True), {"cells": {"struck": "no"}}),
    (layouts.excluded_row(is_struck=False), {"cells": {"hidden": "no"}}),
    (layouts.hidden_measurements, {"cells": {"hidden": "no"}}),
    (layouts.hidden_column, {"cells": {"hidden": "no"}}),
    (layouts.partly_struck, {"ignore": {"Hang oben!13": "yes"}}),
    (layouts.second_sheet, {"table": {"Alle Daten:5": "-", "Alle Daten:15": "-"}}),
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
    layouts.as_numbers(book)
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
