"""A new campaign, or the description of one that is being entered: name, people, gauge, discs, tools, plates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from nicegui import ui

from ..._support.errors import FieldDataError, ParameterError, SkisnowError
from ..._support.user_files import toml_values
from ...campaign.problems import Problem
from ...campaign.reading.campaign_file import SHAPES
from ...campaign.store import Journals, NewEntry, OvertakenError
from ...campaign.store.journal_entry import DESCRIPTION
from ...campaign.store.replayed import Description, description_text
from ..edit_session import EditSession
from ..elements import StatusLine, choice, field
from ..language import said
from ..layout import framed, heading, sentence
from ..number_input import typed_number
from ..page_addresses import entering, required_id
from ..page_requests import asked, asking_button, form, go_on, row_button

if TYPE_CHECKING:
    from nicegui.events import GenericEventArguments

    from ..elements import TypedField
    from ..settings import Lab

HERE: Final = "/"
NUMBERS: Final = {
    "gauge_resolution_mm": "Step of the depth gauge (mm)",
    "load_uncertainty_N": "Uncertainty of the load (N)",
    "moment_uncertainty_Nm": "Uncertainty of the moment (N m)",
    "lever_arm_uncertainty_mm": "Uncertainty of the lever arm (mm)",
}
LENGTHS: Final = {"length_mm": "Length (mm)", "width_mm": "Width (mm)", "diameter_mm": "Diameter (mm)"}
LENGTHS_OF_SHAPES: Final = LENGTHS | {"radius_mm": "Radius (mm)"}
_SHAPE: Final = "Shape of tool {}"
MOST_ROWS: Final = 200
"""That come back when a page is loaded anew."""
SHAPE_WORDS: Final = {"ski": "piece of ski", "disc": "disc", "cylinder": "cylinder on its side"}


def add_page(lab: Lab) -> None:
    """Add the page to the application."""

    @ui.page("/describe")
    def describe(entry: str = "") -> None:
        session = EditSession(lab, required_id(entry)) if entry else None
        with framed("Campaign" if session else "New campaign", here=HERE, ahead=True):
            status = StatusLine()
            with form(""):
                described = DescriptionForm(toml_values(session.campaign.description) if session else None)

            def done() -> bool:
                try:
                    id_ = _stored(lab, session, described.text(), asked().once)
                except SkisnowError as error:
                    _show_refusal(status, error)
                    return False
                go_on(entering(id_))
                return True

            with ui.element("div").classes("acts end"):
                asking_button("Store and enter tests", done, "main")
            _take_kept(described)


def _show_refusal(status: StatusLine, error: SkisnowError) -> None:
    if isinstance(error, FieldDataError):
        errors = [each for each in error.problems if isinstance(each, Problem) and each.severity == "error"]
        status.say("Not stored:", "bad", [said(str(each)) for each in errors])
    else:
        status.say(str(error) if isinstance(error, OvertakenError) else f"Not stored: {error}", "bad")
    status.run_method("scrollIntoView")


def _take_kept(described: DescriptionForm) -> None:
    """Let the form have the rows again that the browser kept when the page was loaded anew."""
    client = ui.context.client

    def grow(event: GenericEventArguments) -> None:
        described.grow(event.args)
        client.run_javascript("lab.grown()")

    ui.on("grow", grow)


def _stored(lab: Lab, session: EditSession | None, text: str, once: str | None) -> str:
    if session is None:
        return Journals(lab.store).begin(text, once=once)
    _require_used_names(session, toml_values(text))
    if text != session.campaign.description:
        entry = NewEntry(action="describe", file=DESCRIPTION, cells={DESCRIPTION: text})
        session.write_down(entry, seen=session.campaign.described)
    return session.id


def _require_used_names(session: EditSession, described: dict[str, Any]) -> None:
    """Refuse a description without the tools and plates that tests were made with."""
    for kind in ("tool", "plate"):
        known = {each["name"] for each in described.get(kind, ())}
        for test in session.campaign.tests.values():
            gone = {row.cells[kind] for row in test.rows if kind in row.cells} - known
            if gone:
                raise ParameterError(
                    f"test {test.name} was made with the {kind} {min(gone)}: leave that name as it is, and give"
                    f" another {kind} an entry of its own"
                )


class DescriptionForm:
    """The fields of campaign.toml; a key that the form does not know, such as the screening's, is kept."""

    def __init__(self, described: dict[str, Any] | None) -> None:
        given = _usual() if described is None else described
        self._given = given
        with ui.element("div").classes("fields"):
            self._name = field("Name of the campaign", given.get("name", ""), wide=True)
            self._place = field("Place", given.get("place", ""), wide=True)
            self._observers = field("Observers, with commas between", ", ".join(given.get("observers", ())), wide=True)
        if described is None:
            self._name.run_method("focus")
        heading("Discs and gauges")
        sentence("What is left empty counts as 0, and the report says so.", "quiet")
        loads = " ".join(f"{load:g}" for load in given.get("load_steps_N", ()))
        with ui.element("div").classes("fields"):
            self._loads = field("Disc loads (N), with blanks between", loads, wide=True)
            self._numbers = {key: field(words, _shown(given.get(key)), numeric=True) for key, words in NUMBERS.items()}
        self._tools = _Entries("Tools", "tool", given.get("tool", ()))
        self._plates = _Entries("Plates of the shear test", "plate", given.get("plate", ()))

    def grow(self, kept: Any) -> None:
        """Have as many rows as the browser kept, with what was chosen in them; anything else counts as not said."""
        said = kept if isinstance(kept, dict) else {}
        rows, choices = (each if isinstance(each, dict) else {} for each in (said.get("rows"), said.get("choices")))
        for entries in (self._tools, self._plates):
            entries.grow(rows.get(entries.kind), choices)

    def text(self) -> str:
        """The text of campaign.toml; errors as `description_text` raises them."""
        observers = [name.strip() for name in (self._observers.value or "").split(",") if name.strip()]
        loads = [typed_number("the loads", word) for word in (self._loads.value or "").replace(";", " ").split()]
        values: dict[str, Any] = {"name": (self._name.value or "").strip(), "place": (self._place.value or "").strip()}
        if not values["name"]:
            raise ParameterError("the campaign has no name")
        values |= {"observers": observers or None, "load_steps_N": loads or None}
        values |= {
            key: typed_number(NUMBERS[key], each.value or "") for key, each in self._numbers.items() if each.value
        }
        text = description_text(Description(values, self._tools.values(), self._plates.values()))
        return text + _screening(self._given)


class _Entries:
    """Tools or plates: a name and lengths each, as many as are needed."""

    def __init__(self, title: str, kind: str, given: Any) -> None:
        self.kind = kind
        self._rows: list[tuple[TypedField, ui.select | None, dict[str, TypedField]]] = []
        heading(title)
        self._place = ui.element("div").props(f"data-rows={kind}")
        for entry in list(given) or [dict[str, Any]()]:
            self._add(entry)
        row_button(f"Another {kind}", self._another)

    def grow(self, count: Any, choices: dict[Any, Any]) -> None:
        """Have at least so many rows, and the shapes that are chosen by the names of their fields."""
        while isinstance(count, int) and len(self._rows) < min(count, MOST_ROWS):
            self._add({})
        shapes = {said(words): shape for shape, words in SHAPE_WORDS.items()}
        for number, (_, shape, _) in enumerate(self._rows, start=1):
            word = choices.get(said(_SHAPE.format(number)))
            if shape is not None and isinstance(word, str) and word in shapes:
                shape.set_value(shapes[word])

    def _another(self) -> None:
        self._add({})
        name = self._rows[-1][0]
        name.client.run_javascript(f"getHtmlElement({name.id}).focus()")  # its own focus() waits for a menu to close

    def _add(self, given: dict[str, Any]) -> None:
        number = len(self._rows) + 1
        with self._place, ui.element("div").classes("fields row"):
            name = field(f"Name of {self.kind} {number}", given.get("name", ""))
            shape = None
            if self.kind == "tool":
                shape = choice(_SHAPE.format(number), SHAPE_WORDS, given.get("shape", "ski"))
            keys = LENGTHS_OF_SHAPES if shape is not None else {"length_mm": LENGTHS["length_mm"]}
            lengths = {
                key: field(f"{words} of {self.kind} {number}", _shown(given.get(key)), numeric=True)
                for key, words in keys.items()
            }
        self._rows.append((name, shape, lengths))
        if shape is not None:
            shape.on_value_change(lambda: _show_lengths(shape, lengths))
            _show_lengths(shape, lengths)

    def values(self) -> list[dict[str, Any]]:
        """The entries that have a name; one with lengths alone is refused."""
        found = []
        for number, (name, shape, lengths) in enumerate(self._rows, start=1):
            if not (name.value or "").strip():
                if any((each.value or "").strip() for each in lengths.values()):
                    raise ParameterError(f"{self.kind} {number} has lengths and no name; give it one, or empty them")
                continue
            entry: dict[str, Any] = {"name": name.value.strip()}
            if shape is not None:
                entry["shape"] = shape.value
            used = SHAPES[shape.value].argument_of_key if shape is not None else lengths
            entry |= {
                key: typed_number(f"{LENGTHS_OF_SHAPES[key]} of {entry['name']}", lengths[key].value or "")
                for key in used
            }
            found.append(entry)
        return found


def _show_lengths(shape: ui.select, lengths: dict[str, TypedField]) -> None:
    for key, each in lengths.items():
        each.set_visibility(key in SHAPES[shape.value].argument_of_key)


def _usual() -> dict[str, Any]:
    """What stands in the form of a new campaign: discs and tool of the published method."""
    return {
        "load_steps_N": (12, 92, 172, 252, 332, 412, 492),
        "tool": ({"name": said("ski piece"), "shape": "ski", "length_mm": 200, "width_mm": 62},),
        "plate": ({"name": said("plate"), "length_mm": 100},),
    }


def _shown(value: float | None) -> str:
    return "" if value is None else f"{value:.12g}"


def _screening(given: dict[str, Any]) -> str:
    codes = given.get("screening", {}).get("exclude")
    return "" if codes is None else f"\n[screening]\nexclude = {codes!r}\n"
