"""LaTeX: special letters are escaped, numbers are set, braces balance."""

from __future__ import annotations

import re

import pytest

from skisnow.report.symbols import latex_escaped
from skisnow.report.table import Column, Table
from skisnow.report.table_latex import table_latex

from .conftest import Reported

SPECIAL = "& % $ # _ { } ~ ^ \\ [ * < >"


def test_special_letters_never_reach_latex_bare() -> None:
    r"""After \command{} and escaped letters are taken away, none of the ten special ones is left."""
    text = latex_escaped(SPECIAL)
    bare = re.sub(r"\\text[a-z]+\{\}|\\[&%$#_{}]|\{\[\}|\{\*\}", "", text)
    assert not set(bare) & set("&%$#_{}~^\\[*<>")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a & b_c", r"a \& b\_c"),
        ("100 %", r"100 \%"),
        ("\\x", r"\textbackslash{}x"),
        ("a\nb", "a b"),
        ("Mössner", "Mössner"),
    ],
)
def test_escapes(text: str, expected: str) -> None:
    assert latex_escaped(text) == expected


def _table(rows: list[tuple[object, ...]], synthetic: bool = False) -> str:
    columns = (Column("site", "Site", "text"), Column("H", "H_V", "estimate", "N/mm³"), Column("p", "p", "p"))
    return table_latex(Table("test", "Values of H_V in 5 %.", columns, rows, synthetic=synthetic))


def test_a_row_has_its_cells_between_ampersands() -> None:
    text = _table([("a & b", (-2.0e-7, (0.001, 20.0)), 0.0001)])
    assert r"a \& b & $-2.00\times10^{-7}$ [0.00100, 20.0] & $<$ 0.001 \\" in text
    assert r"Site & $H_\mathrm{V}$ (N/mm\textsuperscript{3}) & p \\" in text
    assert r"\begin{tabular}{lrr}" in text
    assert all(rule in text for rule in (r"\toprule", r"\midrule", r"\bottomrule"))


def test_a_long_table_breaks_over_pages() -> None:
    text = _table([("a", (None, None), None)] * 60)
    assert r"\begin{longtable}{lrr}" in text
    assert text.count(r"a & -- & -- \\") == 60


def test_a_table_beyond_measure_is_cut_and_says_so() -> None:
    text = _table([("a", (1.0, None), None)] * 2001)
    assert text.count(r"a & 1.00 & -- \\") == 2000
    assert "The first 2000 of 2001 rows" in text


def test_synthetic_stands_in_the_caption() -> None:
    assert "Synthetic data." in _table([], synthetic=True)
    assert "ynthetic" not in _table([])


def test_braces_and_environments_balance_in_every_table(reference: Reported) -> None:
    for path in (reference.folder / "tables").glob("*.tex"):
        text = path.read_text(encoding="utf-8")
        plain = re.sub(r"\\[{}]", "", text)
        assert plain.count("{") == plain.count("}")
        begun = re.findall(r"\\begin\{(\w+)\}", text)
        assert sorted(begun) == sorted(re.findall(r"\\end\{(\w+)\}", text))
        widths = {
            len(re.split(r"(?<!\\)&", line)) for line in text.splitlines() if line.endswith(r" \\") and "&" in line
        }
        assert len(widths) == 1
