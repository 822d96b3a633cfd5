"""The script of the documentation's pages, in a browser: blocks of code can be copied and scrolled by key."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from .browser_types import Browser, Page

SCRIPT = (Path(__file__).resolve().parents[2] / "docs" / "_static" / "skisnow.js").read_text(encoding="utf-8")
BLOCKS = {
    "session": ">>> a = 1\n>>> for i in range(2):\n...     print(i)\n0\n1\n",
    "command": "skisnow carve --ski slalom \\\n    --load-N 800\n",
    "columns": "outcome       equilibrium\nedge holds    yes\n",
    "message": "error bad_toml: campaign.toml, column screening.exclude: found 'hardness_outliers'\n",
}


@pytest.fixture
def page(chromium: Browser) -> Iterator[Page]:
    """A page with four blocks, whose clipboard is a variable."""
    blocks = "".join(f'<div class="highlight" id="{name}"><pre></pre></div>' for name in BLOCKS)
    opened = chromium.new_page()
    opened.set_content(f"<html><body><article>{blocks}</article></body></html>")
    for name, text in BLOCKS.items():
        opened.evaluate("([id, text]) => { document.querySelector(`#${id} pre`).textContent = text; }", [name, text])
    opened.evaluate(
        "Object.defineProperty(navigator, 'clipboard', "
        "{ value: { writeText: async (text) => { window.copied = text; } } })"
    )
    opened.add_script_tag(content=SCRIPT)
    opened.evaluate("document.dispatchEvent(new Event('DOMContentLoaded'))")
    yield opened
    opened.close()


@pytest.mark.parametrize(
    ("name", "copied"),
    [
        ("session", "a = 1\nfor i in range(2):\n    print(i)"),  # neither prompts nor answers
        ("command", "skisnow carve --ski slalom \\\n    --load-N 800"),
    ],
)
def test_the_button_copies_what_one_types(page: Page, name: str, copied: str) -> None:
    button = page.locator(f"#{name} button.copy")
    assert button.get_attribute("aria-label") == "Copy this code"
    button.focus()
    page.keyboard.press("Enter")
    page.wait_for_function(f"document.querySelector('#{name} button').textContent === 'Copied'")
    assert page.evaluate("window.copied") == copied


def test_blocks_are_reached_by_key_and_long_sentences_wrap(page: Page) -> None:
    for name in BLOCKS:
        block = page.locator(f"#{name} pre")
        assert block.get_attribute("tabindex") == "0"
        assert block.get_attribute("aria-label") == "code"
    wrapping = page.evaluate("[...document.querySelectorAll('.wraps')].map((block) => block.id)")
    assert wrapping == ["command", "message"]
