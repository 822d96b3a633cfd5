"""Symbols are set in our own words only; users' names stay what they are."""

from __future__ import annotations

import io
from xml.etree import ElementTree

import matplotlib
import pytest
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from skisnow.report.symbols import figure_text, html, prose


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
