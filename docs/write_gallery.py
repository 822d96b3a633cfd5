"""Pages, figures and printed numbers of the gallery: python docs/write_gallery.py [--check] [NAME ...].

An example is a script in ``examples/gallery`` that prints what it found and saves one figure under its own name. Its
docstring has a title, a text, and two lines: ``Figure:``, what is to be seen, and ``Known from:``, where its number is
known from. Each theme in ``THEMES`` is a page with a section for each of its examples.
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
PAGES: Final = DOCS / "gallery"
START, END = "<!-- examples -->", "<!-- end of examples -->"
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
            *("radius_of_a_track", "two_tracks", "friction_from_photo_cells"),
        ),
    ),
}
"""Title and examples of each page."""
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


def page(theme: str, printed: dict[str, str]) -> str:
    """Markdown of the page of a theme, with what each example printed."""
    title, group = THEMES[theme]
    return "\n".join([f"# {title}\n", *(_section(name, printed[name]) for name in group)])


def _section(name: str, printed: str) -> str:
    example = words(name)
    return f"""({name})=
## {example.title}

{example.text}

![{example.figure}](../_static/gallery/{name}.png)

*{example.figure}* Known from: {example.known}

```
{printed}```

```{{literalinclude}} ../../examples/gallery/{name}.py
:language: python
:lines: {_first_line(name)}-
```
"""


def printed_on_pages() -> dict[str, str]:
    """What each example printed according to the pages."""
    printed = {}
    for theme, (_, group) in THEMES.items():
        text = (PAGES / f"{theme}.md").read_text(encoding="utf-8")
        for name in group:
            printed[name] = text.partition(f"({name})=\n")[2].partition("```\n")[2].partition("```")[0]
    return printed


def index() -> str:
    """The part of the start page that shows all examples."""
    parts = []
    for theme, (title, group) in THEMES.items():
        cards = "\n".join(
            f"- [![](../_static/gallery/{name}.png) {words(name).title}]({theme}.md#{name})" for name in group
        )
        parts.append(f"## {title}\n\n{{.cards}}\n{cards}\n")
    pages = "\n".join(THEMES)
    return f"{START}\n" + "\n".join(parts) + f"\n```{{toctree}}\n:hidden:\n\n{pages}\n```\n{END}"


def _sentence(text: str) -> str:
    flowing = " ".join(text.split())
    return flowing[:1].upper() + flowing[1:]


def _first_line(name: str) -> int:
    """Number of the first line after the docstring and the empty one below it."""
    tree = ast.parse((EXAMPLES / f"{name}.py").read_text(encoding="utf-8"))
    return (tree.body[0].end_lineno or 0) + 2


def _with_index(text: str) -> str:
    head, _, rest = text.partition(START)
    return head + index() + rest.partition(END)[2]


def _differs(path: Path, text: str, *, check: bool) -> bool:
    """Whether a page said something else; unless it is only checked, it is written."""
    if path.exists() and path.read_text(encoding="utf-8") == text:
        return False
    if not check:
        path.write_text(text, encoding="utf-8")
    print(f"{path.relative_to(DOCS)}: {'otherwise' if check else 'written anew'}")
    return True


def _draw(name: str, picture: bytes) -> None:
    write_fewer_colours(PICTURES / f"{name}.png", io.BytesIO(picture))


def main() -> int:
    """Number of pages that said something else."""
    parser = argparse.ArgumentParser(description="The gallery's pages and figures, made anew.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="such as one_series; all by default")
    parser.add_argument("--check", action="store_true", help="write nothing; the exit status tells how many differ")
    asked = parser.parse_args()
    start = PAGES / "index.md"
    stale = [_differs(start, _with_index(start.read_text(encoding="utf-8")), check=asked.check)]
    printed = printed_on_pages()
    for name in asked.names or names():
        example = ran(name)
        printed[name] = example.printed
        if not asked.check:
            _draw(name, example.picture)
    stale += [_differs(PAGES / f"{theme}.md", page(theme, printed), check=asked.check) for theme in THEMES]
    return sum(stale) if asked.check else 0


if __name__ == "__main__":
    sys.exit(main())
