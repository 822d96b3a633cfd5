"""Figures and printed numbers of the gallery: python docs/write_gallery.py [--check] [NAME ...].

An example is a script in ``examples/gallery`` that prints what it found and saves one figure under its own name. Its
docstring has a title, a text, and two lines: ``Figure:``, what is to be seen, and ``Known from:``, where its number is
known from. The build of the docs writes a card and a section for each (`write_pages`).
"""

from __future__ import annotations

import argparse
import ast
import io
import os
import runpy
import sys
import tempfile
from contextlib import redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
from fewer_colours import write_fewer_colours

if TYPE_CHECKING:
    from collections.abc import Iterator

DOCS: Final = Path(__file__).resolve().parent
EXAMPLES: Final = DOCS.parent / "examples" / "gallery"
PICTURES: Final = DOCS / "_static" / "gallery"
PRINTED: Final = DOCS / "gallery" / "printed"
THEMES: Final = {
    "snow": (
        "Tests on the slope, and snow that remembers",
        (
            *("one_series", "gauge_offset", "which_law", "two_sites", "shear_blade"),
            *("unloading", "second_in_the_groove", "own_force_law"),
        ),
    ),
    "turns": (
        "Skis, turns and tracks",
        (
            *("more_waist", "does_it_hold", "across_a_pipe", "energy_of_a_turn", "skid_to_carve"),
            *("twelve_metres", "stiffer_tip", "robust_ski"),
            *("radius_of_a_track", "two_tracks", "friction_from_photo_cells"),
        ),
    ),
}
"""Title and examples of each theme."""
STYLE: Final[dict[str, Any]] = {
    "figure.figsize": (6.4, 3.8),
    "figure.constrained_layout.use": True,
    "savefig.dpi": 120,
    "font.family": "DejaVu Sans",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": matplotlib.cycler(color=["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"]),
    "legend.frameon": False,
}


@dataclass(frozen=True, slots=True)
class Words:
    """What an example says of itself."""

    title: str
    text: str
    figure: str
    known: str


@dataclass(frozen=True, slots=True)
class Ran:
    """What an example has left: its variables, what it printed, its picture."""

    values: dict[str, Any]
    printed: str
    picture: bytes


def names() -> Iterator[str]:
    """All examples in their order."""
    for _, group in THEMES.values():
        yield from group


def words(name: str) -> Words:
    """Read the docstring of an example."""
    source = (EXAMPLES / f"{name}.py").read_text(encoding="utf-8")
    told = ast.get_docstring(ast.parse(source)) or ""
    head, known = told.rsplit("\nKnown from: ", 1)
    head, figure = head.rsplit("\nFigure: ", 1)
    title, text = head.split("\n\n", 1)
    return Words(title.rstrip("."), text.strip(), _sentence(figure), " ".join(known.split()))


def ran(name: str) -> Ran:
    """Run an example in an empty folder of its own, in the gallery's style."""
    before, told = Path.cwd(), io.StringIO()
    with tempfile.TemporaryDirectory() as folder, matplotlib.rc_context(STYLE), redirect_stdout(told):
        os.chdir(folder)
        try:
            values = runpy.run_path(str(EXAMPLES / f"{name}.py"))
        finally:
            os.chdir(before)
            plt.close("all")
        picture = (Path(folder) / f"{name}.png").read_bytes()
    return Ran(values, told.getvalue(), picture)


def write_pages(folder: Path = DOCS / "_generated" / "gallery") -> None:
    """Write the cards of all examples and their sections, which the page includes."""
    folder.mkdir(parents=True, exist_ok=True)
    cards = "\n".join(_cards(title, group) for title, group in THEMES.values())
    (folder / "cards.md").write_text(cards, encoding="utf-8")
    (folder / "examples.md").write_text("\n".join(map(_section, names())), encoding="utf-8")


def _cards(title: str, group: tuple[str, ...]) -> str:
    cards = (f"- [![](../_static/gallery/{name}.png) {words(name).title}](#{name})" for name in group)
    return "\n".join((f"## {title}\n\n{{.cards}}", *cards, ""))


def _section(name: str) -> str:
    example = words(name)
    return f"""({name})=
### {example.title}

{example.text}

![{example.figure}](../_static/gallery/{name}.png)

*{example.figure}* Known from: {example.known}

```
{printed(name)}```

```{{literalinclude}} ../../examples/gallery/{name}.py
:language: python
:lines: {_first_line(name)}-
```
"""


def printed(name: str) -> str:
    """Output of an example, as it was kept."""
    return (PRINTED / f"{name}.txt").read_text(encoding="utf-8")


def _sentence(text: str) -> str:
    flowing = " ".join(text.split())
    return flowing[:1].upper() + flowing[1:]


def _first_line(name: str) -> int:
    """Number of the first line after the docstring and the empty one below it."""
    tree = ast.parse((EXAMPLES / f"{name}.py").read_text(encoding="utf-8"))
    return (tree.body[0].end_lineno or 0) + 2


def _draw(name: str, picture: bytes) -> None:
    write_fewer_colours(PICTURES / f"{name}.png", io.BytesIO(picture))


def main() -> int:
    """Number of examples that print something else than was kept."""
    parser = argparse.ArgumentParser(description="The gallery's figures and printed numbers, computed again.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="such as one_series; all by default")
    parser.add_argument("--check", action="store_true", help="write nothing; the exit status counts what differs")
    options = parser.parse_args()
    stale = 0
    for name in options.names or names():
        example = ran(name)
        if example.printed != printed(name):
            stale += 1
            print(f"{name}: prints something else")
        if not options.check:
            _draw(name, example.picture)
            (PRINTED / f"{name}.txt").write_text(example.printed, encoding="utf-8")
    return stale if options.check else 0


if __name__ == "__main__":
    sys.exit(main())
