"""Translation of a figure: all words and numbers in it, before it is drawn."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final

from matplotlib.text import Text
from matplotlib.ticker import Formatter

from ..._support.language import ENGLISH, catalogue
from ..._support.language.catalogues import FIRST, LAST
from .style import legend_below

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence, Set

    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

_MATHS: Final = re.compile(r"\$[^$]*\$")
_PLACEHOLDER: Final = re.compile(rf"{FIRST}(\d+){LAST}")


def translate_figure(figure: Figure, language: str, *, names: Set[str] = frozenset()) -> None:
    """Translate titles, labels, legends, notes and numbers at the axes of the figure itself.

    Parameters
    ----------
    figure
        Figure in English.
    language
        Code of a language with a catalogue.
    names
        Texts of users, as in the figure; they are not translated.
    """
    if language == ENGLISH:
        return
    translate = _translator(language, names)
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            _translate_numbers(axis, translate)
    for text in figure.findobj(Text):
        assert isinstance(text, Text)
        if text.get_text():
            text.set_text(translate(text.get_text()))
    _lay_out_legends(figure)


def _lay_out_legends(figure: Figure) -> None:
    """Lay out the legends below a figure again: translated entries are longer or shorter."""
    for legend in list(figure.legends):
        handles = [handle for handle in legend.legend_handles if handle is not None]
        for handle, text in zip(handles, legend.get_texts(), strict=True):
            handle.set_label(text.get_text())
        legend.remove()
        legend_below(figure, handles)


def _translator(language: str, names: Set[str]) -> Callable[[str], str]:
    """Function that translates a text and keeps its formulas."""
    texts = catalogue(language).keeping(names)

    def translate(text: str) -> str:
        if text in names:
            return text
        formulas = _MATHS.findall(text)
        numbers = iter(range(len(formulas)))
        plain = _MATHS.sub(lambda _: f"{FIRST}{next(numbers)}{LAST}", text)
        lines = "\n".join(map(texts.translated, plain.split("\n")))
        return _PLACEHOLDER.sub(lambda number: formulas[int(number[1])], texts.with_numbers(lines))

    return translate


def _translate_numbers(axis: Axis, translate: Callable[[str], str]) -> None:
    if not isinstance(
        axis.get_major_formatter(), _TranslatedFormatter
    ):  # otherwise translated with another panel that shares the axis
        axis.set_major_formatter(_TranslatedFormatter(axis.get_major_formatter(), translate))
        axis.set_minor_formatter(_TranslatedFormatter(axis.get_minor_formatter(), translate))


class _TranslatedFormatter(Formatter):
    """Formatter that translates the texts of another formatter."""

    def __init__(self, other: Any, translate: Callable[[str], str]) -> None:
        self._other = other
        self._translate = translate

    def __call__(self, x: float, pos: int | None = None) -> str:
        return self._translate(self._other(x, pos))

    def set_axis(self, axis: Any) -> None:
        self._other.set_axis(axis)

    def set_locs(self, locs: Any) -> None:
        self._other.set_locs(locs)

    def format_ticks(self, values: Sequence[float]) -> list[str]:
        return [self._translate(text) for text in self._other.format_ticks(values)]

    def get_offset(self) -> str:
        return self._translate(self._other.get_offset())
