"""Numbers of the pages come from commands: they are those that the commands print today."""

import importlib
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
write_numbers: Any = importlib.import_module("write_numbers")
PAGES = write_numbers.pages()
ALWAYS = {
    "tutorials/campaign.md",
    *(f"how-to/{name}.md" for name in ("carve", "compare", "enter-a-campaign", "store", "track")),
}


def text_of(page: str) -> str:
    return (DOCS / page).read_text(encoding="utf-8")


def hidden_commands(page: str) -> Iterator[str]:
    """Each skisnow command behind a block, without what picks lines of its output or sends it away."""
    for found in write_numbers.COMMAND.finditer(text_of(page)):
        for command in found["words"].split("; "):
            if command.startswith("skisnow "):
                yield re.split(r" [|>] ", command)[0].strip()


def test_the_pages_of_the_commands_have_marks() -> None:
    assert set(PAGES) >= ALWAYS


@pytest.mark.parametrize("page", PAGES)
def test_what_is_run_is_what_the_page_tells_to_run(page: str) -> None:
    shown = " ".join(re.sub(r"<!--.*?-->", "", text_of(page), flags=re.DOTALL).replace("\\\n", " ").split())
    commands = list(hidden_commands(page))
    unsaid = {command for command in commands if command.removesuffix(" --out results") not in shown}
    # said on another page, or of a file that no reader has
    assert unsaid <= {
        "skisnow reference campaign --seed 1",
        "skisnow analyse plan --out out",
        "skisnow track slalom.csv",
    }


@pytest.mark.parametrize("page", PAGES)
def test_every_mark_is_whole(page: str) -> None:
    """As many marks as there are beginnings of one: a slip in a mark would leave its number as it is for ever."""
    text = text_of(page)
    assert len(re.findall(r"<!-- ?\$", text)) == len(list(write_numbers.COMMAND.finditer(text)))
    assert text.count("<!--=") == text.count("<!--/-->") == len(write_numbers.NUMBER.findall(text))


def test_every_block_of_output_has_its_command() -> None:
    """The text right behind a command that begins with skisnow is its output, and made by it."""
    bare = {}
    for page in ALWAYS:
        blocks = re.findall(r"^```\nskisnow [^`]*?^```\n\n(```\n.*?)^```", text_of(page), re.MULTILINE | re.DOTALL)
        if blocks:
            bare[page] = blocks
    assert bare == {}


PAGE = """# Page
<!-- $ echo 3 > n; echo said -->
```
old
```

<!-- $ cat n -->
```text
2
```
1 <!--=n-->2<!--/--> m
"""


def test_a_page_gets_what_its_commands_print(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By hand: a block, one that goes on in the folder of the first, a number, and what is not marked."""
    (tmp_path / "page.md").write_text(PAGE, encoding="utf-8")
    monkeypatch.setattr(write_numbers, "DOCS", tmp_path)
    number = "3"
    monkeypatch.setattr(write_numbers.page_numbers, "page", lambda _: {"n": number}, raising=False)
    assert write_numbers.pages() == ["page.md"]
    text = PAGE.replace("old", "said").replace("2\n```", "3\n```").replace(">2<", ">3<")
    assert write_numbers.anew("page.md") == {tmp_path / "page.md": text}
    (tmp_path / "page.md").write_text("<!-- $ echo no >&2; exit 3 -->\n", encoding="utf-8")
    with pytest.raises(SystemExit, match="exit status 3\nno"):
        write_numbers.anew("page.md")


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES)
def test_numbers_are_those_of_today(page: str) -> None:
    """If this fails: python docs/write_numbers.py, and look at what has changed."""
    done = subprocess.run(
        [sys.executable, str(DOCS / "write_numbers.py"), "--check", page], capture_output=True, text=True, check=False
    )
    assert done.stdout == f"{page}: as it was\n", done.stderr
