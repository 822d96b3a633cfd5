"""Every equation of the pages is shown as it is written: two independent converters see the same parts."""

import re
import runpy
import unicodedata
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from latex2mathml import converter
from markdown_it import MarkdownIt
from markdown_it.token import Token
from math_core import LatexError
from mdit_py_plugins.dollarmath import dollarmath_plugin

DOCS = Path(__file__).resolve().parents[2] / "docs"
mathml: Any = runpy.run_path(str(DOCS / "conf.py"))["mathml"]

PARTS = {"mfrac", "msqrt", "mroot", "msub", "msup", "msubsup", "munder", "mover", "munderover", "mtr"}
BESIDE = {"munder": "msub", "mover": "msup", "munderover": "msubsup"}  # one writes below what the other writes beside
ACCENTS = str.maketrans({"^": "\u02c6", "~": "\u02dc", "\u0303": "\u02dc", "\u0304": "\u00af", "-": "\u2212"})


def equations(tokens: Sequence[Token]) -> Iterator[str]:
    for token in tokens:
        if token.type.startswith("math"):
            yield token.content
        yield from equations(token.children or ())


def parts(markup: str) -> Counter[tuple[str, ...]]:
    """Fractions, roots, scripts with their bases, accents and rows of matrices, each with the text of its parts."""
    found: Counter[tuple[str, ...]] = Counter()
    for element in ET.fromstring(markup.replace("&ApplyFunction;", "")).iter():
        tag = element.tag.split("}")[-1]
        if tag in PARTS:
            children = [element] if tag == "msqrt" else list(element)
            found[BESIDE.get(tag, tag), *map(text_of, children)] += 1
    return found


def text_of(element: ET.Element) -> str:
    plain = unicodedata.normalize("NFKC", "".join(element.itertext()).translate(ACCENTS)).translate(ACCENTS)
    return re.sub(r"\s", "", plain)


def test_both_converters_see_the_same_parts_in_every_equation() -> None:
    pages = sorted(path for path in DOCS.rglob("*.md") if "_build" not in path.parts)
    read = MarkdownIt("commonmark").enable("table").use(dollarmath_plugin)
    written = [(page.name, text) for page in pages for text in equations(read.parse(page.read_text(encoding="utf-8")))]
    assert len(written) > 100
    apart = {}
    for page, text in written:
        shown, other = parts(mathml(text, block=False)), parts(converter.convert(text))
        if shown != other:
            apart[page, text] = (shown - other, other - shown)
    assert apart == {}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (r"\tfrac12 m v^2", {("mfrac", "1", "2"), ("msup", "v", "2")}),
        (r"\tfrac32k_1", {("mfrac", "3", "2"), ("msub", "k", "1")}),
        (r"\dot r_O", {("msup", "r", "\u02d9"), ("msub", "r\u02d9", "O")}),
        (r"x'^2", {("msup", "x", "\u20322")}),
    ],
)
def test_what_was_shown_wrong_is_shown(text: str, expected: set[tuple[str, ...]]) -> None:
    """Worked out by hand: a bare figure is a whole argument, and an accent is part of the base."""
    assert {tuple(map(bare, part)) for part in parts(mathml(text, block=True))} == {
        tuple(map(bare, e)) for e in expected
    }


def bare(text: str) -> str:
    """Accents in one form, however they are put together."""
    return unicodedata.normalize("NFKD", text).replace(" ", "").replace("\u0307", "\u02d9")


def test_a_command_that_nobody_knows_is_refused() -> None:
    with pytest.raises(LatexError, match="tfracc"):
        mathml(r"\tfracc12", block=False)
