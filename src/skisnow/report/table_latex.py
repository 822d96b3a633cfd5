"""A table as LaTeX with booktabs, a long one as longtable; needs booktabs, longtable, textcomp and amssymb."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from . import number_formatting
from .symbols import latex, latex_escaped
from .table import ROWS_IN_LATEX

if TYPE_CHECKING:
    from collections.abc import Callable

    from .table import Column, Kind, Table

ROWS_ON_A_PAGE: Final = 45


def table_latex(table: Table) -> str:
    """The table with caption and label, to be read in by a paper."""
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
    return "% needs \\usepackage{booktabs,longtable,textcomp,amssymb}\n" + "\n".join(lines) + "\n"


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
    return number_formatting.ABSENT["latex"] if value is None else _SET[column.kind](value, column.digits)


def _estimate(value: tuple[float | None, Any], digits: int) -> str:
    number, pair = value
    ends = "" if pair is None else f" {number_formatting.interval(pair, digits, style='latex')}"
    return number_formatting.significant(number, digits, style="latex") + ends


_SET: Final[dict[Kind, Callable[[Any, int], str]]] = {
    "text": lambda value, _: latex_escaped(str(value)),
    "words": lambda value, _: latex(value),
    "codes": lambda value, _: latex_escaped(", ".join(value)),
    "yes": lambda value, _: "yes" if value else "no",
    "tick": lambda value, _: r"$\checkmark$" if value else "",
    "count": lambda value, _: str(value),
    "angle": lambda value, _: f"{value:.6g}",
    "number": lambda value, digits: number_formatting.significant(value, digits, style="latex"),
    "p": lambda value, _: number_formatting.probability(value, style="latex"),
    "interval": lambda value, digits: f"{{{number_formatting.interval(value, digits, style='latex')}}}",
    "range": lambda value, digits: number_formatting.from_to(value, digits, style="latex"),
    "estimate": _estimate,
}
