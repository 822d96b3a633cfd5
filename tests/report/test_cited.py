"""What a page asks to cite is what CITATION.cff says."""

from __future__ import annotations

import re
from pathlib import Path

from skisnow.report.sheet import CITED

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
