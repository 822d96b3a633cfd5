"""Folder of an import: its template, and the undo."""

from pathlib import Path

from tests.coded import raises

from skisnow._support.errors import OutputError, ParameterError
from skisnow.campaign import read_campaign
from skisnow.campaign.importing.answers import Answers, read_template, save_template, saved_templates
from skisnow.campaign.importing.folder import undo_import, write_import
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


def test_a_template_has_a_name(tmp_path: Path) -> None:
    """Saved once, it answers the next file; other answers under its name are an error, as names of other files are."""
    book = everyday()
    book["Hang oben"]["C6"] = None
    answers = Answers.of_options({"unit": ["Last=kg"]})
    campaign = propose(FILE, bytes_of(book), answers).files["campaign.toml"]
    save_template("Gletscher 2026", campaign, folder=tmp_path)
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
