"""Pages ask to cite the entry of CITATION.cff."""

from __future__ import annotations

import re
from pathlib import Path

from skisnow.report.citation import CITED, bibtex

CITATION = (Path(__file__).resolve().parents[2] / "CITATION.cff").read_text(encoding="utf-8")


def test_program_and_papers_are_those_of_the_citation_file() -> None:
    plain = " ".join(CITATION.split())
    for name in re.findall(r"family-names: ([^,]+),", CITATION):
        assert name in CITED
    for title in re.findall(r"title: (?:>- )?(.+?) authors:", plain)[1:]:
        assert title in CITED
    for journal in re.findall(r"journal: (.+)", CITATION):
        assert journal in CITED
    assert "doi 10.1111/sms.12035" in CITED
    assert "doi: 10.1111/sms.12035" in CITATION
    assert "skisnow developers" in CITATION


def test_bibtex_has_the_same_and_the_campaign_with_its_files() -> None:
    text = bibtex({"name": "Slope & a_b", "place": "", "observers": ["Ada", "Bo"], "files": {"shear.csv": "ab12"}})
    for name in re.findall(r"family-names: ([^,]+),", CITATION):
        assert name in text
    assert "10.1111/sms.12035" in text
    assert r"title = {Slope \& a\_b}" in text
    assert "author = {{Ada} and {Bo}}" in text
    assert "shear.csv SHA-256 ab12" in text
    assert text.count("{") == text.count("}")
    assert bibtex().count("@") == 3
