"""A measured ski that comes in, and the skis of the lab."""

import io
import tomllib
import warnings
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest
from nicegui import ui

from skisnow._support.errors import OutputError, ParameterError, RangeWarning, SkisnowError
from skisnow.ski import read_ski
from skisnow.web import lab_skis as measured_ski
from skisnow.web.lab_skis import LabSkis, check_ski_texts, read_ski_files, ski_of_texts, ski_of_uploads, texts_of_ski
from skisnow.web.settings import Limits
from skisnow.web.ski_editor import FACTORS, SkiEditInput, edit_ski_texts
from skisnow.web.uploads import SKI_BOUNDS
from tests.coded import Coded, coded, raises

from ..desk import Desk, Sheet
from .shared import CARVER, HEAVY, TEXT, files, opened, saved_place

TYPED = {
    "length_mm": "1593", "running_length_mm": "1396", "sidecut_length_mm": "1458", "tip_width_mm": "116",
    "waist_width_mm": "68", "tail_width_mm": "101", "mass_kg": "2,231", "camber_mm": "7",
    "EI_N_m2": "100 250; 440, 260,5 100", "GJ_N_m2": "60 140 175 140 60",
}  # fmt: skip
TABLE = "station_m;width_mm;EI_N_m2\n0,845;25;100\n0,729;116;100\n0;68;440\n-0,729;101;100\n-0,749;101;100\n"
WITH_TABLE = """name = "my slalom"
running_length_mm = 1396
sidecut_length_mm = 1458
mass_kg = 2.231
GJ_N_m2 = [60, 140, 175, 140, 60]
table = "rows.csv"
"""


def type_ski(page: Sheet, name: str, typed: Mapping[str, str]) -> None:
    page.fill("Name of the ski", name)
    for key, text in typed.items():
        page.fill(measured_ski.MEASURED[key], text)


def added(answer: httpx.Response) -> str:
    """The ski that an answer leads to as the one that was added."""
    query = parse_qs(urlsplit(answer.headers["location"]).query)
    assert query["added"] == ["1"]
    return query["ski"][0]


def test_three_widths_become_a_ski_of_the_lab(desk: Desk, confined_words: list[tuple[object, ...]]) -> None:
    page = opened(desk)
    type_ski(page, "  my  ski ", {**TYPED, "camber_mm": ""})
    page.press("Add this ski")
    page.told("/skis?ski=my%20ski&added=1")
    text = saved_place(desk, "my ski").read_text(encoding="utf-8")
    written = tomllib.loads(text)
    assert written.pop("source")
    assert written == {
        "name": "my ski", "length_mm": 1593.0, "running_length_mm": 1396.0, "sidecut_length_mm": 1458.0,
        "tip_width_mm": 116.0, "waist_width_mm": 68.0, "tail_width_mm": 101.0, "mass_kg": 2.231,
        "EI_N_m2": [100.0, 250.0, 440.0, 260.5, 100.0], "GJ_N_m2": [60.0, 140.0, 175.0, 140.0, 60.0],
    }  # fmt: skip
    assert confined_words == [(SKI_BOUNDS, check_ski_texts, text, "")]
    assert not any("Not saved" in line for line in page.outline())


def marked(page: Sheet) -> list[str]:
    """Names of the fields that show a problem."""
    return [each.props.get("aria-label") or each.props["label"] for each in page.of(ui.input) if each.error]


def test_a_field_that_is_missing_is_marked_until_it_is_typed(desk: Desk) -> None:
    page = opened(desk)
    mass, tip = (measured_ski.MEASURED[key] for key in ("mass_kg", "tip_width_mm"))
    type_ski(page, "mine", {**TYPED, "mass_kg": ""})
    page.press("Add this ski")
    page.shows("[status bad] ")
    assert marked(page) == [mass]
    page.told(f'runMethod({page.field(mass).id}, "select"')
    page.fill(mass, "2")
    page.fill(tip, "1x")
    page.press("Add this ski")
    page.until(lambda: marked(page) == [tip])
    assert page.field(mass).value == "2"
    page.fill(tip, "40")
    page.press("Add this ski")
    page.shows("waist_width_mm")
    assert marked(page) == []
    page.fill(tip, "116")
    page.press("Add this ski")
    page.told("/skis?ski=mine&added=1")
    assert not any("status bad" in line for line in page.outline())


def test_files_are_imported_from_the_form(desk: Desk, confined_words: list[tuple[object, ...]]) -> None:
    answer = desk.post("/skis/add", files=files(mine_toml=WITH_TABLE, rows_csv=TABLE), data={"name": ""})
    assert (answer.status_code, added(answer)) == (303, "my slalom")
    ((bounds, work, _, names),) = confined_words
    assert bounds is SKI_BOUNDS
    assert (work, names) == (read_ski_files, ["mine.toml", "rows.csv"])
    assert read_ski(saved_place(desk, "my slalom")).name == "my slalom"
    answer = desk.post("/skis/add", files=files(mine_toml=TEXT), data={"name": " Ski  A/1 "})
    assert answer.status_code == 400
    answer = desk.post("/skis/add", files=files(mine_toml=TEXT), data={"name": " Ski  Ä "})
    assert added(answer) == "Ski Ä"
    assert LabSkis(desk.lab.runs).saved() == ["my slalom", "Ski Ä"]


@pytest.mark.parametrize(
    ("form", "code"),
    [
        ({"files": [("files", ("", b"")), ("other", ("a.toml", b"x"))]}, "no_file"),
        ({"data": {"files": "text"}}, "no_file"),
        ({"files": files(a_toml="a", b_csv="b", c_csv="c", d_csv="d")}, ""),
        ({"files": files(ski_toml=TEXT)}, "already_there"),
        ({"files": files(ski_txt="x")}, "not_one_ski"),
    ],
)
def test_input_that_cannot_be_imported_is_rejected(desk: Desk, form: dict[str, Any], code: str) -> None:
    assert desk.post("/skis/add", **form).status_code == 400
    assert desk.code == code
    assert LabSkis(desk.lab.runs).saved() == []


def folder_of(folder: Path, texts: Mapping[str, str]) -> list[str]:
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    return sorted(texts)


def test_a_file_with_its_table_is_written_again(tmp_path: Path) -> None:
    names = folder_of(tmp_path, {"mine.toml": WITH_TABLE, "rows.csv": TABLE})
    found = read_ski_files(str(tmp_path), names)
    assert found.table.startswith("station_m,")
    assert tomllib.loads(found.text)["table"] == "ski.csv"
    assert texts_of_ski(read_ski(tmp_path / "mine.toml")) == (found.text, found.table)


@pytest.mark.parametrize(
    ("texts", "expected"),
    [
        ({}, "not_one_ski"),
        ({"a.toml": TEXT, "b.toml": TEXT}, "not_one_ski"),
        ({"b.csv": TABLE, "a.csv": TABLE}, "not_one_ski"),
        ({"a.toml": 'shape = "b.json"'}, "unknown_name"),
        ({"a.toml": 'table = "b.csv"'}, "missing_file"),
        ({"a.toml": 'table = "../b.csv"', "b.csv": TABLE}, "missing_file"),
        ({"a.toml": TEXT.replace("mass_kg = 2.246", "mass_kg = -1")}, coded("out_of_range", file="a.toml")),
        ({"a.json": "{}"}, "not_one_ski"),
    ],
)
def test_an_invalid_ski_is_rejected(tmp_path: Path, texts: dict[str, str], expected: str | Coded) -> None:
    names = folder_of(tmp_path, texts)
    with raises(ParameterError, expected):
        read_ski_files(str(tmp_path), names)


def test_uploads_are_named_without_their_folders(confined_words: list[tuple[object, ...]]) -> None:
    uploads = [("Skis\\of mine/mine.toml", io.BytesIO(WITH_TABLE.encode())), ("rows.csv", io.BytesIO(TABLE.encode()))]
    found = ski_of_uploads(uploads, Limits())
    assert found.name == "my slalom"
    ((bounds, _, folder, names),) = confined_words
    assert bounds is SKI_BOUNDS
    assert names == ["mine.toml", "rows.csv"]
    assert not Path(str(folder)).exists()
    with raises(ParameterError, "too_many_files", most=1):
        ski_of_uploads(uploads, Limits(files=1))


@pytest.mark.parametrize("name", ["a", "Ä", "9", "a b-c_d", "x" * 40, "con1", "com", "nothing else", "kž"])
def test_names_that_a_ski_may_have(tmp_path: Path, name: str) -> None:
    skis = LabSkis(tmp_path)
    skis.save_texts(name, *texts_of_ski(replace(CARVER, name=name)))
    assert skis.saved() == [name]


@pytest.mark.parametrize("name", ["", "..", "a/b", "a\\b", "_a", "a-", "x" * 41, "con", "LPT9", "a.b", "a\nb", "雪"])
def test_names_that_a_ski_may_not_have(tmp_path: Path, name: str) -> None:
    with raises(ParameterError, "name_not_allowed"):
        LabSkis(tmp_path).require_new(name)


def test_a_ski_that_was_saved_may_be_read_by_others_of_the_machine(tmp_path: Path) -> None:
    skis = LabSkis(tmp_path / "deep" / "runs")
    skis.save_texts("mine", *texts_of_ski(replace(CARVER, name="mine")))
    folder = tmp_path / "deep" / "runs" / "skis"
    assert (folder / "mine").stat().st_mode & 0o777 == 0o755
    assert sorted(each.name for each in (folder / "mine").iterdir()) == ["ski.csv", "ski.toml"]
    assert [each.name for each in folder.iterdir()] == ["mine"]


def test_what_cannot_be_written_is_an_error_of_ours(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with raises(OutputError, "cannot_write"):
        LabSkis(tmp_path / "file").save_texts("mine", TEXT, "")


def test_the_slower_of_two_saves_is_rejected_and_not_stored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    skis = LabSkis(tmp_path)
    skis.save_texts("one", TEXT, "")
    monkeypatch.setattr(LabSkis, "require_new", lambda *_: None)
    with raises(OutputError, "cannot_write", name="one"):
        skis.save_texts("one", TEXT, "")
    assert [each.name for each in (tmp_path / "skis").iterdir()] == ["one"]


def test_a_text_is_saved_under_its_new_name(tmp_path: Path) -> None:
    skis = LabSkis(tmp_path)
    skis.save_texts("Ä 1", TEXT, "")
    assert skis.texts("Ä 1") == (TEXT.replace('name = "carver"', 'name = "Ä 1"'), "")
    bare = TEXT.replace('name = "carver"\n', "")
    skis.save_texts("two", bare, "")
    assert skis.texts("two")[0] == f'name = "two"\n{bare}'
    twice = "x = 1\nname = \\1\n"
    with pytest.raises(SkisnowError):
        skis.save_texts("four", twice, "")
    within = TEXT.replace('source = """', 'source = """\\\nname = inside\n')
    skis.save_texts("three", within, "")
    assert skis.texts("three")[0] == within.replace('name = "carver"', 'name = "three"')
    inside = TEXT.replace('name = "carver"\n', "").replace('source = """', 'source = """\\\nname = inside\n')
    with raises(ParameterError, "no_place_for_name", line='name = "four"'):
        skis.save_texts("four", f'{inside}name = "carver"\n', "")
    assert skis.saved() == ["three", "two", "Ä 1"]


def test_a_text_is_read_with_its_table_and_its_warnings() -> None:
    named = WITH_TABLE.replace("rows.csv", "ski.csv")
    ski, warned = ski_of_texts(named, TABLE)
    assert (ski.name, warned) == ("my slalom", "")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)  # whatever the process does with them
        _, warned = ski_of_texts(HEAVY, "")
    assert warned.startswith("ski.toml")
    twice = HEAVY.replace("camber_mm = 6", "camber_mm = 40")
    words = ski_of_texts(twice, "")[1]
    assert " ski.toml: " in words and words.count("ski.toml: ") == 2
    with raises(ParameterError, "wrong_kind", file="ski.toml"):
        ski_of_texts(TEXT.replace("length_mm = 1755", 'length_mm = "x"'), "")
    with raises(ParameterError, "not_toml", file="ski.toml"):
        ski_of_texts("[", "")
    with raises(ParameterError, "missing", path="ski.csv"):
        ski_of_texts(named, "x\n")


@pytest.mark.parametrize(
    ("line", "code"), [('shape = "ski.csv"', "unknown_name"), ('table = "other.csv"', "wrong_table")]
)
def test_a_text_that_names_another_file_is_rejected(line: str, code: str) -> None:
    with raises(ParameterError, code):
        ski_of_texts(f"{TEXT}\n{line}\n", "")


ONES = dict.fromkeys(FACTORS, "1")


@pytest.mark.parametrize(
    ("factors", "is_file"),
    [({}, True), (ONES, True), (ONES | {"width_mm": "1,0"}, True), (ONES | {"width_mm": "1.1"}, False)],
)
def test_source_of_a_measured_ski(factors: dict[str, str], *, is_file: bool) -> None:
    asked = SkiEditInput(TEXT, factors=factors)
    assert asked.is_file is is_file
    ski, _ = edit_ski_texts(asked)
    assert ski.name == ("carver" if is_file else "carver, edited")
    assert (ski.source == CARVER.source) is is_file
    assert edit_ski_texts(asked, name="mine")[0].name == "mine"
