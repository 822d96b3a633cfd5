"""The lab's pages in this process, without a browser: their contents, and what their fields and buttons do.

A page takes a twentieth of a second here, in Chromium a second or more. What the browser's own side does, such as
where the focus goes, only Chromium shows.
"""

from __future__ import annotations

import ast
import asyncio
import re
import shutil
import threading
import time
from collections.abc import Callable, Coroutine, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar
from uuid import uuid4

import httpx
import pytest
from nicegui import Client, app, background_tasks, core, events, ui
from nicegui.app.app import State
from nicegui.element import Element
from nicegui.nicegui import _on_handshake

from skisnow._support.errors import SkisnowError
from skisnow.campaign.store import Store
from skisnow.campaign.store.engine import writing
from skisnow.campaign.store.schema import metadata
from skisnow.web.server import lab_application
from skisnow.web.settings import Lab
from skisnow.web.widgets import LineChart
from tests.coded import all_fields

Answer = TypeVar("Answer")
PATIENCE_S = 300.0  # nothing is asserted of time
_HEADING = re.compile("h[1-6]")
_FIELD = re.compile(r"""field (.*?) = ('(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*"|True|False|None)""")


@dataclass
class Sheet:
    """A page that is open."""

    desk: Desk
    client: Client
    html: str
    scripts: list[str] = field(default_factory=list)
    """Commands of the page to the browser."""
    at_first: list[str] = field(default_factory=list)
    """Its commands while it was built."""

    def of(self, kind: type[Element] | None = None) -> Iterator[Any]:
        """Elements that are seen, in their order on the page."""
        return _seen(self.client.layout, kind)

    def outline(self) -> list[str]:
        """A line for each heading, sentence, field, button, link and chart below the head of the page."""

        def lines() -> list[str]:
            return list(filter(None, map(_line, _seen(self.content, None))))

        try:
            asyncio.get_running_loop()
        except RuntimeError:  # in the loop of the page, which may draw a list again at any time
            return self.desk.do(lines)
        return lines()

    def between(self, first: str, last: str = "") -> list[str]:
        """Lines of the outline from the one to before the other, or one that begins so, or to the end."""
        outline = self.outline()
        rest = outline[outline.index(first) :]
        return rest[: next(at for at, line in enumerate(rest) if line.startswith(last))] if last else rest

    def status(self) -> str:
        """The line that says what came of the last act; nothing where the act is silent."""
        return next((line for line in self.outline() if line.startswith("[status")), "")

    def outcome(self) -> str:
        """Kind of the last act's outcome: "good", "bad" or nothing."""
        found = re.match(r"\[status (\w+)\]", self.status())
        return found[1] if found else ""

    def link(self, text: str) -> str:
        """Address of a link."""
        (found,) = {each.props["href"] for each in self.of(ui.link) if each.text == text}
        return str(found)

    def refusals(self) -> list[str]:
        """Problems that are listed below the status."""
        (listed,) = (each for each in self.tagged("ul") if "refusals" in each.classes)
        return [label.text for label in _seen(listed, ui.label)]

    def faults(self, *names: str) -> list[str]:
        """Problems shown at these fields; each is one."""
        found = [self.field(name).error for name in names]
        assert all(found), found
        return found

    @property
    def content(self) -> Element:
        return next(each for each in self.of() if each.props.get("id") == "content")

    def field(self, name: str, number: int = 0) -> Any:
        """A field by what a screen reader calls it."""
        found = [each for each in self.of() if _is_field(each) and _name(each) == name]
        assert len(found) > number, (name, self.outline())
        return found[number]

    def fill(self, name: str, value: object, number: int = 0) -> None:
        """Type or choose, and leave the field."""
        made = self.field(name, number)
        chosen = value if isinstance(value, list) else [value]
        assert not isinstance(made, ui.select) or all(each in made.options for each in chosen), (value, made.options)
        self.desk.do(lambda: made.set_value(value), self.client)
        self.fire(made, "change", {})

    def press(self, text: str, number: int = 0) -> None:
        """Press a button; it is looked for in the loop of the page, which may draw it again at any time."""

        def pressed() -> None:
            found = [each for each in self.of(ui.button) if text in (each.text, _name(each))]
            assert len(found) > number, (text, self.outline())
            self._handle(found[number], "click", {})

        self.desk.do(pressed, self.client)

    def sends(self, text: str, number: int, **further: str) -> bool:
        """Press a button whose answer the browser waits for; whether the answer is yes."""
        button = next(each for each in self.of(ui.button) if each.text.startswith(text))
        self.fire(button, "click", {"number": number, **further})
        assert self.scripts[-1] in (f"lab.answered({number}, true)", f"lab.answered({number}, false)")
        return self.scripts[-1].endswith("true)")

    def fire(self, element: Element, event: str, args: object) -> None:
        """The browser's message about an element."""
        self.desk.do(lambda: self._handle(element, event, args), self.client)

    def _handle(self, element: Element, event: str, args: object) -> None:
        for each in list(element._event_listeners.values()):
            if each.type == event and not element.is_deleted:
                said = events.GenericEventArguments(sender=element, client=self.client, args=args)
                events.handle_event(each.handler, said)

    def until(self, holds: Callable[[], Answer]) -> Answer:
        """Wait until something holds; gives what it gave."""
        end = time.monotonic() + PATIENCE_S
        while not (found := self.desk.do(holds)):
            assert not self.desk.failures
            assert time.monotonic() < end, self.outline()
            time.sleep(0.01)
        return found

    def shows(self, text: str) -> str:
        """Wait until a line of the outline has this in it; gives the line."""
        return self.until(lambda: next((line for line in self.outline() if text in line), ""))

    def told(self, script: str) -> None:
        """Wait until the browser has to do this."""
        self.until(lambda: any(script in each for each in self.scripts))

    def leave(self) -> None:
        """Close the page, as when the browser goes elsewhere."""
        self.desk.do(self.client.delete)

    def focused(self) -> Any:
        """The element that the page has put the focus on last."""
        told = " ".join([*self.at_first, *self.scripts])
        numbers = re.findall(r'(?:runMethod|getHtmlElement)\((\d+)(?:\)\.focus|, "focus")', told)
        return self.client.elements[int(numbers[-1])] if numbers else None

    def tagged(self, tag: str) -> list[Any]:
        """Elements of HTML that are seen."""
        return [each for each in self.of() if each.tag == tag]

    def charts(self) -> dict[str, dict[str, Any]]:
        """Points of charts, by the title of their vertical axis."""
        return {each.props["panel"]["y"]: each.props["panel"] for each in self.of(LineChart)}


@dataclass
class Desk:
    """A lab whose pages this process answers, without its queues: what is requested waits."""

    folder: Path
    lab: Lab = field(init=False)
    failures: list[Exception] = field(default_factory=list)
    """Unexpected errors of handlers."""
    errors: list[SkisnowError] = field(default_factory=list)
    """Errors of skisnow that were made since the lab was emptied."""

    @property
    def code(self) -> str:
        """Code of the last error; empty without one."""
        return self.errors[-1].code if self.errors else ""

    @property
    def fields(self) -> dict[str, Any]:
        """Fields of the last error and of the messages in it."""
        return all_fields(self.errors[-1])

    def __post_init__(self) -> None:
        self.lab = Lab(Store.open(self.folder / "store.sqlite3"), self.folder / "lab")
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        core.loop = self._loop
        transport = httpx.ASGITransport(lab_application(self.lab, host="127.0.0.1", token=None))
        app.on_exception(self.failures.append)
        app._state = State.STARTED  # timers of pages end where it is not
        self._browser = httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1", follow_redirects=True)

    def kept(self, folder: Path, files: Mapping[str, str]) -> str:
        """Import a campaign of these texts; gives its id."""
        folder.mkdir()
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8")
        return self.lab.store.add(folder).id

    def end(self) -> None:
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()

    def empty(self) -> None:
        """Close all pages, wait for the work that they began, and delete everything in store and folder."""
        self.do(_close_all)
        end = time.monotonic() + PATIENCE_S
        while self.do(_is_busy) and time.monotonic() < end:
            time.sleep(0.01)
        self.failures.clear()
        self.errors.clear()
        with writing(self.lab.store.engine) as connection:
            for table in reversed(metadata.sorted_tables):
                connection.execute(table.delete())
        for each in self.lab.runs.iterdir() if self.lab.runs.is_dir() else ():
            if each.is_dir():
                shutil.rmtree(each)

    def fails(self) -> Exception:
        """Wait until a handler fails; gives what it raised, which then is not a failure of the test."""
        end = time.monotonic() + PATIENCE_S
        while not self.failures:
            assert time.monotonic() < end
            time.sleep(0.01)
        return self.failures.pop()

    def do(self, act: Callable[[], Answer], client: Client | None = None) -> Answer:
        """Do something where the pages live."""

        async def done() -> Answer:
            if client is None:
                return act()
            with client:
                return act()

        return self.wait(done())

    def wait(self, work: Coroutine[Any, Any, Answer]) -> Answer:
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(PATIENCE_S)

    def get(self, path: str, language: str = "en") -> httpx.Response:
        """The answer of an address."""
        return self.wait(self._browser.get(path, headers={"accept-language": language}))

    def post(self, path: str, language: str = "en", **form: Any) -> httpx.Response:
        """The answer of an address to a form of the lab; a redirection is not followed."""
        headers = {"accept-language": language, "origin": "http://127.0.0.1"}
        return self.wait(self._browser.post(path, headers=headers, follow_redirects=False, **form))

    def open(self, path: str, language: str = "en") -> Sheet:
        """Open a page; its connection stands."""
        answer = self.get(path, language)
        assert answer.status_code == 200, answer.text
        (name,) = re.findall(r"'client_id': '([0-9a-f-]+)'", answer.text)
        sheet = Sheet(self, Client.instances[name], answer.text)
        self.do(lambda: _listen(sheet))
        told = {"client_id": name, "tab_id": str(uuid4()), "document_id": str(uuid4())}
        assert self.wait(_on_handshake(f"test-{uuid4()}", told))
        return sheet


def _close_all() -> None:
    for each in list(Client.instances.values()):
        each.delete()


def _is_busy() -> bool:
    """Whether work of a page still runs; the framework's loops, which sleep most of the time, do not count."""
    names = (getattr(task.get_coro(), "__qualname__", "") for task in background_tasks.running_tasks)
    return any(name not in {"Outbox.loop", "Timer._run_in_loop"} for name in names)


def _listen(sheet: Sheet) -> None:
    """Write down the page's commands to the browser, beginning now."""
    send = sheet.client.outbox.enqueue_message
    told = [data for _, kind, data in sheet.client.outbox.messages if kind == "run_javascript"]
    sheet.at_first += [each["code"] for each in told]

    def heard(kind: Any, data: Any, target_id: Any) -> None:
        if kind == "run_javascript":
            sheet.scripts.append(data["code"])
        elif kind in ("open", "download", "notify"):
            sheet.scripts.append(f"{kind} {data}")
        send(kind, data, target_id)

    vars(sheet.client.outbox)["enqueue_message"] = heard


def in_this_process(monkeypatch: pytest.MonkeyPatch, *modules: str) -> list[tuple[Any, ...]]:
    """Do here the work of these modules of `skisnow.web` in another process; gives limits, work, rest."""
    heard: list[tuple[Any, ...]] = []

    def done(bounds: Any, work: Any, *what: Any) -> Any:
        heard.append((bounds, work, *what))
        return work(*what)

    for name in modules:
        monkeypatch.setattr(f"skisnow.web.{name}.confined", done)
    return heard


def values(lines: list[str]) -> dict[str, object]:
    """Values of the fields in lines of an outline, by what a screen reader calls the fields."""
    fields = [match for line in lines if (match := _FIELD.match(line))]
    return {match[1]: ast.literal_eval(match[2]) for match in fields}


@contextmanager
def desk(folder: Path) -> Iterator[Desk]:
    made = Desk(folder)
    yield made
    made.end()


def _seen(element: Element, kind: type[Element] | None) -> Iterator[Any]:
    if not element.visible:
        return
    if kind is None or isinstance(element, kind):
        yield element
    for slot in element.slots.values():
        for each in slot.children:
            yield from _seen(each, kind)


def _is_field(element: Element) -> bool:
    return isinstance(element, ui.input | ui.textarea | ui.select | ui.switch | ui.checkbox)


def _name(element: Element) -> str:
    """Its name for a screen reader."""
    return str(element.props.get("aria-label") or element.props.get("label") or getattr(element, "text", ""))


def _classes(element: Element, *beside: str) -> str:
    kept = " ".join(each for each in element.classes if each not in beside)
    return f"[{kept}]" if kept else ""


def _words(element: Element) -> str:
    return " ".join(filter(None, (each.text for each in _seen(element, ui.label))))


def _line(element: Any) -> str:
    """Nothing for what only holds others."""
    if _HEADING.fullmatch(element.tag):
        line = f"{element.tag} {_words(element)}"
    elif _is_field(element):
        line = _field_line(element)
    elif isinstance(element, ui.button):
        line = f"button{_classes(element, 'act')} {element.text}"
    elif isinstance(element, ui.link):
        line = f"link{_classes(element, 'act', 'nicegui-link')} {element.text} -> {element.props['href']}"
    elif isinstance(element, LineChart):
        line = f"chart {element.props['panel']['label']}"
    elif isinstance(element, ui.html):
        line = f"html {' '.join(re.sub(r'<[^>]+>', ' ', element.content).split())}"
    elif isinstance(element, ui.label) and element.text and not _is_within_heading(element):
        line = f"{_classes(element, 'sentence')} {element.text}".lstrip()
    else:
        line = ""
    return line


def _field_line(element: Any) -> str:
    """Its name and value, and its states; behind an exclamation mark its fault."""
    marks = {
        "numeric": element.props.get("inputmode") == "decimal",
        "optional": "data-optional" in element.props,
        "readonly": "readonly" in element.props,
    }
    error = f" ! {element.props['error-message']}" if element.props.get("error") else ""
    return " ".join([f"field {_name(element)} = {element.value!r}", *(name for name in marks if marks[name])]) + error


def _is_within_heading(element: Element) -> bool:
    above = element.parent_slot.parent if element.parent_slot is not None else None
    return above is not None and bool(_HEADING.fullmatch(above.tag))
