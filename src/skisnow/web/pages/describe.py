"""Page for the description of a new or entered campaign: name, people, gauges, discs, tools, plates."""

from __future__ import annotations

from typing import Any, Final

from nicegui import ui
from nicegui.events import GenericEventArguments

from ..._support.errors import FieldDataError, ParameterError, SkisnowError
from ..._support.messages import Message, template
from ..._support.user_files.text_files import toml_values
from ...campaign.problems import Problem
from ...campaign.reading.campaign_file import SHAPES
from ...campaign.store import Journals, NewEntry, OvertakenError
from ...campaign.store.journal import DESCRIPTION
from ...campaign.store.replayed import description_text
from ..edit_session import EditSession
from ..elements import StatusLine, choice, field, heading, page_frame, sentence
from ..page_requests import asking_button, current_request, entry_address, form, go_on, required_id, row_button
from ..settings import Lab
from ..words import language_of, number_text, said, typed_number

HERE: Final = "/"
NUMBERS: Final = {
    "gauge_resolution_mm": Message("Step of the depth gauge (mm)"),
    "load_uncertainty_N": Message("Uncertainty of the load (N)"),
    "moment_uncertainty_Nm": Message("Uncertainty of the moment (N m)"),
    "lever_arm_uncertainty_mm": Message("Uncertainty of the lever arm (mm)"),
}
LENGTHS: Final = {
    "length_mm": Message("Length (mm)"),
    "width_mm": Message("Width (mm)"),
    "diameter_mm": Message("Diameter (mm)"),
}
LENGTHS_OF_SHAPES: Final = LENGTHS | {"radius_mm": Message("Radius (mm)")}
_SHAPE: Final = template("Shape of tool {number}")
_ANOTHER: Final = {"tool": Message("Another tool"), "plate": Message("Another plate")}
_NAME_OF: Final = {"tool": template("Name of tool {number}"), "plate": template("Name of plate {number}")}
_LENGTH_OF: Final = {
    "tool": template("{length} of tool {number}"), "plate": template("{length} of plate {number}")
}  # fmt: skip
MOST_ROWS: Final = 200  # maximum number of rows that are restored when a page is loaded again
SHAPE_WORDS: Final = {
    "ski": Message("piece of ski"),
    "disc": Message("disc"),
    "cylinder": Message("cylinder on its side"),
}


def add_page(lab: Lab) -> None:
    """Add the page with the form of a campaign's description."""

    @ui.page("/describe")
    def describe(entry: str = "") -> None:
        session = EditSession(lab, required_id(entry)) if entry else None
        with page_frame(Message("Campaign") if session else Message("New campaign"), here=HERE, ahead=True):
            status = StatusLine()
            with form(""):
                described = DescriptionForm(toml_values(session.campaign.description) if session else None)

            def done() -> bool:
                try:
                    id_ = _store_description(lab, session, described.text(), current_request().once)
                except SkisnowError as error:
                    _show_refusal(status, error)
                    return False
                go_on(entry_address(id_))
                return True

            with ui.element("div").classes("acts end"):
                asking_button(Message("Store and enter tests"), done, "main")
            client = ui.context.client

            def restore_rows(event: GenericEventArguments) -> None:
                described.grow(event.args)
                client.run_javascript("lab.grown()")

            ui.on("grow", restore_rows)


def _show_refusal(status: StatusLine, error: SkisnowError) -> None:
    """Show why a description was not stored; problems of campaign.toml are listed."""
    if isinstance(error, FieldDataError):
        errors = [problem for problem in error.problems if isinstance(problem, Problem) and problem.severity == "error"]
        status.say(Message("Not stored:"), "bad", [problem.text(language_of()) for problem in errors])
    else:
        is_overtaken = isinstance(error, OvertakenError)
        status.say(error.message if is_overtaken else Message("Not stored: {error}", error=error), "bad")
    status.run_method("scrollIntoView")


def _store_description(lab: Lab, session: EditSession | None, text: str, once: str | None) -> str:
    """Store a campaign's description and return its id; rejects the removal of tools and plates in use."""
    if session is None:
        return Journals(lab.store).begin(text, once=once)
    described = toml_values(text)
    for kind in ("tool", "plate"):
        names = {entry["name"] for entry in described.get(kind, ())}
        for test in session.campaign.tests.values():
            missing = {row.cells[kind] for row in test.rows if kind in row.cells} - names
            if missing:
                message = Message(_IN_USE[kind], test=test.name, name=min(missing))
                raise ParameterError(message).tag("name_in_use")
    if text != session.campaign.description:
        entry = NewEntry(action="describe", file=DESCRIPTION, cells={DESCRIPTION: text})
        session.write_down(entry, seen=session.campaign.described)
    return session.id


_IN_USE: Final = {
    "tool": template(
        "test {test} was made with the tool {name}: leave that name as it is, and give another tool its own entry"
    ),
    "plate": template(
        "test {test} was made with the plate {name}: leave that name as it is, and give another plate its own entry"
    ),
}
_NO_NAME: Final = {
    "tool": template("tool {number} has lengths and no name; give it one, or empty them"),
    "plate": template("plate {number} has lengths and no name; give it one, or empty them"),
}


class DescriptionForm:
    """Form of campaign.toml; the keys of the screening are kept."""

    def __init__(self, described: dict[str, Any] | None) -> None:
        values = _default_description() if described is None else described
        self._given = values
        with ui.element("div").classes("fields"):
            self._name = field(Message("Name of the campaign"), values.get("name", ""), wide=True)
            self._place = field(Message("Place"), values.get("place", ""), wide=True)
            self._observers = field(
                Message("Observers, with commas between"), ", ".join(values.get("observers", ())), wide=True
            )
        if described is None:
            self._name.run_method("focus")
        heading(Message("Discs and gauges"))
        sentence(Message("Empty fields count as 0, with a note in the report."), "quiet")
        loads = " ".join(number_text(f"{load:g}") for load in values.get("load_steps_N", ()))
        with ui.element("div").classes("fields"):
            self._loads = field(Message("Disc loads (N), with blanks between"), loads, wide=True)
            self._numbers = {
                key: field(words, _number_text(values.get(key)), numeric=True) for key, words in NUMBERS.items()
            }
        self._tools = EntryRows(Message("Tools"), "tool", values.get("tool", ()))
        self._plates = EntryRows(Message("Plates of the shear test"), "plate", values.get("plate", ()))

    def grow(self, state: Any) -> None:
        """Add rows of tools and plates as many as the browser's state has, with their shapes; ignore invalid values."""
        fields = state if isinstance(state, dict) else {}
        rows, choices = (part if isinstance(part, dict) else {} for part in (fields.get("rows"), fields.get("choices")))
        for entries in (self._tools, self._plates):
            entries.grow(rows.get(entries.kind), choices)

    def text(self) -> str:
        """Text of campaign.toml; errors as in `description_text`."""
        observers = [name.strip() for name in (self._observers.value or "").split(",") if name.strip()]
        words = (self._loads.value or "").replace(";", " ").split()
        loads = [typed_number(Message("the loads"), word) for word in words]
        values: dict[str, Any] = {"name": (self._name.value or "").strip(), "place": (self._place.value or "").strip()}
        if not values["name"]:
            raise ParameterError("the campaign has no name").tag("no_name")
        values |= {"observers": observers or None, "load_steps_N": loads or None}
        values |= {
            key: typed_number(NUMBERS[key], number.value or "") for key, number in self._numbers.items() if number.value
        }
        text = description_text(values, self._tools.values(), self._plates.values())
        codes = self._given.get("screening", {}).get("exclude")
        return text + ("" if codes is None else f"\n[screening]\nexclude = {codes!r}\n")


class EntryRows:
    """Rows of a form for tools or plates, each with name and lengths."""

    def __init__(self, title: str, kind: str, entries: Any) -> None:
        self.kind = kind
        self._rows: list[tuple[ui.input, ui.select | None, dict[str, ui.input]]] = []
        heading(title)
        self._place = ui.element("div").props(f"data-rows={kind}")
        for entry in list(entries) or [dict[str, Any]()]:
            self._add_row(entry)
        row_button(_ANOTHER[kind], self._add_focused_row)

    def grow(self, count: Any, choices: dict[Any, Any]) -> None:
        """Add rows up to a count, and set shapes by the names of their fields."""
        while isinstance(count, int) and len(self._rows) < min(count, MOST_ROWS):
            self._add_row({})
        shapes = {said(words): shape for shape, words in SHAPE_WORDS.items()}
        for number, (_, shape, _) in enumerate(self._rows, start=1):
            word = choices.get(said(Message(_SHAPE, number=number)))
            if shape is not None and isinstance(word, str) and word in shapes:
                shape.set_value(shapes[word])

    def _add_focused_row(self) -> None:
        """Add an empty row and put the focus on its name."""
        self._add_row({})
        name = self._rows[-1][0]
        name.client.run_javascript(f"getHtmlElement({name.id}).focus()")  # focus() waits for a menu to close

    def _add_row(self, values: dict[str, Any]) -> None:
        """Add the fields of a tool or plate with its values by key."""
        number = len(self._rows) + 1
        with self._place, ui.element("div").classes("fields row"):
            name = field(Message(_NAME_OF[self.kind], number=number), values.get("name", ""))
            shape = None
            if self.kind == "tool":
                shape = choice(Message(_SHAPE, number=number), SHAPE_WORDS, values.get("shape", "ski"))
            keys = LENGTHS_OF_SHAPES if shape is not None else {"length_mm": LENGTHS["length_mm"]}
            names = {key: Message(_LENGTH_OF[self.kind], length=words, number=number) for key, words in keys.items()}
            lengths = {key: field(words, _number_text(values.get(key)), numeric=True) for key, words in names.items()}
        self._rows.append((name, shape, lengths))
        if shape is not None:
            shape.on_value_change(lambda: _show_lengths(shape, lengths))
            _show_lengths(shape, lengths)

    def values(self) -> list[dict[str, Any]]:
        """Values of the rows that have a name, by key; lengths without a name are an error."""
        entries = []
        for number, (name, shape, lengths) in enumerate(self._rows, start=1):
            if not (name.value or "").strip():
                if any((length.value or "").strip() for length in lengths.values()):
                    raise ParameterError(_NO_NAME[self.kind]).tag("no_name", number=number)
                continue
            entry: dict[str, Any] = {"name": name.value.strip()}
            if shape is not None:
                entry["shape"] = shape.value
            used = SHAPES[shape.value].lengths if shape is not None else lengths
            for key in used:
                words = Message("{length} of {name}", length=LENGTHS_OF_SHAPES[key], name=entry["name"])
                entry[key] = typed_number(words, lengths[key].value or "")
            entries.append(entry)
        return entries


def _show_lengths(shape: ui.select, lengths: dict[str, ui.input]) -> None:
    """Show only the length fields of the chosen shape."""
    for key, length in lengths.items():
        length.set_visibility(key in SHAPES[shape.value].lengths)


def _default_description() -> dict[str, Any]:
    """Values of the form of a new campaign: discs and tool of the published method."""
    return {
        "load_steps_N": (12, 92, 172, 252, 332, 412, 492),
        "tool": ({"name": said(Message("ski piece")), "shape": "ski", "length_mm": 200, "width_mm": 62},),
        "plate": ({"name": said(Message("plate")), "length_mm": 100},),
    }


def _number_text(value: float | None) -> str:
    """Number for a field in local form; "" for None."""
    return "" if value is None else number_text(f"{value:.12g}")
