"""Results next to the form, updated with each reading: hardness or stress, flags, the curve."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from nicegui import background_tasks, run, ui

from ..._support.errors import FieldDataError, StoreError
from ...campaign.reading.table_forms import PENETRATION
from ..elements import Words, named
from ..error_pages import error_sentence
from ..line_chart import BEHIND, ChartLine, LineChart
from ..words import displacement_words, hardness_words, in_words, label, stress_words, unloading_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ...report.charts import SeriesCurve
    from ..edit_session import QuickResults, TestKey
    from .table_view import TableView

    _Values: TypeAlias = list[float | None]

MISSING_YET: Final = frozenset({"too_few_loads"})
"""Flags of a series that is still being read."""


class Beside:
    """Follows one test of a site."""

    def __init__(self, view: TableView) -> None:
        self._view = view
        self._wanted: tuple[str, str, frozenset[str]] | None = None
        self._working = False
        is_pressed = view.file == PENETRATION.file
        classes = "beside" if is_pressed else "beside above"
        with named(ui.element("section").classes(classes), "Results of the readings"):
            self._name = Words("").classes("quiet")
            self._value = Words("").classes("value").props("role=status")
            self._marks = ui.element("ul").classes("marks")
            self._chart: LineChart | None = None
            if is_pressed:
                words = "Load against depth of this series and the others of its site, load in N"
                self._chart = LineChart(label("depth_mm"), label("load_N"), words, height=340)

    def follow(self, name: str, site: str, *, in_progress: bool = False) -> None:
        """Show this test; what is computed meanwhile for an older state is dropped.

        Parameters
        ----------
        name, site
            Of the test.
        in_progress
            Whether readings are still to come: what only says that some are missing is not said yet.
        """
        self._wanted = (name, site, MISSING_YET if in_progress else frozenset())
        if not self._working:
            self._working = True
            background_tasks.create(self._work(), name="beside", context=self._name.client)

    async def _work(self) -> None:
        try:
            while self._wanted is not None:
                (name, site, unsaid), self._wanted = self._wanted, None
                try:
                    found = await run.io_bound(self._view.session.quick_results, site)
                except (FieldDataError, StoreError) as error:
                    self._value.set_text(error_sentence(error))
                    continue
                if self._marks.is_deleted:  # the page was left meanwhile
                    return
                # another may have been wanted while this one was waited for
                if self._wanted is None and found is not None:  # type: ignore[redundant-expr]
                    self._show(name, found, unsaid)
        finally:
            self._working = False

    def _show(self, name: str, found: QuickResults, unsaid: frozenset[str]) -> None:
        key = self._view.file, name
        row = found.experiments.get(key)
        self._name.set_text(f"Test {name}" if row else "")
        self._value.set_text(_value(row, pressed=self._view.file == PENETRATION.file))
        self._marks.clear()
        with self._marks:
            for code, sentence in found.flags.get(key, {}).items():
                if code not in unsaid:
                    with ui.element("li"):
                        Words(in_words(sentence))
        if self._chart is not None:
            self._chart.show(list(_lines(key, found.curves)), from_zero="xy")


def _value(row: dict[str, Any] | None, *, pressed: bool) -> str:
    if row is None:
        return ""
    if not pressed:
        return "; ".join(filter(None, (f"S_f = {stress_words(row)}", displacement_words(row))))
    return "; ".join(filter(None, (f"H_V = {hardness_words(row)}", unloading_words(row))))


def _lines(key: TestKey, curves: dict[TestKey, SeriesCurve]) -> Iterator[ChartLine]:
    """Readings and law of a series, over those of all others, which are one thing: a site may have hundreds."""
    others = [curve for other, curve in curves.items() if other != key]
    own = [curves[key]] if key in curves else []
    for chosen, style in ((others, BEHIND), (own, 0)):
        if chosen:
            points = [(curve.depth_mm, curve.load_N) for curve in chosen]
            laws = [((*curve.law_depth_mm, None), (*curve.law_load_N, None)) for curve in chosen]
            yield ChartLine(*_joined(points), style, points=True)
            yield ChartLine(*_joined(laws), style)


def _joined(pairs: Iterable[tuple[Iterable[float | None], Iterable[float | None]]]) -> tuple[_Values, _Values]:
    x, y = zip(*pairs, strict=True)
    return list(chain.from_iterable(x)), list(chain.from_iterable(y))
