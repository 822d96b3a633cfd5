"""Helpers that the tests of this folder share."""

from typing import Any

from skisnow.campaign.store import Journals, NewEntry

from ..desk import Desk, Sheet

TOML = """name = "Slope"
place = "a hill"
observers = ["Ada", "Bo"]
load_steps_N = [20.0, 40.5]
gauge_resolution_mm = 0.01
moment_uncertainty_Nm = 0.5

[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200.0
width_mm = 62.0

[[tool]]
name = "round"
shape = "disc"
diameter_mm = 40.0

[[plate]]
name = "blade"
length_mm = 100.0
"""


def begun(desk: Desk, text: str = TOML) -> str:
    return Journals(desk.lab.store).begin(text)


def add_shear(desk: Desk, id_: str, name: str = "1") -> None:
    """A shear test."""
    cells = {"experiment": name, "site": "A", "plate": "blade", "edge_angle_deg": "90", "depth_mm": "6"}
    cells |= {"lever_arm_mm": "250", "moment_Nm": "30"}
    entry = NewEntry(action="add", file="shear.csv", test=name, cells=cells, position=0)
    Journals(desk.lab.store).append(id_, entry, seen=0)


def handlers(sheet: Sheet, text: str) -> list[Any]:
    """The browser's act at a press of a button."""
    (button,) = (each for each in sheet.tagged("q-btn") if each.text == text)
    return [each.js_handler for each in button._event_listeners.values() if each.type == "click"]
