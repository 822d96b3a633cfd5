"""LaTeX: special letters are escaped, numbers are set, braces balance."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from skisnow.report.symbols import latex_escaped
from skisnow.report.table import Column, Table
from skisnow.report.table_latex import PACKAGES, table_latex

from .conftest import Reported

SPECIAL = "& % $ # _ { } ~ ^ \\ [ * < >"


def test_special_letters_never_reach_latex_bare() -> None:
    r"""After \command{} and escaped letters are taken away, none of the ten special ones is left."""
    text = latex_escaped(SPECIAL)
    bare = re.sub(r"\\text[a-z]+\{\}|\\[&%$#_{}]|\{\[\}|\{\*\}", "", text)
    assert not set(bare) & set("&%$#_{}~^\\[*<>")


def _table(rows: list[tuple[object, ...]], synthetic: bool = False) -> str:
    columns = (Column("site", "Site", "text"), Column("H", "H_V", "estimate", "N/mm³"), Column("p", "p", "p"))
    return table_latex(Table("test", "Values of H_V in 5 %.", columns, rows, synthetic=synthetic))


def test_a_row_has_its_cells_between_ampersands() -> None:
    text = _table([("a & b", (-2.0e-7, (0.001, 20.0)), 0.0001)])
    assert r"a \& b & \num{-2.00e-7} [\num{0.00100}, \num{20.0}] & $<$ 0.001 \\" in text
    assert r"{Site} & {\makecell{$H_\mathrm{V}$" in text
    assert r"\begin{tabular}{lrr}" in text
    assert all(rule in text for rule in (r"\toprule", r"\midrule", r"\bottomrule"))


def test_a_long_table_breaks_over_pages() -> None:
    text = _table([("a", (None, None), None)] * 60)
    assert r"\begin{longtable}{lrr}" in text
    assert text.count(r"a & -- & -- \\") == 60


def test_a_table_beyond_measure_is_cut_and_says_so() -> None:
    text = _table([("a", (1.0, None), None)] * 2001)
    assert text.count(r"a & \num{1.00} & -- \\") == 2000
    assert "2000 of 2001" in text


def numbers(values: list[float | None], kind: Any = "number") -> str:
    column = Column("x", "x", kind, "kg/m³")
    return table_latex(Table("test", "Values.", (Column("site", "Site", "text"), column), [("a", x) for x in values]))


def test_numbers_stand_below_each_other_by_their_points() -> None:
    text = numbers([-0.5, 12.25, None])
    assert "table-format=-2.3" in text  # -0.500, 12.2: three places at most, two before
    assert r"a & -0.500 \\" in text
    assert r"a & 12.2 \\" in text
    assert r"a & {--} \\" in text  # in braces it is not a number to siunitx
    assert "table-format=4" in numbers([3, 1652], "count")
    assert r"\begin{tabular}{lr}" in numbers([1.0, 2.0e-7])  # a power of ten stays as it is


def test_notes_stand_below() -> None:
    text = table_latex(Table("test", "Values.", (Column("a", "A"),), [(1.0,)], note="Said of H_V."))
    assert text.index(r"\end{tabular}") < text.index(r"Said of $H_\mathrm{V}$.") < text.index(r"\end{table}")
    assert text.index(r"\caption") < text.index(r"\begin{tabular}")


def test_a_wide_table_lies_across_the_page_and_long_texts_are_broken() -> None:
    columns = tuple(Column(f"c{i}", f"C{i}", "text") for i in range(6))
    text = table_latex(Table("test", "Values.", columns, [("one word after the other, and " * 2,) * 6]))
    assert r"\begin{sidewaystable}" in text
    assert text.count("p{45mm}") == 6
    assert "sideways" not in numbers([1.0])


@pytest.mark.slow
def test_every_table_prints_within_its_page(reference: Reported, tmp_path: Path) -> None:
    """With LaTeX of Debian: no error, no line that is too wide, every caption there."""
    program = shutil.which("pdflatex")
    finder = shutil.which("kpsewhich")
    if program is None or finder is None:
        pytest.skip("there is no LaTeX here (Debian: texlive-latex-extra and texlive-science)")
    for package in PACKAGES:
        if subprocess.run([finder, f"{package}.sty"], capture_output=True, check=False).returncode:
            pytest.skip(f"LaTeX has no {package} here (Debian: texlive-latex-extra and texlive-science)")
    places = sorted((reference.folder / "tables").glob("*.tex"))
    read_in = "\n".join(rf"\input{{{place}}}\clearpage" for place in places)
    paper = tmp_path / "paper.tex"
    paper.write_text(
        "\\documentclass[a4paper,11pt]{article}\n\\usepackage[T1]{fontenc}\n\\usepackage[margin=25mm]{geometry}\n"
        f"\\usepackage{{{','.join(PACKAGES)}}}\n\\begin{{document}}\n{read_in}\n\\end{{document}}\n",
        encoding="utf-8",
    )
    for _ in range(2):  # the second time with the widths of long tables
        done = subprocess.run(
            [program, "-interaction=nonstopmode", "-halt-on-error", paper.name],
            cwd=tmp_path, capture_output=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stdout.decode("utf-8", "replace")[-2000:]
    log = (tmp_path / "paper.log").read_text(encoding="utf-8", errors="replace")
    assert "Overfull \\hbox" not in log
    assert len(places) > 15
    labels = (tmp_path / "paper.aux").read_text(encoding="utf-8", errors="replace")
    assert labels.count(r"\newlabel{tab:") >= len(places)


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
