"""Page of a design: sliders for a ski's shape and stiffness beside a competitor in the same turn, and a search."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from nicegui import run, ui

from ..._support.errors import SkisnowError
from ..._support.messages import Message, joined
from ...carving.edge_line import BOOT_REACH
from ...design import Design
from ...ski.ski_file import keys_text
from ..elements import Outcome, button, choice, error_sentence, field, option_texts, page_frame
from ..lab_skis import FILE, NOTHING, LabSkis, menu_with_nothing, ski_of_texts
from ..scenario_fields import SnowChoice
from ..settings import Lab
from ..words import said, typed_number
from .carve import NUMBERS, SLIDERS, CarvedTurn, CarveInputs, Solver, with_sources

PATH: Final = "/design"
TITLE: Final = Message("Design")
SIDECUT: Final = "sidecut_mm"
STIFFNESS: Final = "EI_factor"
TIP: Final = "EI_before_middle"
WIDENED: Final = ("tip_width_mm", "tail_width_mm")
WIDTHS: Final = ("waist_width_mm", *WIDENED)
_CHANGES: Final = tuple(f"{half / 2:+g}" for half in range(-30, 31))
_FACTORS: Final = tuple(f"{hundredths / 100:g}" for hundredths in range(50, 205, 5))
SHAPES: Final = {
    SIDECUT: (Message("Sidecut, tip and tail (mm)"), _CHANGES, "+0"),
    "waist_width_mm": (Message("Waist (mm)"), _CHANGES, "+0"),
    "tip_width_mm": (Message("Tip (mm)"), _CHANGES, "+0"),
    "tail_width_mm": (Message("Tail (mm)"), _CHANGES, "+0"),
    STIFFNESS: (Message("Stiffness EI ×"), _FACTORS, "1"),
    TIP: (Message("EI before the middle ×"), _FACTORS, "1"),
}
"""Sliders of the ski: changes of widths, and factors."""
UNLOADING_RATIO: Final = 10.0
STARTS: Final = 2
PEAK: Final = "force_per_length_N_per_m"
BENT: Final = "bending_mm"
FACTS: Final = {
    "grip_utilisation": (Message("Grip utilisation (1: side-slip)"), ""),
    "side_force_limit_N": (Message("Shear capacity of the snow"), "N"),
    PEAK: (Message("Greatest force per length"), "N/m"),
    BENT: (Message("Deflection 0.4 m before the boot"), "mm"),
}


def add_page(lab: Lab) -> None:
    """Add the page that designs a ski for a turn radius."""
    solver, skis = Solver(), LabSkis(lab.runs)

    @ui.page(PATH)
    async def design(ski: str = "", other: str = "") -> None:
        with page_frame(Message("Design"), here=PATH):
            _DesignPage(lab, solver, skis, (ski, other)).ask()


def designed_keys(keys: Mapping[str, Any], changes: Mapping[str, float]) -> dict[str, Any]:
    """Keys of a ski file with changed widths and EI (`SHAPES`); EI of the rows before the middle has another factor."""
    before = len(keys["EI_N_m2"]) // 2
    stiffness = [
        float(value) * changes[STIFFNESS] * (changes[TIP] if row < before else 1.0)
        for row, value in enumerate(keys["EI_N_m2"])
    ]
    widths = {key: keys[key] + changes[key] + (changes[SIDECUT] if key in WIDENED else 0.0) for key in WIDTHS}
    return {**keys, **widths, "EI_N_m2": stiffness}


def designable_skis(skis: LabSkis) -> dict[str, Mapping[str, Any]]:
    """Keys of the ski files, by name, of skis that are described by three widths and a list of stiffness."""
    keys_by_name = {}
    for name in skis.names():
        try:
            keys = ski_of_texts(*skis.texts(name))[0].keys or {}
        except SkisnowError:  # *Skis* and *Carve* show the error of a damaged file
            continue
        if all(key in keys for key in WIDTHS) and isinstance(keys.get("EI_N_m2"), list):
            keys_by_name[name] = keys
    return keys_by_name


def found_design(inputs: CarveInputs, target: float) -> Design:
    """Search sidecut and stiffness of the ski in the first question for a target radius of the turn (m)."""
    from ...design.search import design_ski
    from ...design.task import design_task
    from ...ski.ski_file import Sources

    sources = Sources()
    question = with_sources(inputs, sources)[0]
    bounds = {key: [float(SHAPES[key][1][0]), float(SHAPES[key][1][-1])] for key in (SIDECUT, STIFFNESS)}
    task = {
        "ski": question.pop("ski"),
        "variables": bounds,
        "conditions": [question],
        "goals": [{"output": "turn_radius_boot_m", "target": target}],
        "starts": STARTS,
    }
    return design_ski(design_task(task, sources=sources))


class _DesignPage(CarvedTurn):
    """Content of the page Design: sliders of ski and turn on the left, the answer on the right."""

    facts = FACTS
    panels = (PEAK, BENT)
    height = 215

    def __init__(self, lab: Lab, solver: Solver, skis: LabSkis, names_in_address: tuple[str, str]) -> None:
        super().__init__(solver)
        self._skis = skis
        own = designable_skis(skis)
        first, other = names_in_address
        self._begun = own
        with ui.element("div").classes("carving designing"):
            with ui.element("section"):
                with ui.element("div").classes("fields large"):
                    self._ski = choice(Message("Ski"), list(own), first if first in own else next(iter(own)))
                    others = menu_with_nothing(skis.names())
                    self._other = choice(
                        Message("Compared with"), others, other if other in others else str(self._ski.value)
                    )
                    self.snow = SnowChoice(lab, NUMBERS, self.update_snow)
                self.add_sliders(SHAPES | SLIDERS)
                self._add_search_and_saving()
            with ui.element("section").classes("curves"):
                self.add_results()
                self.add_charts()
                self.add_download_buttons("design")
        self._ski.on_value_change(self._reset_sliders)
        self._other.on_value_change(self.ask)

    def _add_search_and_saving(self) -> None:
        """Add the wanted radius with its search, and the name of the designed ski with buttons to save or download."""
        with ui.element("div").classes("acts"):
            self._target = field(Message("Wanted radius (m)"), "12", numeric=True)
            self._search = button(Message("Find the design"), self._find_radius, "main")
        self._found = Outcome()
        with ui.element("div").classes("acts"):
            self._name = field(Message("New name"))
            button(Message("Save in the lab"), self._save_ski, once=True)
            button(Message("Download the file"), lambda: ui.download(keys_text(self._designed_keys()).encode(), FILE))
        self._saved = Outcome()

    def _reset_sliders(self) -> None:
        """Set all sliders to their start, and compute again."""
        for key, (_, _, start) in SHAPES.items():
            self.sliders[key].put(float(start), "+g" if start == "+0" else "g")
        self.ask()

    def _designed_keys(self, *, without: tuple[str, ...] = ()) -> dict[str, Any]:
        """Keys of the designed ski; inputs in `without` stay at their start."""
        name = str(self._ski.value)
        changes = {key: float(SHAPES[key][2] if key in without else self.sliders[key].value) for key in SHAPES}
        source = said(Message("designed in the lab from the ski {name}", name=name))
        designed = said(Message("{name}, designed", name=name))
        return designed_keys(self._begun[name], changes) | {"name": designed, "source": source}

    def asked(self) -> CarveInputs:
        """The designed ski and its competitor in the same turn."""
        other = [] if self._other.value == NOTHING else [self._skis.word(str(self._other.value))]
        return self.inputs([self._designed_keys(), *other], UNLOADING_RATIO)

    def fact(self, key: str, answer: dict[str, Any]) -> float | None:
        """Number of an answer for a row of the table: largest force, deflection at one place, or a plain value."""
        if key == PEAK:
            return max(answer[PEAK]) if answer[PEAK] else None
        if key == BENT:
            distance = [abs(place - BOOT_REACH) for place in answer["station_m"]]
            return answer[BENT][distance.index(min(distance))] if answer[BENT] else None
        return super().fact(key, answer)

    async def _find_radius(self) -> None:
        """Set sidecut and stiffness so that the ski makes the wanted radius (m); shows why if it cannot."""
        self._found.say(Message("Searching …"))
        self._search.disable()
        try:
            target = typed_number(Message("the wanted radius"), str(self._target.value or ""))
            inputs = self.inputs([self._designed_keys(without=(SIDECUT, STIFFNESS))], UNLOADING_RATIO)
            design = await run.io_bound(found_design, inputs, target)
        except SkisnowError as error:
            self._found.say(error_sentence(error), bad=True)
            return
        finally:
            self._search.enable()
        if design is None:  # the server ends
            return
        for key, spec in ((SIDECUT, "+.3g"), (STIFFNESS, ".3g")):
            self.sliders[key].put(design.values[key], spec)
        done = Message("Sidecut and stiffness are set: the ski makes this radius.")
        self._found.say(done if design.reached else joined(design.remarks[:-1]), bad=not design.reached)
        self.ask()

    async def _save_ski(self) -> None:
        """Save the designed ski in the lab under the new name, and say so or why not."""
        name = " ".join(str(self._name.value or "").split())
        try:
            await run.io_bound(self._skis.save_texts, name, keys_text(self._designed_keys()), "")
        except SkisnowError as error:
            self._saved.say(Message("Not saved: {error}", error=error_sentence(error)), bad=True)
            return
        self._other.set_options(option_texts(menu_with_nothing(self._skis.names())))
        self._saved.say(Message("Saved: {name}. Carve and Simulate have it too.", name=name))
