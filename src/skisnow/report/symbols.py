"""Symbols and names from users in the formats of a report: HTML, LaTeX, text of figures.

Texts of skisnow contain symbols as ``H_V``, ``S_f``, ``b_0``. Text from users is escaped and not searched for symbols.
"""

from __future__ import annotations

import re
from typing import Any, Final

from markupsafe import Markup

from .._support.messages import LocalFormatter, Message, current_language, translations

SYMBOL: Final = re.compile(r"(?<![\w<>/])([A-Za-zμ])_([A-Za-z0-9])(?![\w_])")
_PERCENT: Final = re.compile(r"(?<=\d) %")
_LATEX_SPECIAL: Final = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "[": "{[}",  # after a line break it would start an option, as would a star
    "*": "{*}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\textquotedbl{}",
    "²": r"\textsuperscript{2}",
    "³": r"\textsuperscript{3}",
    "⁻": r"\textsuperscript{-}",
    "°": r"\textdegree{}",
    "·": r"\textperiodcentered{}",
    "−": "$-$",
    "×": r"$\times$",
    "±": r"$\pm$",
    "≤": r"$\le$",
    "≥": r"$\ge$",
    "ϑ": r"$\vartheta$",
    "α": r"$\alpha$",
    "β": r"$\beta$",
    "γ": r"$\gamma$",
    "κ": r"$\kappa$",
    "μ": r"$\mu$",
    "σ": r"$\sigma$",
    "τ": r"$\tau$",
    "Δ": r"$\Delta$",
    "≈": r"$\approx$",
    "→": r"$\rightarrow$",
    "½": r"\textonehalf{}",
    "ρ": r"$\rho$",
    "δ": r"$\delta$",
    "–": "--",
    "\u202f": r"\,",
    "\n": " ",
    "\r": " ",
} | {letter: rf"\textsubscript{{{digit}}}" for digit, letter in enumerate("₀₁₂₃₄₅₆₇₈₉")}


def prose(template: str, **values: Any) -> Markup:
    """HTML of a template in the current language: symbols become markup, values are escaped unless they are Markup.

    >>> str(prose("H_V at {site}", site="a_b <i>"))
    '<i>H</i><sub>V</sub> at a_b &lt;i&gt;'
    """
    language = current_language()
    text = translations(language).gettext(template)
    return Markup(_HtmlFormatter(language).vformat(html(text), (), values))


class _HtmlFormatter(LocalFormatter):
    """Formatter of a language that escapes all values but Markup."""

    def format_field(self, value: Any, format_spec: str) -> str:
        return value if isinstance(value, Markup) else Markup.escape(super().format_field(value, format_spec))


def html(text: str) -> Markup:
    """HTML of a text of skisnow in the current language, with markup for its symbols."""
    tied = _PERCENT.sub("\u00a0%", str(text))
    return Markup(SYMBOL.sub(r"<i>\1</i><sub>\2</sub>", str(Markup.escape(tied))))


def latex(text: str) -> str:
    r"""LaTeX of a text of skisnow, with markup for its symbols.

    >>> latex("S_f in N/mm²")
    '$S_\\mathrm{f}$ in N/mm\\textsuperscript{2}'
    """
    pieces, end = [], 0
    for symbol in SYMBOL.finditer(text):
        pieces += [latex_escaped(text[end : symbol.start()]), rf"${symbol[1]}_\mathrm{{{symbol[2]}}}$"]
        end = symbol.end()
    return "".join([*pieces, latex_escaped(text[end:])])


def latex_escaped(text: str) -> str:
    r"""LaTeX of a text from a user.

    >>> latex_escaped("a & b_c 100%")
    'a \\& b\\_c 100\\%'
    """
    return "".join(
        _LATEX_SPECIAL.get(letter, letter) for letter in text if letter.isprintable() or letter in "\n\r\u202f"
    )


def figure_text(text: str, *, longest: int = 28) -> str:
    """Text from a user for a figure: one line without mathtext, at most `longest` characters.

    A long text is shortened in the middle, because similar names mostly differ at their ends. A leading underscore
    would hide a legend's entry, so a thin space precedes it.
    """
    line = " ".join("".join(letter if letter.isprintable() else " " for letter in text).split())
    line = line or str(Message("(no name)"))
    head = longest // 2
    short = line if len(line) <= longest else f"{line[:head].rstrip()}…{line[head + 1 - longest :].lstrip()}"
    escaped = short.replace("$", r"\$")
    return f" {escaped}" if escaped.startswith("_") else escaped
