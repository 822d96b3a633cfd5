"""A table as LaTeX with booktabs; a long one as longtable. Needs the packages booktabs, longtable and textcomp."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import numerals
from .symbols import latex, latex_escaped
from .table import ROWS_IN_LATEX

if TYPE_CHECKING:
    from .table import Column, Table

ROWS_ON_A_PAGE = 45


def table_latex(table: Table) -> str:
    """The table with caption and label, to be read in by a paper (``\\input``)."""
    shown = table.rows[:ROWS_IN_LATEX]
    alignment = "".join("r" if column.numeric else "l" for column in table.columns)
    head = " & ".join(_header(column) for column in table.columns) + r" \\"
    body = [" & ".join(_cell(*pair) for pair in zip(table.columns, row, strict=True)) + r" \\" for row in shown]
    caption = rf"\caption{{{_caption(table)}}}\label{{tab:{table.file_stem}}}"
    if len(shown) > ROWS_ON_A_PAGE:
        lines = [rf"\begin{{longtable}}{{{alignment}}}", caption + r" \\", r"\toprule", head, r"\midrule"]
        lines += [r"\endfirsthead", r"\toprule", head, r"\midrule", r"\endhead", r"\bottomrule", r"\endfoot", *body]
        lines += [r"\end{longtable}"]
    else:
        lines = [r"\begin{table}", r"\centering", caption, rf"\begin{{tabular}}{{{alignment}}}", r"\toprule", head]
        lines += [r"\midrule", *body, r"\bottomrule", r"\end{tabular}", r"\end{table}"]
    return "% needs \\usepackage{booktabs,longtable,textcomp}\n" + "\n".join(lines) + "\n"


def _caption(table: Table) -> str:
    sentences = [latex(table.full_caption)]
    if table.note:
        sentences.append(latex(table.note))
    if len(table.rows) > ROWS_IN_LATEX:
        sentences.append(f"The first {ROWS_IN_LATEX} of {len(table.rows)} rows; the CSV file holds them all.")
    return " ".join(sentences)


def _header(column: Column) -> str:
    return latex(column.header) + (f" ({latex(column.unit)})" if column.unit else "")


def _cell(column: Column, value: Any) -> str:
    if value is None:
        return numerals.ABSENT["latex"]
    match column.kind:
        case "words":
            return latex(value)
        case "codes":
            return latex_escaped(", ".join(value))
        case "yes":
            return "yes" if value else "no"
        case "count":
            return str(value)
        case "number":
            return numerals.significant(value, column.digits, style="latex")
        case "p":
            return numerals.probability(value, style="latex")
        case "interval":
            return f"{{{numerals.interval(value, column.digits, style='latex')}}}"
        case "estimate":
            number = numerals.significant(value[0], column.digits, style="latex")
            return number if value[1] is None else f"{number} {numerals.interval(value[1], column.digits, style='latex')}"
    return latex_escaped(str(value))
