"""What notes around tables state, and numbers in cells as people write them."""

import pytest

from skisnow.campaign.importing.answers import Answers
from skisnow.campaign.importing.columns import (
    Note,
    gauge_steps_mm,
    is_about_numbers,
    length_mm,
    stated_days,
    stated_observers,
    stated_plates,
    stated_sites,
    stated_tools,
    units_in_notes,
)
from skisnow.campaign.importing.folder import parse_plate, parse_tool
from skisnow.campaign.importing.proposal import Proposal, propose
from skisnow.campaign.importing.sections import _named_value
from skisnow.campaign.importing.sheets import column_letters, is_plain_number

from .layouts import issues


def notes(*texts: str) -> list[Note]:
    return [Note("Hang", row, text) for row, text in enumerate(texts, start=1)]


@pytest.mark.parametrize(
    ("text", "tools", "plates"),
    [
        ("Skistück 200 x 62 mm", {"ski 200 x 62 mm"}, set()),
        ("ski 20 × 6,2 cm", {"ski 200 x 62 mm"}, set()),
        ("Ski piece 20 cm * 62 mm; blade 0.1 m", {"ski 200 x 62 mm"}, {"100 mm"}),
        ("ski 62 x 62 mm", {""}, set()),
        ("ski 62 x 200 mm", {""}, set()),
        ("Ski etwa 200 x 62 mm", {""}, set()),
        ("Ski 200 x 62 mm, 3 mm Kante", {""}, set()),
        ("Skistück 200 x 62 mm, 3 mm Kante, Klinge 80 mm", {""}, {""}),
        ("Scheibe Durchmesser 50 mm", {"disc 50 mm"}, set()),
        ("disc ø 5 cm, oder ski 200 x 62 mm", {""}, set()),
        ("Scherblatt 100 mm, Messuhr 0,01 mm", set(), {"100 mm"}),
        ("Schneehöhe 100 mm", set(), set()),
    ],
)
def test_tools_and_blades(text: str, tools: set[str], plates: set[str]) -> None:
    assert (stated_tools(notes(text)), stated_plates(notes(text))) == (tools, plates)


def test_other_statements() -> None:
    assert gauge_steps_mm(notes("Messuhr 0,01 mm", "gauge: 5 µm", "Messuhr neu")) == {0.01, 0.005}
    assert stated_days(notes("am 14.2.2026", "14. 02. 2026", "2026-02-15", "30.02.2026")) == {
        "2026-02-14",
        "2026-02-15",
    }
    assert stated_observers(notes("Beobachter: A / B, kalt", "Observers: B & C+ D", "observer D")) == [
        "A",
        "B",
        "C",
        "D",
    ]
    assert stated_sites("Hang  oben ", notes("Ort: Süd, kalt", "Messung – hang oben")) == {"Süd", "Hang  oben"}
    assert stated_sites("Hang", notes("Hang oben")) == set()
    assert units_in_notes("load_N", notes("Last in kg", "Kraft [N]", "Last in mm")) == {"kg", "n"}
    assert units_in_notes("depth_mm", notes("Last in kg", "Tiefen: cm")) == {"cm"}
    assert [length_mm("6,2", unit) for unit in ("mm", "cm", "m", "µm", "CM")] == [6.2, 62.0, 6200.0, 0.0062, 62.0]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("5 kg", True), ("2,1 kN dazu", True), ("3 Ncm", True), ("410 kg/m³", False), ("Last 3", True),
        ("Lasten ohne Stempel", True), ("Last", False), ("Tiefe am 14.02.2026", False), ("Tiefe 2 am 14.02.2026", True),
        ("Luft -6 °C", False),
    ],
)  # fmt: skip
def test_a_note_may_be_about_the_numbers(text: str, expected: bool) -> None:
    assert is_about_numbers(*notes(text)) is expected


def test_tools_of_answers() -> None:
    ski = parse_tool("A", "ski 20 cm x 62 mm")
    assert ski is not None and (ski.name, dict(ski.keys)) == (
        "A", {"shape": '"ski"', "length_mm": "200", "width_mm": "62"},
    )  # fmt: skip
    disc = parse_tool("", " disc 5,5 cm ")
    assert disc is not None and (disc.name, dict(disc.keys)) == (
        "disc 5,5 cm",
        {"shape": '"disc"', "diameter_mm": "55"},
    )
    cylinder = parse_tool("", "cylinder r 3 x 10 cm")
    assert cylinder is not None
    assert dict(cylinder.keys) == {"shape": '"cylinder"', "radius_mm": "30", "width_mm": "100"}
    plate = parse_plate("", "10 cm")
    assert plate is not None and (plate.name, plate.keys) == ("10 cm", (("length_mm", "100"),))
    assert parse_plate("P", "10 cm") != plate
    assert parse_tool("A", "200 x 62 mm") is parse_plate("", "long") is None


@pytest.mark.parametrize(
    ("text", "heading", "value"),
    [("Versuch 1", "Versuch", "1"), ("Kantwinkel: 30°", "Kantwinkel", "30°"), ("Korn 1", "", "Korn 1"),
     ("Hang 1", "Hang", "1"), ("Test no. 2", "Test no.", "2"),
     ("Kantwinkel = 4 5", "Kantwinkel", "4 5"), ("Versuch", "", "Versuch")],
)  # fmt: skip
def test_words_of_titles(text: str, heading: str, value: str) -> None:
    assert _named_value(text) == (heading, value)


def test_letters_of_columns_and_numbers() -> None:
    letters = [column_letters(column) for column in (0, 25, 26, 51, 52, 701, 702)]
    assert letters == ["A", "Z", "AA", "AZ", "BA", "ZZ", "AAA"]
    texts = ["1", "-1,5", "1.5", "14.02.2026", "9:30", "2026-02-14T09:30", "1e3", "", "N", "1 N", "/", "1/2"]
    assert [text for text in texts if not is_plain_number(text)] == ["", "N", "1 N", "/"]


def proposal_of(loads: list[str], *, separator: str = ";", **answers: dict[str, str]) -> Proposal:
    lines = [
        "Skistück 200 x 62 mm",
        "Ort: Hang",
        separator.join(("Versuch", "Kantwinkel [°]", "Last [g]", "Tiefe [mm]")),
    ]
    depths = [str(depth + 1) for depth in range(len(loads))]
    lines += [separator.join(("1", "30", load, depth)) for load, depth in zip(loads, depths, strict=True)]
    return propose("Hang.csv", "\n".join(lines).encode(), Answers(**answers))


@pytest.mark.parametrize(
    ("loads", "answers", "grams"),
    [
        (["1'000", "2’500,5"], {}, [1000.0, 2500.5]),
        (["1.000,5", "2.500,5"], {}, [1000.5, 2500.5]),
        (["1,000.5", "2,500.5"], {}, [1000.5, 2500.5]),
        (["12,5", "+1000"], {}, [12.5, 1000.0]),
        (["12.5", "1e3"], {}, [12.5, 1000.0]),
        (["1.500", "2.500"], {"decimal": "."}, [1.5, 2.5]),
        (["1.500", "2.500"], {"decimal": ",", "thousands": "."}, [1500.0, 2500.0]),
        (["1,500", "2,500"], {"decimal": ".", "thousands": ","}, [1500.0, 2500.0]),
    ],
)
def test_numbers_as_people_write_them(loads: list[str], answers: dict[str, str], grams: list[float]) -> None:
    proposal = proposal_of(loads, cells=answers, unit={"Last": "g"})
    assert issues(proposal) == []
    assert [float(row.cells["load_N"]) for row in proposal.tables[0].rows] == pytest.approx(
        [gram * 9.80665e-3 for gram in grams], rel=1e-9
    )


@pytest.mark.parametrize(
    ("loads", "answers", "expected"),
    [
        (["1.500", "2.500"], {}, ["cells decimal= 2 Hang:3 None 1.500"]),
        (["1.5", "2,5"], {}, ["cells decimal= 2 Hang:3 None , .", "not_a_number Last [g] Hang 5 2,5"]),
        (["1.500", "12,5"], {}, ["cells thousands= 1 Hang:3 4 1.500"]),
        (["1.500", "2.500"], {"decimal": ",", "thousands": ","}, ["cells thousands= 1 Hang:3 4 1.500"]),
        (["-", "5"], {}, ["not_a_number Last [g] Hang 4 -"]),
    ],
)
def test_unclear_numbers_are_asked_about(loads: list[str], answers: dict[str, str], expected: list[str]) -> None:
    proposal = proposal_of(loads, cells=answers, unit={"Last": "g"})
    assert issues(proposal) == expected


def test_decimal_commas_that_split_cells() -> None:
    proposal = propose(
        "Hang.csv",
        b"Ski 200 x 62 mm\nOrt: Hang\nVersuch,Kantwinkel [\xc2\xb0],Last [kg],Tiefe [mm],Bemerkung\n1,30,10,0,63\n",
    )
    assert [(problem.code, problem.row, problem.column) for problem in proposal.problems] == [
        ("split_number", 4, "Bemerkung")
    ]
