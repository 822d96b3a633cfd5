"""Folder of an import, with its template."""

from pathlib import Path

from tests.coded import raises

from skisnow._support.errors import OutputError, ParameterError
from skisnow.campaign import read_campaign
from skisnow.campaign.importing.answers import Answers, read_template
from skisnow.campaign.importing.folder import write_import
from skisnow.campaign.importing.proposal import propose

from .test_import import FILE, bytes_of, everyday, require_right


def test_written_campaign_repeats_the_mapping_and_is_a_template(tmp_path: Path) -> None:
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
    with raises(ParameterError, "cannot_read"):
        read_template(tmp_path / "b")
