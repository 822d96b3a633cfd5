"""A figure in another language: all words and numbers in it, before it is drawn."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final

from matplotlib.text import Text
from matplotlib.ticker import Formatter

from ..._support.language import ENGLISH, catalogue
from ..._support.language.catalogue import FIRST, LAST
from .style import legend_below

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence, Set

    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

_MATHS: Final = re.compile(r"\$[^$]*\$")
_PUT_AWAY: Final = re.compile(rf"{FIRST}(\d+){LAST}")


def translate_figure(figure: Figure, language: str, *, names: Set[str] = frozenset()) -> None:
    """Change the figure itself: titles, labels, legends, notes, and how numbers stand at its axes.

    Parameters
    ----------
    figure
        As it was drawn in English.
    language
        Its code; there is a catalogue of it.
    names
        What users wrote and is no word of ours, as it stands in the figure.
    """
    if language == ENGLISH:
        return
    said = _sayer(language, names)
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            _translate_numbers(axis, said)
    for text in figure.findobj(Text):
        assert isinstance(text, Text)
        if text.get_text():
            text.set_text(said(text.get_text()))
    _lay_out_legends(figure)


def _lay_out_legends(figure: Figure) -> None:
    """Lay out the legends below a figure again: translated entries are longer or shorter."""
    for legend in list(figure.legends):
        handles = [handle for handle in legend.legend_handles if handle is not None]
        for handle, text in zip(handles, legend.get_texts(), strict=True):
            handle.set_label(text.get_text())
        legend.remove()
        legend_below(figure, handles)


def _sayer(language: str, names: Set[str]) -> Callable[[str], str]:
    """What translates one text, of which formulas are places."""
    known = catalogue(language).keeping(names)

    def said(text: str) -> str:
        if text in names:
            return text
        formulas = _MATHS.findall(text)
        numbers = iter(range(len(formulas)))
        plain = _MATHS.sub(lambda _: f"{FIRST}{next(numbers)}{LAST}", text)
        lines = "\n".join(map(known.translated, plain.split("\n")))
        return _PUT_AWAY.sub(lambda found: formulas[int(found[1])], known.with_numbers(lines))

    return said


def _translate_numbers(axis: Axis, said: Callable[[str], str]) -> None:
    if not isinstance(axis.get_major_formatter(), _Said):  # else that of another panel, which they share
        axis.set_major_formatter(_Said(axis.get_major_formatter(), said))
        axis.set_minor_formatter(_Said(axis.get_minor_formatter(), said))


class _Said(Formatter):
    """What another formatter writes at an axis, in the language of the figure."""

    def __init__(self, other: Any, said: Callable[[str], str]) -> None:
        self._other = other
        self._said = said

    def __call__(self, x: float, pos: int | None = None) -> str:
        return self._said(self._other(x, pos))

    def set_axis(self, axis: Any) -> None:
        self._other.set_axis(axis)

    def set_locs(self, locs: Any) -> None:
        self._other.set_locs(locs)

    def format_ticks(self, values: Sequence[float]) -> list[str]:
        return [self._said(each) for each in self._other.format_ticks(values)]

    def get_offset(self) -> str:
        return self._said(self._other.get_offset())
