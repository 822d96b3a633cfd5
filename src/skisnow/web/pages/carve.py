"""Page of a carved turn: sliders for edge angle, load and snow, and the ski in the snow."""

from __future__ import annotations

from typing import Final

from nicegui import ui

from ..._support.messages import Message
from ..carved_turn import NUMBERS, RATIOS, SLIDERS, CarvedTurn, CarveInputs, Solver
from ..elements import choice, link, page_frame
from ..lab_skis import NOTHING, LabSkis
from ..scenario_fields import SnowChoice
from ..settings import Lab

PATH: Final = "/carve"
TITLE: Final = Message("Carve")
SKIS: Final = "/skis"


def add_page(lab: Lab) -> None:
    """Add the page to the application."""
    solver, skis = Solver(), LabSkis(lab.runs)

    @ui.page(PATH)
    async def carve(ski: str = "", other: str = "") -> None:
        with page_frame(Message("Carve"), here=PATH):
            _CarvePage(lab, solver, skis, (ski, other)).ask()  # answered while the browser builds the page


class _CarvePage(CarvedTurn):
    """Content of the page Carve: menus of skis and snow next to the sliders of `CarvedTurn`."""

    def __init__(self, lab: Lab, solver: Solver, skis: LabSkis, names_in_address: tuple[str, str]) -> None:
        super().__init__(solver)
        self._skis = skis
        names = skis.names()
        first, other = names_in_address
        with ui.element("div").classes("carving"):
            with ui.element("section"):
                with ui.element("div").classes("fields large"):
                    self._ski = choice(Message("Ski"), names, first if first in names else names[0])
                    others = {NOTHING: Message("nothing"), **{name: name for name in names}}
                    self._other = choice(Message("Compared with"), others, other if other in others else NOTHING)
                    self._ratio = choice(Message("Unloading ratio k_u/H_V"), RATIOS, "10")
                    self.snow = SnowChoice(lab, NUMBERS, self.update_snow)
                link(Message("Add or change a ski"), SKIS)
                self.add_sliders(SLIDERS)
            with ui.element("section"):
                self.add_status()
                self.add_facts()
                self.add_download_buttons("carve")
            with ui.element("section").classes("curves"):
                self.add_charts()
        for menu in (self._ski, self._other, self._ratio):
            menu.on_value_change(self.ask)

    def asked(self) -> CarveInputs:
        """Each chosen ski in the same turn."""
        names = [str(name) for name in (self._ski.value, self._other.value) if name != NOTHING]
        return self.inputs(map(self._skis.word, names), float(str(self._ratio.value)))
