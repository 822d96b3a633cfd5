"""What stands beside the form and follows each reading: hardness or stress, marks in words, the curve."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from nicegui import background_tasks, run, ui

from ...errors import FieldDataError
from ..charts import axis, chart
from ..trouble import told
from ..words import hardness_words, label, stress_words

if TYPE_CHECKING:
    from ...report.curves import SeriesCurve
    from ..desk import AtOnce
    from .sheet import Sheet

OWN: Final = "#0b4f8a"
OTHERS: Final = "#8b96a1"


class Beside:
    """Follows one test of a site."""

    def __init__(self, sheet: Sheet) -> None:
        self._sheet = sheet
        self._wanted: tuple[str, str] | None = None
        self._working = False
        with ui.element("section").classes("beside").props('aria-label="What the readings say"'):
            self._name = ui.label("").classes("quiet")
            self._value = ui.label("").classes("value").props("role=status")
            self._marks = ui.element("ul").classes("marks")
            self._plot: ui.plotly | None = None
            if sheet.file == "penetration.csv":
                words = "Load against depth: this series and the others of its site"
                self._plot = ui.plotly(_figure(None, {})).props(f'role=img aria-label="{words}"').classes("plot")

    def follow(self, name: str, site: str) -> None:
        """Show this test; what is computed meanwhile for an older state is dropped."""
        self._wanted = (name, site)
        if not self._working:
            self._working = True
            background_tasks.create(self._work(), name="beside")

    async def _work(self) -> None:
        try:
            while self._wanted is not None:
                (name, site), self._wanted = self._wanted, None
                try:
                    found = await run.io_bound(self._sheet.desk.at_once, site)
                except FieldDataError as error:
                    self._value.set_text(told(error))
                    continue
                if self._wanted is None and found is not None:
                    self._show(name, found)
        finally:
            self._working = False

    def _show(self, name: str, found: AtOnce) -> None:
        pressed = self._sheet.file == "penetration.csv"
        row = (found.penetration if pressed else found.shear).get(name)
        self._name.set_text(f"Test {name}" if row else "")
        self._value.set_text(_value(row, pressed=pressed))
        self._marks.clear()
        with self._marks:
            for sentence in found.marks.get(f"{self._sheet.file}/{name}", ()):
                with ui.element("li"):
                    ui.label(sentence)
        if self._plot is not None:
            self._plot.update_figure(_figure(name, found.curves))


def _value(row: dict[str, Any] | None, *, pressed: bool) -> str:
    if row is None:
        return ""
    return f"H_V = {hardness_words(row)}" if pressed else f"S_f = {stress_words(row)}"


def _figure(name: str | None, curves: dict[str, SeriesCurve]) -> dict[str, Any]:
    # one trace for all the others: a site may have hundreds
    others = [curve for other, curve in curves.items() if other != name]
    traces = _traces(others, OTHERS, size=6, width=1) if others else []
    if name in curves:
        traces += _traces([curves[name]], OWN, size=11, width=3)
    x, y = (axis(label(column), rangemode="tozero") for column in ("depth_mm", "load_N"))
    return chart(traces, x, y, height=340)


def _traces(curves: list[SeriesCurve], colour: str, *, size: int, width: int) -> list[dict[str, Any]]:
    """Readings as points and laws as lines, broken between one series and the next."""
    points = {
        "x": [depth for curve in curves for depth in curve.depth_mm],
        "y": [load for curve in curves for load in curve.load_N],
    }
    lines = {
        "x": [depth for curve in curves for depth in (*curve.law_depth_mm, None)],
        "y": [load for curve in curves for load in (*curve.law_load_N, None)],
    }
    marker, line = {"color": colour, "size": size}, {"color": colour, "width": width}
    return [
        {"type": "scatter", "mode": "markers", "marker": marker, "hoverinfo": "x+y", **points},
        {"type": "scatter", "mode": "lines", "line": line, "hoverinfo": "skip", **lines},
    ]
