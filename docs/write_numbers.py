"""The numbers of the pages, computed anew: python docs/write_numbers.py [--check] [PAGE ...].

Two marks in a page, which no reader sees, say where its numbers come from:

- ``<!-- $ COMMAND -->``, a line of its own: bash with the functions below, in a folder that the page has for itself, in
  the order of the page. A block of code on the next line is what the command prints.
- ``<!--=NAME-->0.0642<!--/-->``: the text between is the number of that name, from the page's function in
  ``docs/page_numbers.py``, which finds in the folder what the commands have left.

Without ``--check`` the pages are written anew, and git shows what has changed.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parent))
import page_numbers
from benchmarks.page_tables import csv_text, table_path

DOCS = Path(__file__).resolve().parent
COMMAND = re.compile(
    r"^<!-- \$ (?P<words>[^\n]+) -->\n(?:(?P<fence>```\w*\n)(?P<told>.*?)^```$)?", re.MULTILINE | re.DOTALL
)
NUMBER = re.compile(r"<!--=(?P<name>[\w ]+)-->(?P<told>[^<]*)<!--/-->")
BASH = """set -euo pipefail
skisnow() { "$PYTHON" -m skisnow "$@"; }
files() { "$PYTHON" "$DOCS/page_numbers.py" files "$@"; }  # PAGE FOLDER NAME ...: files that a page shows
program() { "$PYTHON" "$DOCS/page_numbers.py" program "$@" | "$PYTHON"; }  # PAGE N: the Nth program that a page shows
"""


def pages() -> list[str]:
    """Pages that have such marks."""
    every = sorted(path.relative_to(DOCS).as_posix() for path in DOCS.rglob("*.md") if "_build" not in path.parts)
    return [name for name in every if COMMAND.search(text := _text(name)) or NUMBER.search(text)]


def anew(page: str) -> dict[Path, str]:
    """A page with all its numbers computed, and its tables."""
    with tempfile.TemporaryDirectory() as folder:
        told = COMMAND.sub(lambda found: _block(found, Path(folder)), _text(page))
        of_page = getattr(page_numbers, re.sub(r"\W", "_", page.removesuffix(".md")), None)
        numbers = of_page(Path(folder)) if of_page else {}
    text = NUMBER.sub(lambda found: f"<!--={found['name']}-->{numbers[found['name']]}<!--/-->", told)
    tables = {name: value for name, value in numbers.items() if value.startswith("| ")}
    name = page.removesuffix(".md")
    return {DOCS / page: text} | {table_path(name, table): csv_text(value) for table, value in tables.items()}


def _text(page: str) -> str:
    return (DOCS / page).read_text(encoding="utf-8")


def _block(found: re.Match[str], folder: Path) -> str:
    printed = _printed(found["words"], folder)
    mark = f"<!-- $ {found['words']} -->\n"
    return f"{mark}{found['fence']}{printed}```" if found["fence"] else mark


def _printed(command: str, folder: Path) -> str:
    home = {"XDG_DATA_HOME": str(folder / ".data"), "COLUMNS": "200", "PYTHON": sys.executable, "DOCS": str(DOCS)}
    done = subprocess.run(
        ["bash", "-c", BASH + command], cwd=folder, env=os.environ | home, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise SystemExit(f"{command}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout.rstrip("\n") + "\n"


def main() -> int:
    """Number of pages that said something else."""
    parser = argparse.ArgumentParser(description="The numbers of the pages, computed anew.")
    parser.add_argument("pages", nargs="*", metavar="PAGE", help="such as how-to/carve.md; all by default")
    parser.add_argument("--check", action="store_true", help="write nothing; the exit status tells how many differ")
    asked = parser.parse_args()
    stale = 0
    for page in asked.pages or pages():
        texts = anew(page)
        if all(path.is_file() and path.read_text(encoding="utf-8") == text for path, text in texts.items()):
            print(f"{page}: as it was")
            continue
        stale += 1
        print(f"{page}: otherwise" if asked.check else f"{page}: written anew")
        for path, text in () if asked.check else texts.items():
            path.write_text(text, encoding="utf-8")
    return stale if asked.check else 0


if __name__ == "__main__":
    sys.exit(main())
