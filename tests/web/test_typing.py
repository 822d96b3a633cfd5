"""A series that is entered: typed, and entered with its next one."""

from typing import Literal

import pytest

from skisnow.campaign.store import Journals, Store
from skisnow.campaign.store.replayed import description_text

from .browser_types import Locator, Page, WebSocketRoute
from .conftest import Served, entered, fill, has_text, ready
from .test_day import create, enter_series, next_series

LOADS = (20.0, 40.0, 60.0)
TOOL: dict[str, str | float] = {"name": "ski piece", "shape": "ski", "length_mm": 200.0, "width_mm": 62.0}


def begun(served: Served) -> str:
    """The address of a campaign in which nothing is entered."""
    plates: list[dict[str, str | float]] = [{"name": "plate", "length_mm": 100.0}]
    text = description_text({"name": "Quick", "load_steps_N": LOADS}, [TOOL], plates)
    with Store.open(served.store) as store:
        return f"{served.address}enter/{Journals(store).begin(text)}"


def depths(served: Served) -> dict[str, list[str]]:
    """Contents of the store: the depths of each series in the order of their loads."""
    tests = entered(served).of_file("penetration.csv")
    return {test.name: [row.cells["depth_mm"] for row in test.rows] for test in tests}


def test_a_whole_series_and_the_next_without_a_pause(page: Page, served: Served) -> None:
    page.goto(begun(served), wait_until="commit")
    page.locator("fieldset.lab").wait_for(state="attached")
    page.keyboard.type("A\n30\n1.5\n2.15\n2,6\n\n45\n1.9\n2.7\n3.3\n")
    page.get_by_text("Stored: 3.3 mm under 60 N.").wait_for()
    assert depths(served) == {"1": ["1.5", "2.15", "2.6"], "2": ["1.9", "2.7", "3.3"]}
    rows = entered(served).test("penetration.csv", "2").rows
    assert [row.cells["edge_angle_deg"] for row in rows] == ["45"] * 3


def test_shear_tests_without_a_pause(page: Page, served: Served) -> None:
    page.goto(begun(served) + "?table=shear.csv", wait_until="commit")
    page.locator("fieldset.lab").wait_for(state="attached")
    page.keyboard.type("A\n90\n6\n250\n30\n8\n36\n7\n33\n")
    page.get_by_text("Stored: test 3.").wait_for()
    tests = entered(served).of_file("shear.csv")
    found = [[test.rows[0].cells[column] for column in ("depth_mm", "lever_arm_mm", "moment_Nm")] for test in tests]
    assert found == [["6", "250", "30"], ["8", "250", "36"], ["7", "250", "33"]]


@pytest.mark.parametrize("is_busy", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_what_is_rejected_is_shown_at_its_field_and_nothing_is_lost(page: Page, served: Served, is_busy: bool) -> None:
    if is_busy:
        page.add_init_script(LEFT_LATE)
    answers = HeldAnswers(page)
    page.goto(begun(served))
    page.get_by_label("Site", exact=True).and_(page.locator(":focus")).wait_for()
    answers.hold()  # the hand is quicker than the lab, however slowly a busy machine types
    page.keyboard.type("A\n95\n1.5\n2.6\n")
    answers.let_go()
    page.get_by_text("Typed meanwhile and not used: 1.5 ⏎ 2.6 ⏎").wait_for()
    page.get_by_role("alert").get_by_text("“95” is not allowed. Enter a number from 0 to below 90.").wait_for()
    angle = page.get_by_label("Edge angle (°)", exact=True).and_(page.locator(":focus"))
    has_text(angle, "95")
    ready(page)
    angle.select_text()
    answers.hold()  # a refusal that comes before the last Enter has the focus already
    page.keyboard.type("30\n1.5\n2.1.5\n2.6\n\n")
    answers.let_go()
    page.get_by_text("Not stored yet: 40 N.").wait_for()  # the last Enter asked for the next series
    field = page.get_by_label("Depth under 40 N (mm)").and_(page.locator(":focus"))
    field.wait_for()
    ready(page)
    has_text(field, "2.1.5")
    page.locator(".reading.refused").get_by_text("“2.1.5” is not allowed").wait_for()
    assert depths(served) == {"1": ["1.5", "2.6"]}
    field.select_text()
    page.keyboard.type("2.15\n")
    page.get_by_text("Stored: 2.15 mm under 40 N.").wait_for()
    page.locator(".reading.refused").wait_for(state="detached")
    assert depths(served) == {"1": ["1.5", "2.15", "2.6"]}


@pytest.mark.parametrize("is_seen", [False, True])
def test_what_is_typed_after_a_rejected_last_reading_is_not_stored(page: Page, served: Served, is_seen: bool) -> None:
    page.add_init_script(PAUSES)
    page.goto(begun(served))
    page.get_by_label("Site", exact=True).and_(page.locator(":focus")).wait_for()
    page.keyboard.type("A\n30\n1.5\n2.15\n")
    page.get_by_text("Stored: 2.15 mm under 40 N.").wait_for()
    page.keyboard.type("2.6.\n")
    field = page.get_by_label("Depth under 60 N (mm)").and_(page.locator(":focus"))
    field.wait_for()
    if is_seen:
        page.evaluate("pauseOver()")
        ready(page)
        page.keyboard.type("2.6\n")
        page.get_by_text("Stored: 2.6 mm under 60 N.").wait_for()
        assert depths(served) == {"1": ["1.5", "2.15", "2.6"]}
    else:
        page.keyboard.type("\n45\n")
        page.evaluate("pauseOver()")
        page.evaluate("pauseOver()")  # none since the last look
        page.get_by_text("Typed meanwhile and not used: ⏎ 45 ⏎").wait_for()
        has_text(field, "2.6.")
        assert depths(served) == {"1": ["1.5", "2.15"]}


def test_what_is_typed_while_another_scenario_is_drawn_finds_its_field(page: Page, served: Served) -> None:
    answers = HeldAnswers(page)
    page.goto(f"{served.address}simulate")
    ready(page)
    menu = page.get_by_label("Scenario", exact=True)
    before = menu.input_value()
    menu.press("Space")
    page.get_by_role("option").first.wait_for()
    answers.hold()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    page.locator("fieldset.redrawn:disabled").first.wait_for()  # nothing can be pressed or filled by another way
    for _ in range(4):
        page.keyboard.press("Tab")
    page.keyboard.type("12.5")
    answers.let_go()
    has_text(page.get_by_label("Snow hardness H_V (N/mm³)", exact=True), "12.5")
    assert menu.input_value() != before
    page.get_by_role("button", name="Simulate").press("Enter")
    page.get_by_text("Snow hardness H_V (N/mm³): 12.5").wait_for()  # it goes with the stress that is beside it


def test_fields_are_open_while_the_lab_answers_and_only_then(page: Page, served: Served) -> None:
    held: list[WebSocketRoute] = []

    def hold(socket: WebSocketRoute) -> None:  # accepted, and never answered
        held.append(socket)

    page.route_web_socket("**/*", hold)
    page.goto(begun(served))
    site = page.get_by_label("Site", exact=True)
    site.wait_for()
    assert site.is_disabled()
    page.get_by_text("Connecting to the lab.").wait_for()
    assert len(held) == 1
    assert depths(served) == {}


def test_a_connection_that_is_lost_closes_the_fields_and_gives_them_back(page: Page, served: Served) -> None:
    open_sockets: list[WebSocketRoute] = []

    def passed_on(socket: WebSocketRoute) -> None:
        socket.connect_to_server()
        open_sockets.append(socket)

    page.route_web_socket("**/*", passed_on)
    page.goto(begun(served))
    site = page.get_by_label("Site", exact=True)
    site.and_(page.locator(":focus")).wait_for()
    page.keyboard.type("the upper slo")
    page.evaluate(NOTE_WHAT_IS_LOST)
    open_sockets[-1].close()
    page.wait_for_function("window.wasClosed")
    site.and_(page.locator(":focus:enabled")).wait_for()  # it came back by itself
    assert page.locator(".connection").is_hidden()
    page.keyboard.type("pe\n30\n1.5\n")
    page.get_by_text("Stored: 1.5 mm under 20 N.").wait_for()
    page.get_by_text("the upper slope · ski piece · 30°").wait_for()


NOTE_WHAT_IS_LOST = """() => new MutationObserver(() => {
  window.wasClosed ||= document.querySelector('fieldset').disabled
    && /does not answer/.test(document.querySelector('.connection').innerText);
}).observe(document, { subtree: true, attributes: true, characterData: true, childList: true })"""

# A timer of Quasar's tells that a field was left, and in a busy browser keys go before timers: here until a press.
# the hand pauses where the test has a pause, not when a machine has been slow
PAUSES = """(() => {
  const soon = window.setTimeout;
  const pauses = [];
  window.setTimeout = (act, ms, ...rest) => (ms === 250 ? pauses.push(act) : soon(act, ms, ...rest));
  window.pauseOver = () => new Promise((done) => (pauses.splice(0).forEach((act) => act()), soon(done, 0)));
})()"""
LEFT_LATE = """(() => {
  const soon = window.setTimeout;
  const waiting = [];
  window.setTimeout = (act, ...rest) => (rest.length ? soon(act, ...rest) : waiting.push(act));
  window.addEventListener("click", () => waiting.splice(0).forEach((act) => act()));
})()"""


def described(page: Page, served: Served) -> str:
    """Go to the description of the one campaign; its id."""
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
    page.goto(f"{served.address}describe?entry={head.id}")
    return head.id


def send(page: Page) -> None:
    ready(page)
    page.get_by_role("button", name="Store and enter tests").press("Enter")


@pytest.mark.slow
def test_pressed_twice_is_done_once(page: Page, served: Served) -> None:
    page.goto(f"{served.address}describe")
    fill(page, {"Name of the campaign": "one", "Name of plate 1": "plate", "Length (mm) of plate 1": "100"})
    page.get_by_role("button", name="Store and enter tests").dblclick()
    page.get_by_role("heading", name="New series").wait_for()
    with Store.open(served.store) as store:
        assert len(Journals(store).list()) == 1
    page.goto(f"{served.address}skis")
    page.get_by_label("EI ×", exact=True).wait_for()
    fill(page, {"New name": "mine"})
    page.get_by_role("button", name="Save in the lab").dblclick()
    page.get_by_role("columnheader", name="mine").wait_for()
    page.get_by_text("Saved: mine.").wait_for()
    page.goto(f"{served.address}simulate")
    ready(page)
    page.get_by_role("button", name="Simulate").dblclick()
    page.get_by_text("is in the queue.").wait_for()
    page.get_by_role("button", name="Cancel").click()
    page.locator(".card", has_text="cancelled").wait_for()
    assert page.locator(".card").count() == 1


class HeldAnswers:
    """Answers of the lab to a page, which may be held back."""

    def __init__(self, page: Page) -> None:
        self._held: list[tuple[WebSocketRoute, str | bytes]] | None = None
        page.route_web_socket("**/*", self._pass_on)

    def _pass_on(self, socket: WebSocketRoute) -> None:
        def answer(message: str | bytes) -> None:
            if self._held is None:
                socket.send(message)
            else:
                self._held.append((socket, message))

        lab = socket.connect_to_server()
        socket.on_message(lab.send)
        lab.on_message(answer)

    def hold(self) -> None:
        self._held = []

    def let_go(self) -> None:
        held, self._held = self._held or [], None
        for socket, message in held:
            socket.send(message)


def test_the_curve_follows_the_readings(page: Page, served: Served) -> None:
    """Load over depth; under the mouse the reading in numbers and, behind it, what the law says there."""
    create(page, served)
    enter_series(page, "1")
    points = page.locator(".beside path.points")
    drawn = "document.querySelectorAll('.beside path.points')[{}]?.getAttribute('d').split('M').length === 5"
    page.wait_for_function(drawn.format(0))
    assert points.count() == 1
    x, y = (points.get_attribute("d") or "").split("M")[-1].removesuffix("h0").split()
    page.locator(".beside svg[role=img]").hover(position={"x": float(x), "y": float(y)})
    assert (page.locator(".beside svg g text").text_content() or "").startswith("3.000: 80.0 · ")
    next_series(page)
    enter_series(page, "3")
    page.wait_for_function(drawn.format(1))
    behind, own = (each.get_attribute("d") or "" for each in points.all())
    assert (behind.count("M"), own.count("M")) == (4, 4)
    left, top = zip(*(map(float, each.removesuffix("h0").split()) for each in own.split("M")[1:]), strict=True)
    assert sorted(left) == list(left)  # deeper and deeper
    assert sorted(top, reverse=True) == list(top)  # under more and more load, which counts upwards


NAMELESS = """elements => elements.filter((element) => !(element.getAttribute('aria-label') || element.innerText?.trim()
  || [...(element.labels || [])].map(label => label.innerText.trim()).join(' '))).map((element) => element.outerHTML)"""
"""Those of elements that a screen reader has no name for."""


def tab_to(page: Page, place: Locator) -> None:
    """Go there by the tabulator; it is further than any page is long where it cannot be reached."""
    element = place.element_handle()
    for _ in range(150):
        is_focused, is_drawn = element.evaluate("each => [each === document.activeElement, each.isConnected]")
        if is_focused:
            return
        if not is_drawn:  # another element was drawn in its place
            element = place.element_handle()
        page.keyboard.press("Tab")
    raise AssertionError(f"{place} is not reached by the tabulator")


def press(page: Page, role: Literal["link", "button"], name: str, *, key: str = "Enter") -> None:
    ready(page)
    tab_to(page, page.get_by_role(role, name=name, exact=True))
    page.keyboard.press(key)


def fits(page: Page) -> None:
    ready(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390, page.url


def test_the_keyboard_alone_on_a_phone(page: Page, served: Served) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    page.goto(served.address)
    fits(page)
    press(page, "link", "New campaign")
    page.get_by_label("Name of the campaign").and_(page.locator(":focus")).wait_for()
    fits(page)
    page.keyboard.type("By keys\na slope\nAda\n20 40 60\n0.01")
    for name, text in (
        ("Name of tool 1", "ski piece"),
        ("Length (mm) of tool 1", "200"),
        ("Width (mm) of tool 1", "62"),
    ):
        tab_to(page, page.get_by_label(name))
        page.keyboard.type(text)
    tab_to(page, page.get_by_label("Name of plate 1"))
    page.keyboard.type("plate\n100")
    press(page, "button", "Store and enter tests", key="Space")
    page.get_by_role("heading", name="New series").wait_for()
    page.keyboard.type("A\n30\n1.5\n22.5\n2.6\n")
    page.get_by_text("Stored: 2.6 mm under 60 N.").wait_for()
    fits(page)
    page.keyboard.press("Shift+Tab")  # from Next series back to the last reading, and to the one before it
    page.keyboard.press("Shift+Tab")
    has_text(page.get_by_label("Depth under 40 N (mm)").and_(page.locator(":focus")), "22.5")
    page.keyboard.type("2.15\n\n")  # the tabulator marked the old text; the usual reason is taken
    page.get_by_text("corrected from 22.5").wait_for()
    press(page, "button", "Cancel this test", key="Space")
    press(page, "button", "Leave it as it was")
    page.get_by_role("button", name="Cancel this test").and_(page.locator(":focus")).wait_for()
    press(page, "button", "Cancel this test", key="Space")
    page.keyboard.type("the tool slipped\n")
    page.get_by_text("Cancelled: the tool slipped").wait_for()
    press(page, "button", "Undo: cancelled (the tool slipped)")
    page.get_by_text("Undone.").wait_for()
    press(page, "link", "Shear")
    page.get_by_role("heading", name="New test").wait_for()
    page.keyboard.type("A\n90\n6\n250\n30\n")
    page.get_by_text("S_f = 0.200 N/mm²").wait_for()  # 30 N m / 0.25 m / (100 mm × 6 mm), by hand
    fits(page)
    press(page, "link", "Analysis")
    page.get_by_text("1 penetration experiment (1 used), 1 shear experiment (1 used)").wait_for()
    rows = entered(served).test("penetration.csv", "1").rows
    assert [row.cells["depth_mm"] for row in rows] == ["1.5", "2.15", "2.6"]
