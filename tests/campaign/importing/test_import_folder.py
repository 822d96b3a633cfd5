"""Folder of an import: its template, and the undo."""

from pathlib import Path

from tests.coded import raises

from skisnow._support.errors import OutputError, ParameterError
from skisnow.campaign import read_campaign
from skisnow.campaign.importing.answers import Answers, read_template, save_template, saved_templates
from skisnow.campaign.importing.folder import ToolText, parse_plate, parse_tool, undo_import, write_import
from skisnow.campaign.importing.proposal import propose

from .layouts import FILE, bytes_of, everyday, require_right


def test_written_campaign_repeats_the_mapping_and_is_undone(tmp_path: Path) -> None:
    book = everyday()
    book["Hang oben"]["C6"] = None
    data = bytes_of(book)
    write_import(propose(FILE, data, Answers(unit={"Last": "kg"})).files, tmp_path / "a")
    assert not [problem for problem in read_campaign(tmp_path / "a").problems if problem.needs_action]
    assert (tmp_path / "a/original" / FILE).read_bytes() == data
    template = read_template(tmp_path / "a")
    require_right(propose(FILE, data, template))
    book["Hang oben"]["C6"] = "N"
    assert "other_unit" in {problem.code for problem in propose(FILE, bytes_of(book), template).problems}
    with raises(OutputError, "not_empty"):
        write_import({}, tmp_path / "a")
    undo_import(tmp_path / "a")
    assert not (tmp_path / "a").exists()


def test_changed_files_are_not_undone(tmp_path: Path) -> None:
    write_import(propose(FILE, bytes_of(everyday())).files, tmp_path / "a")
    (tmp_path / "a/shear.csv").write_text("changed")
    with raises(OutputError, "changed_since", files=["shear.csv"]):
        undo_import(tmp_path / "a")
    assert (tmp_path / "a/penetration.csv").exists()


def test_tools_in_words() -> None:
    for text, keys in (
        ("cylinder r 5 x 80 cm", (("shape", '"cylinder"'), ("radius_mm", "50"), ("width_mm", "800"))),
        ("disc 1,5 cm", (("shape", '"disc"'), ("diameter_mm", "15"))),
        ("ski 200 mm x 6,2 cm", (("shape", '"ski"'), ("length_mm", "200"), ("width_mm", "62"))),
    ):
        assert [parse_tool(name, f" {text} ") for name in ("", "a")] == [ToolText(text, keys), ToolText("a", keys)]
    assert parse_plate("", " 10 cm ") == ToolText("10 cm", (("length_mm", "100"),))


def test_a_template_has_a_name(tmp_path: Path) -> None:
    """Saved once, it answers the next file; other answers under its name are an error, as names of other files are."""
    book = everyday()
    book["Hang oben"]["C6"] = None
    answers = Answers.of_options({"unit": ["Last=kg"]})
    campaign = propose(FILE, bytes_of(book), answers).files["campaign.toml"]
    assert save_template("Gletscher 2026", campaign, folder=tmp_path) == tmp_path / "Gletscher 2026.toml"
    save_template("Gletscher 2026", campaign, folder=tmp_path)
    assert list(saved_templates(tmp_path)) == ["Gletscher 2026"]
    require_right(propose(FILE, bytes_of(book), read_template("Gletscher 2026", named=tmp_path)))
    other = propose(FILE, bytes_of(book), answers.with_("column", "Bemerkung", "-")).files["campaign.toml"]
    with raises(ParameterError, "name_in_use", name="Gletscher 2026"):
        save_template("Gletscher 2026", other, folder=tmp_path)
    for name in ("../other", "", ".hidden", "a/b", "a" * 61):
        with raises(ParameterError, "bad_name", name=name):
            save_template(name, campaign, folder=tmp_path)
    with raises(ParameterError, "no_template", name="Gletscher", saved=["Gletscher 2026"]):
        read_template("Gletscher", named=tmp_path)


def test_options_and_their_errors() -> None:
    options = {"unit": ["a=b=kg"], "tool": ["disc 50 mm", " A = ski 20 x 6 cm "], "ignore": ["Hang!5"], "column": None}
    answers = Answers.of_options(options)  # type: ignore[arg-type]
    assert answers == Answers(
        unit={"a=b": "kg"}, tool={"": "disc 50 mm", "A": "ski 20 x 6 cm"}, ignore={"Hang!5": "yes"}
    )
    assert answers.updated(Answers(unit={"a=b": "N", "c": "mm"})).unit == {"a=b": "N", "c": "mm"}
    headings = Answers(column={"Last": "load_N", "shear.LAST": "moment_Nm"})
    assert [headings.of_heading("column", table, "last") for table in ("shear", "density")] == ["moment_Nm", "load_N"]
    assert headings.of_heading("column", "shear", "Tiefe") == ""
    with raises(ParameterError, "no_pair", option="unit", text="kg"):
        Answers.of_options({"unit": ["kg"]})


def test_folders_without_an_import_and_templates_without_answers(tmp_path: Path) -> None:
    (tmp_path / "a" / "original").mkdir(parents=True)
    (tmp_path / "outside").write_text("mine")
    for record in (None, "{}x", "[]", '{"../outside": ""}'):
        if record is not None:
            (tmp_path / "a" / "original" / "import.json").write_text(record)
        with raises(OutputError, "no_import"):
            undo_import(tmp_path / "a")
    assert (tmp_path / "outside").read_text() == "mine"
    with raises(OutputError, "not_empty"):
        write_import({}, tmp_path / "outside")
    for text in ("name = 'x'", "import = 3", "[import]\nunit = 'kg'", "[import.unit]\nLast = 3"):
        (tmp_path / "campaign.toml").write_text(text)
        with raises(ParameterError, "no_template"):
            read_template(tmp_path)


def test_a_line_of_a_wrong_cell_is_that_of_the_imported_file() -> None:
    head = "Skistück 200 x 62 mm\nOrt: oben\n\nVersuch;Kantwinkel;Last;Tiefe\n;°;kg;mm\n1;30;50;1,41\n"
    (problem,) = propose("Hang.csv", f"{head}1;30;60;-2\n".encode()).problems
    assert (problem.code, problem.file, problem.row, problem.column) == (
        "out_of_range", "Hang.csv, sheet Hang", 7, "depth_mm",
    )  # fmt: skip
    assert problem.action.endswith("--ignore Hang!7.")
    wrong = [
        ({"table": {"Hang:4": "penetration"}, "column": {"Last": "lod"}}, "bad_answer", "Last"),
        ({"tool": {"": "x"}}, "bad_answer", "tool"),
    ]
    for answers, code, column in wrong:
        found = propose("Hang.csv", head.encode(), Answers(**answers)).problems
        assert (code, "Hang:4", column) in [(each.code, each.file, each.column) for each in found]
