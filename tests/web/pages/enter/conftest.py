"""Helpers that the tests of this folder share."""

from dataclasses import dataclass
from typing import Any

import pytest
from nicegui import ui

from skisnow.campaign.store import JournalEntry, Journals, NewEntry
from skisnow.report.charts import SeriesCurve
from skisnow.web.edit_session import EditSession, QuickResults

from ..desk import Desk, Sheet

TOML = """name = "Desk"
observers = ["Ada", "Bo", "Cy"]
load_steps_N = [20, 40.5, 60]
gauge_resolution_mm = 0.01
tool = [
  {name = "ski piece", shape = "ski", length_mm = 200, width_mm = 62},
  {name = "disc", shape = "disc", diameter_mm = 40},
]
plate = [{name = "plate", length_mm = 100}, {name = "blade", length_mm = 50}]
"""
PENETRATION, SHEAR, DENSITY, DROP_CONE = "penetration.csv", "shear.csv", "density.csv", "drop_cone.csv"
SERIES = {"site": "A", "spot": "", "tool": "ski piece", "edge_angle_deg": "30"}
SHEARED = {"site": "A", "plate": "plate", "spot": "", "turning_angle_deg": "", "edge_angle_deg": "90"}
SHEARED |= {"depth_mm": "6", "lever_arm_mm": "250", "moment_Nm": "30"}
NAME = "Name of the test"
CANCEL = "Cancel this test"
DISCS_OFF, READ_AGAIN = "Discs taken off one by one", "Depths read once more after waiting"
OTHER_LOAD = "A load that is not in the disc set"
STORE_WAITED = "Store what was read after waiting"
KG_PER_M3 = "snow_density_kg_per_m3"


def back(load: str) -> str:
    """Field of the depth when discs are taken off."""
    return f"Depth back under {load} N (mm)"


def after_waiting(load: str) -> str:
    """Field of the depth that is read again."""
    return f"Depth after waiting under {load} N (mm)"


def undo_button(page: Sheet) -> str:
    """Text of the button that undoes the last entry; empty without one."""
    return next((each.text for each in page.of(ui.button) if each.text.startswith("Undo")), "")


@dataclass
class Entered:
    """A campaign that is being entered, its pages and its stored entries."""

    desk: Desk
    id_: str

    def open(self, query: str = "", language: str = "en") -> Sheet:
        return self.desk.open(f"/enter/{self.id_}{query}", language)

    def series_page(self, name: str = "1", language: str = "en") -> Sheet:
        return self.open(f"?table=penetration.csv&test={name}", language)

    def begun_series(self) -> Sheet:
        """A page on a series that has no reading yet."""
        return self.open("?table=penetration.csv&test=1&site=A&tool=ski%20piece&edge_angle_deg=30")

    def session(self) -> EditSession:
        return EditSession(self.desk.lab, self.id_)

    def write(self, entry: NewEntry) -> JournalEntry:
        journals = Journals(self.desk.lab.store)
        return journals.append(self.id_, entry, seen=journals.entries(self.id_)[-1].sequence)

    def add(self, file: str, name: str, **cells: str) -> JournalEntry:
        """A row that somebody entered."""
        position = len(self.session().test(file, name).history)
        who = cells.pop("who", "Ada")
        return self.write(NewEntry(action="add", file=file, test=name, cells=cells, position=position, who=who))

    def add_series(self, name: str, *readings: tuple[str, str], **further: str) -> None:
        for load, depth in readings:
            self.add(PENETRATION, name, **{"experiment": name, **SERIES, "load_N": load, "depth_mm": depth} | further)

    def add_shear(self, name: str, **further: str) -> None:
        self.add(SHEAR, name, **({"experiment": name} | SHEARED | further))

    def stored(self, file: str, name: str) -> list[dict[str, str]]:
        """The rows of a test as they are now."""
        return [row.cells for row in self.session().test(file, name).rows]

    def depths(self, name: str = "1") -> list[tuple[str, str]]:
        return [(row["load_N"], row["depth_mm"]) for row in self.stored(PENETRATION, name)]

    def history(self) -> list[JournalEntry]:
        return list(Journals(self.desk.lab.store).entries(self.id_))[1:]


def begun(desk: Desk, text: str = TOML) -> Entered:
    return Entered(desk, Journals(desk.lab.store).begin(text))


@pytest.fixture
def entered(desk: Desk) -> Entered:
    """A campaign in which nothing was entered yet."""
    return begun(desk)


def enter(page: Sheet, name: str, text: str, number: int | None = None) -> None:
    """Type into a field and press Enter."""
    made = page.field(name)
    page.desk.do(lambda: made.set_value(text), page.client)
    args: dict[str, object] = {"once": f"{name} {text}", "text": text.strip()}
    page.fire(made, "keydown.enter", args if number is None else {"number": number, "once": f"question {number}"})


def leave(page: Sheet, name: str, text: str | None = None) -> None:
    """Leave a field, in which a text may have been typed."""
    made = page.field(name)
    if text is not None:
        page.desk.do(lambda: made.set_value(text), page.client)
    page.fire(made, "blur", None)


def reading_row(page: Sheet, name: str) -> Any:
    """The element with the field of a reading and the word beside it."""
    return page.field(name).parent_slot.parent


def details(page: Sheet, words: str) -> Any:
    return next(
        each
        for each in page.tagged("details")
        if any(isinstance(label, ui.label) and label.text == words for label in each.descendants())
    )


def is_open(page: Sheet, words: str) -> bool:
    return "open" in details(page, words).props


def selected(page: Sheet) -> list[Any]:
    """Fields whose text was marked, so that it is typed over."""
    told = [each for each in [*page.at_first, *page.scripts] if '"select"' in each]
    return [page.client.elements.get(int(each.split("(")[1].split(",")[0])) for each in told]


def found(**curves: SeriesCurve) -> QuickResults:
    row = {"H_V_N_per_mm3": 0.25, "H_V_interval_N_per_mm3": None, "n_unloading": 0}
    flags = {(PENETRATION, "a"): {"too_few_loads": "few", "poor_fit": "odd depth_mm"}}
    keyed = {(PENETRATION, name): curve for name, curve in curves.items()}
    return QuickResults(experiments=dict.fromkeys(keyed, row), curves=keyed, flags=flags)
