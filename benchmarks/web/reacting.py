"""Time from a key or a moved slider until the page shows what came of it, by the browser's own clock."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .opening import DRAWN, PATIENCE_MS, TALKS, Times

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .filled_lab import FilledLab

GOAL_S = 0.1
SERIES, LOADS = 4, 7
STEPS = 28
CHARTS = 4
CELLS = "[...document.querySelectorAll('td')].map((each) => each.textContent).join()"

# For each condition the time from the event until it holds and the next picture is to be drawn. ``before`` is its value
# just before the event, ``drawn`` how many charts were drawn since.
WATCH = """([kind, conditions]) => {
  const tests = conditions.map((text) => new Function('before', 'drawn', 'return ' + text));
  const values = () => ({cells: CELLS,
                         value: document.querySelector('.beside .value')?.textContent});
  const before = values();
  const charts = () => [...document.querySelectorAll('[data-drawn]')]
    .reduce((sum, each) => sum + Number(each.dataset.drawn), 0);
  const drawnBefore = charts();
  let begun = null;
  const times = tests.map(() => null);
  window.reaction = new Promise((done) => {
    const look = () => tests.forEach((test, i) => {
      if (begun === null || times[i] !== null || !test(before, charts() - drawnBefore)) return;
      times[i] = -1;
      requestAnimationFrame((now) => {
        times[i] = performance.now() - begun;
        if (times.every((time) => time > 0)) { watching.disconnect(); done(times); }
      });
    });
    const watching = new MutationObserver(look);
    watching.observe(document.body, {subtree: true, childList: true, characterData: true, attributes: true});
    document.addEventListener(kind, () => { begun = performance.now(); }, {capture: true, once: true});
  });
}""".replace("CELLS", CELLS)


def entry_form(browser: Any, lab: FilledLab) -> list[Times]:
    """Readings of new series typed: until each is said to be stored, and until hardness and curve follow it."""
    page = _page(browser)
    found = []
    for number in range(SERIES):
        _begin_series(page, lab, f"new {number + 1}")
        for position in range(LOADS):
            page.locator(".reading input").nth(position).fill(f"{0.9 * (position + 1) ** 0.6:.2f}")
            row = f"document.querySelectorAll('.reading')[{position}]"
            stored = f"{row}.querySelector('.stored').textContent === 'stored'"
            follows = "document.querySelector('.beside .value').textContent !== before.value && drawn > 0"
            found.append(_reaction(page, "keydown", [stored, follows], "Enter"))
    page.context.close()
    words = f"Enter, {lab.readings} readings in the store: until a reading "
    return _named([words + "is stored and said so", words + "has its H_V and curve"], found)


def slider(browser: Any, lab: FilledLab) -> list[Times]:
    """The slider of the edge angle moved step by step, for one ski and for two."""
    found = []
    for skis, other in ((1, "nothing"), (2, "slalom")):
        page = _page(browser)
        page.goto(f"{lab.address}/carve")
        page.wait_for_function(f"{DRAWN} >= {CHARTS}", timeout=PATIENCE_MS)
        if other != "nothing":
            page.get_by_label("Compared with").click()
            page.get_by_role("option", name=other, exact=True).click()
            page.wait_for_function(f"{DRAWN} >= {2 * CHARTS}", timeout=PATIENCE_MS)
        moves = moved_slider(page, "Edge angle (°)", CHARTS)
        page.context.close()
        words = f"Carve, {skis} ski{'s' if skis > 1 else ''}: from the edge angle's slider to "
        found += _named([words + "the numbers", words + "the charts"], moves)
    return found


def moved_slider(page: Any, name: str, charts: int) -> list[list[float]]:
    """Milliseconds to the numbers and to all charts, for steps of a slider up and down."""
    page.get_by_role("slider", name=name, exact=True).focus()
    page.wait_for_timeout(1000)
    shown = [f"{CELLS} !== before.cells", f"drawn >= {charts}"]
    keys = ["ArrowRight"] * (STEPS // 2) + ["ArrowLeft"] * (STEPS // 2)
    return [_reaction(page, "input", shown, key) for key in keys]


def _page(browser: Any) -> Any:
    return browser.new_context(viewport={"width": 1280, "height": 900}).new_page()


def _begin_series(page: Any, lab: FilledLab, name: str) -> None:
    page.goto(f"{lab.address}/enter/{lab.entry}")
    page.wait_for_function(TALKS, timeout=PATIENCE_MS)
    for label, text in (("Name of the test", name), ("Site", "site 3"), ("Edge angle (°)", "45")):
        page.get_by_label(label, exact=True).fill(text)
    page.keyboard.press("Enter")
    page.locator(".reading input").first.wait_for(timeout=PATIENCE_MS)
    page.wait_for_timeout(500)  # a person looks at the form


def _reaction(page: Any, kind: str, conditions: Sequence[str], key: str) -> list[float]:
    page.evaluate(WATCH, [kind, list(conditions)])
    page.keyboard.press(key)
    found: list[float] = page.evaluate("window.reaction")
    return found


def _named(words: Sequence[str], found: Sequence[Sequence[float]]) -> list[Times]:
    return [Times(each, tuple(row[i] / 1e3 for row in found)) for i, each in enumerate(words)]
