"""Links to the last series of a campaign, newest first, as they are now."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from nicegui import ui

from ..fields import link
from ..layout import heading
from ..names import entering

if TYPE_CHECKING:
    from .table_view import TableView

MOST: Final = 40


class SeriesList:
    """The list below the form of a series."""

    def __init__(self, view: TableView) -> None:
        self._view = view
        self._place = ui.element("div")
        self._drawn: tuple[str, list[tuple[str, bool]]] = ("", [])

    def show(self, current: str) -> None:
        """Draw the list again if a series or its state is new; ``current``: name of the series in the form."""
        tests = [(test.name, bool(test.cancelled)) for test in self._view.tests()[-MOST:]]
        if self._drawn == (current, tests):
            return
        self._drawn = current, tests
        self._place.clear()
        if not tests:
            return
        with self._place:
            heading("Series so far", 3)
            with ui.element("div").classes("acts so-far"):
                for name, cancelled in reversed(tests):
                    address = entering(self._view.session.id, table=self._view.file, test=name)
                    made = link(f"{name}{' (cancelled)' if cancelled else ''}", address, "small")
                    if name == current:
                        made.props('aria-current="page"')
