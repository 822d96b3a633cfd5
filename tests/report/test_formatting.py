"""Numbers, symbols and citations as they are printed."""

from __future__ import annotations

import io
import re
from pathlib import Path
from xml.etree import ElementTree

import matplotlib
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from skisnow.report.formatting import figure_text, html, p_equals, prose, significant, whole
from skisnow.report.sheet import CITED, bibtex


@pytest.mark.parametrize(
    ("value", "digits", "expected"),
    [
        (0.21, 3, "0.210"),
        (56.14, 3, "56.1"),
        (56.14, 4, "56.14"),
        (1652.0, 3, "1652"),
        (999.96, 4, "1000"),
        (0.0009996, 3, "0.00100"),
        (-0.0123, 3, "−0.0123"),
        (0.0, 3, "0"),
        (1.234e-5, 3, "1.23×10⁻⁵"),
        (-1.5e9, 2, "−1.5×10⁹"),
        (None, 3, "–"),
    ],
)
def test_significant(value: float | None, digits: int, expected: str) -> None:
    assert significant(value, digits) == expected


@given(value=st.floats(-1e12, 1e12, allow_nan=False), digits=st.integers(2, 6))
def test_printed_is_the_value_to_its_digits(value: float, digits: int) -> None:
    """Half a unit of the last digit, for any magnitude."""
    printed = float(significant(value, digits, style="plain"))
    assert abs(printed - value) <= 0.5000001 * 10.0 ** (1 - digits) * abs(value) * 10.0


def test_p_values() -> None:
    assert p_equals(0.00012, style="plain") == "p < 0.001"
    assert p_equals(0.0503, style="plain") == "p = 0.050"
    assert p_equals(0.52) == "p\u00a0=\u00a00.52"


def test_counts_are_grouped_from_five_digits() -> None:
    assert (whole(1652), whole(143000)) == ("1652", "143\u202f000")


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


def test_symbols_of_a_template_are_set_and_values_escaped() -> None:
    text = prose("S_f at {site}: 5 %", site="S_f <b> 5 %")
    assert text == "<i>S</i><sub>f</sub> at S_f &lt;b&gt; 5 %: 5\u00a0%"


def test_words_with_underscores_are_no_symbols() -> None:
    assert html("beyond_tool, a_bc") == "beyond_tool, a_bc"


@pytest.mark.parametrize("name", ["$x$", "a$b", "_hidden", "50 % \\alpha", "a & b", "$$"])
def test_a_name_is_drawn_as_it_is(name: str) -> None:
    """No mathtext, and a leading underscore does not hide the entry of a legend."""
    figure = Figure()
    handle = Line2D([], [], label=figure_text(name))
    with matplotlib.rc_context({"svg.fonttype": "none"}):
        figure.legend(handles=[handle])
        drawn = io.StringIO()
        figure.savefig(drawn, format="svg")
    texts = ElementTree.fromstring(drawn.getvalue()).iter("{http://www.w3.org/2000/svg}text")
    assert [(element.text or "").strip() for element in texts] == [name]


def test_long_and_broken_names_are_one_short_line() -> None:
    assert figure_text("a\n b\x00c") == "a b c"
    assert len(figure_text("x" * 100)) == 28
    assert figure_text("  ") == "(no name)"


def test_long_names_that_differ_at_their_end_differ_in_a_figure() -> None:
    stiff, soft = (figure_text(f"Giant slalom 193 cm, 2026 prototype, {word}") for word in ("stiff", "soft"))
    assert stiff != soft
    assert (stiff[-5:], soft[-4:]) == ("stiff", "soft")
    assert figure_text("abcdefgh", longest=8) == "abcdefgh"
    assert figure_text("abcdefghi", longest=8) == "abcd…ghi"
