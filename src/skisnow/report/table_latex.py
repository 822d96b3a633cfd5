"""Tables of reports as LaTeX that fits a page: numbers and units by siunitx, notes below; see `PACKAGES`."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any, Final

from . import formatting
from .formatting import latex, latex_escaped
from .table import ROWS_IN_LATEX, Column, Kind, Table

PACKAGES: Final = (
    "array", "booktabs", "longtable", "siunitx", "makecell", "adjustbox", "rotating", "pdflscape", "textcomp",
    "amssymb",
)  # fmt: skip
"""LaTeX packages that a document with such tables loads."""
ROWS_ON_A_PAGE: Final = 45
_COLUMNS_UPRIGHT: Final = 6  # a long table with more columns is printed in landscape
_LETTERS_UPRIGHT: Final = 115  # a table with longer lines is rotated by 90° (A4 has about 85 characters in a line)
_LONGEST_TEXT: Final = 30
_TEXT_WIDTH: Final = "45mm"  # width of a column with longer texts, which are wrapped
_ALIGNED: Final = ("number", "count", "angle", "hundredths")
"""Kinds of single numbers, which siunitx aligns at the decimal point."""
_COMMAND: Final = re.compile(r"\\[A-Za-z]+|[{}$]")
_PLAIN: Final = re.compile(r"(-?)(\d+)(?:\.(\d+))?")
_UNITS: Final = str.maketrans({"²": "^2", "³": "^3", "·": ".", " ": ".", "°": r"\degree", "%": r"\percent"})


def table_latex(table: Table) -> str:
    """LaTeX of a table with caption and label."""
    shown = table.rows[:ROWS_IN_LATEX]
    cells = [_column(column, [row[i] for row in shown]) for i, column in enumerate(table.columns)]
    alignment = "".join(_alignment(column, of) for column, of in zip(table.columns, cells, strict=True))
    head = " & ".join(_header(column) for column in table.columns) + r" \\"
    body = [" & ".join(row) + r" \\" for row in zip(*cells, strict=True)]
    caption = rf"\caption{{{latex(table.full_caption)}}}\label{{tab:{table.file_stem}}}"
    if len(shown) > ROWS_ON_A_PAGE:
        lines = _long(alignment, caption, head, body, _notes_latex(table))
        if len(table.columns) > _COLUMNS_UPRIGHT:
            lines = [r"\begin{landscape}", *lines, r"\end{landscape}"]
    else:
        is_wide = sum(map(_width, cells)) > _LETTERS_UPRIGHT
        lines = _on_one_page(alignment, caption, head, body, _notes_latex(table), is_wide=is_wide)
    return f"% needs \\usepackage{{{','.join(PACKAGES)}}}\n" + "\n".join(lines) + "\n"


def _on_one_page(
    alignment: str, caption: str, head: str, body: Sequence[str], notes: str, *, is_wide: bool
) -> list[str]:
    """Lines of a table that is shrunk to the width of the text, or rotated if `is_wide`."""
    form = "sidewaystable" if is_wide else "table"
    below = [rf"\par\smallskip\begin{{minipage}}{{\linewidth}}\footnotesize {notes}\end{{minipage}}"] if notes else []
    return [
        rf"\begin{{{form}}}", r"\centering", caption, r"\begin{adjustbox}{max width=\linewidth}",
        rf"\begin{{tabular}}{{{alignment}}}", r"\toprule", head, r"\midrule", *body, r"\bottomrule",
        r"\end{tabular}", r"\end{adjustbox}", *below, rf"\end{{{form}}}",
    ]  # fmt: skip


def _long(alignment: str, caption: str, head: str, body: Sequence[str], notes: str) -> list[str]:
    """Lines of a table over several pages in small type, with the head on each."""
    below = [rf"\noindent{{\footnotesize {notes}\par}}"] if notes else []
    return [
        r"\begingroup\scriptsize\setlength{\tabcolsep}{3pt}", rf"\begin{{longtable}}{{{alignment}}}", caption + r" \\",
        r"\toprule", head, r"\midrule", r"\endfirsthead", r"\toprule", head, r"\midrule", r"\endhead", r"\bottomrule",
        r"\endfoot", *body, r"\end{longtable}", r"\endgroup", *below,
    ]  # fmt: skip


def _notes_latex(table: Table) -> str:
    sentences = [latex(table.note)] if table.note else []
    if len(table.rows) > ROWS_IN_LATEX:
        sentences.append(f"The first {ROWS_IN_LATEX} of {len(table.rows)} rows; the CSV file holds them all.")
    return " ".join(sentences)


def _header(column: Column) -> str:
    """Header cell: name above unit."""
    if not column.unit:
        return f"{{{latex(column.header)}}}"
    return rf"{{\makecell{{{latex(column.header)} \\ (\unit{{{column.unit.translate(_UNITS)}}})}}}}"


def _column(column: Column, values: Sequence[Any]) -> list[str]:
    """Cells of a column; plain numbers if they are aligned at the decimal point."""
    plain, absent = _plain_numbers(column, values), formatting.ABSENT["latex"]
    if plain is None:
        return [absent if value is None else _SET[column.kind](value, column.digits) for value in values]
    return [f"{{{absent}}}" if text is None else text for text in plain]


def _plain_numbers(column: Column, values: Sequence[Any]) -> list[str | None] | None:
    """Numbers for an S column of siunitx; None if one cell is not a plain number."""
    if column.kind not in _ALIGNED or all(value is None for value in values):
        return None
    texts = [None if value is None else _plain_cell(column, value) for value in values]
    return texts if all(text is None or _PLAIN.fullmatch(text) for text in texts) else None


def _plain_cell(column: Column, value: float) -> str:
    if column.kind == "number":
        return formatting.significant(value, column.digits, style="plain")
    return _SET[column.kind](value, column.digits)


def _alignment(column: Column, cells: Sequence[str]) -> str:
    if not column.numeric:
        is_broken = max(map(_count_letters, cells), default=0) > _LONGEST_TEXT and any(" " in cell for cell in cells)
        return rf">{{\raggedright\arraybackslash}}p{{{_TEXT_WIDTH}}}" if is_broken else "l"
    numbers = [match for cell in cells if (match := _PLAIN.fullmatch(cell))]
    if not numbers or column.kind not in _ALIGNED:
        return "r"
    sign = "-" if any(match[1] for match in numbers) else ""
    whole, places = (max(len(match[group] or "") for match in numbers) for group in (2, 3))
    return f"S[table-format={sign}{whole}{f'.{places}' if places else ''}]"


def _width(cells: Sequence[str]) -> int:
    """Width of a column in characters, including the gap."""
    longest = max(map(_count_letters, cells), default=0)
    return 2 + (min(longest, _LONGEST_TEXT) if any(" " in cell and "num" not in cell for cell in cells) else longest)


def _count_letters(cell: str) -> int:
    return len(_COMMAND.sub("", cell))


def _estimate_latex(value: tuple[float | None, Any], digits: int) -> str:
    number, pair = value
    ends = "" if pair is None else f" {formatting.interval(pair, digits, style='latex')}"
    return formatting.significant(number, digits, style="latex") + ends


_SET: Final[dict[Kind, Callable[[Any, int], str]]] = {
    "text": lambda value, _: latex_escaped(str(value)),
    "words": lambda value, _: latex(value),
    "codes": lambda value, _: latex_escaped(", ".join(value)),
    "yes": lambda value, _: "yes" if value else "no",
    "tick": lambda value, _: r"$\checkmark$" if value else "",
    "count": lambda value, _: str(value),
    "angle": lambda value, _: f"{value:.6g}",
    "hundredths": lambda value, _: f"{value:.2f}",
    "number": lambda value, digits: formatting.significant(value, digits, style="latex"),
    "p": lambda value, _: formatting.probability(value, style="latex"),
    "interval": lambda value, digits: f"{{{formatting.interval(value, digits, style='latex')}}}",
    "range": lambda value, digits: formatting.from_to(value, digits, style="latex"),
    "estimate": _estimate_latex,
}
