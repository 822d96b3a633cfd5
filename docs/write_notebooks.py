"""The notebooks' pages, with what their cells print and draw: python docs/write_notebooks.py [--check] [NAME ...].

A notebook in ``docs/tutorials`` is kept without outputs; its page beside it has them. Cells are run as a notebook runs
them: one after the other in one namespace, and the value of a last expression is shown.
"""

from __future__ import annotations

import argparse
import ast
import io
import json
import os
import re
import sys
import tempfile
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import matplotlib

matplotlib.use("agg")
from fewer_colours import write_fewer_colours
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from collections.abc import Iterator

DOCS: Final = Path(__file__).resolve().parent
NOTEBOOKS: Final = DOCS / "tutorials"
PICTURES: Final = DOCS / "_static" / "tutorials"
WALL_TIME: Final = re.compile(r"( steps, )[\d.e-]+ s")
"""What no two runs have alike."""


@dataclass(slots=True)
class Cell:
    """A cell, what its figure shows in words, and what it has printed and drawn."""

    kind: str
    text: str
    alt: str = ""
    printed: str = ""
    pictures: list[Figure] = field(default_factory=list)


def cells_of(name: str) -> list[Cell]:
    """The cells of a notebook, not yet run."""
    notebook = json.loads((NOTEBOOKS / f"{name}.ipynb").read_text(encoding="utf-8"))
    return [
        Cell(cell["cell_type"], "".join(cell["source"]), cell["metadata"].get("alt", "")) for cell in notebook["cells"]
    ]


def executed(name: str) -> tuple[list[Cell], dict[str, Any]]:
    """Run a notebook in an empty folder; its cells with their outputs, and its variables."""
    cells, names, before = cells_of(name), {"__name__": "__main__"}, Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            for cell in cells:
                if cell.kind == "code":
                    _run(cell, names)
        finally:
            os.chdir(before)
    return cells, names


def _run(cell: Cell, names: dict[str, Any]) -> None:
    tree = ast.parse(cell.text)
    shown = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    told = io.StringIO()
    with redirect_stdout(told):
        exec(compile(tree, "<cell>", "exec"), names)
        value = eval(compile(ast.Expression(shown.value), "<cell>", "eval"), names) if shown else None
        if isinstance(value, Figure):
            cell.pictures.append(value)
        elif value is not None:
            print(repr(value))
    cell.printed = WALL_TIME.sub(r"\1… s", told.getvalue())


def page(name: str, cells: list[Cell]) -> str:
    """Markdown of a notebook's page."""
    parts, drawn = [f"<!-- made from {name}.ipynb by docs/write_notebooks.py -->"], 0
    for cell in cells:
        if cell.kind == "markdown":
            parts.append(cell.text)
            continue
        parts.append(f"```python\n{cell.text}\n```")
        if cell.printed:
            parts.append(f"```\n{cell.printed}```")
        for _ in cell.pictures:
            drawn += 1
            parts.append(f"![{cell.alt}](../_static/tutorials/{name}-{drawn}.png)")
    parts.append(f"The notebook of this page: [{name}.ipynb]({name}.ipynb).")
    return "\n\n".join(parts) + "\n"


def _draw(name: str, cells: list[Cell]) -> None:
    PICTURES.mkdir(exist_ok=True)
    for number, figure in enumerate((each for cell in cells for each in cell.pictures), start=1):
        drawn = io.BytesIO()
        figure.savefig(drawn, dpi=130)
        write_fewer_colours(PICTURES / f"{name}-{number}.png", drawn)


def names_of_all() -> Iterator[str]:
    """Every notebook."""
    return (path.stem for path in sorted(NOTEBOOKS.glob("*.ipynb")))


def main() -> int:
    """Number of pages that said something else."""
    parser = argparse.ArgumentParser(description="The pages of the notebooks, made anew.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="such as turn; all by default")
    parser.add_argument("--check", action="store_true", help="write nothing; the exit status tells how many differ")
    asked, stale = parser.parse_args(), 0
    for name in asked.names or names_of_all():
        cells, _ = executed(name)
        path, text = NOTEBOOKS / f"{name}.md", page(name, cells)
        same = path.exists() and path.read_text(encoding="utf-8") == text
        stale += not same
        print(f"{path.name}: {'as it was' if same else 'otherwise' if asked.check else 'written anew'}")
        if not asked.check:
            path.write_text(text, encoding="utf-8")
            _draw(name, cells)
    return stale if asked.check else 0


if __name__ == "__main__":
    sys.exit(main())
