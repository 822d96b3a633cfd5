"""Sphinx configuration: Markdown pages, API reference from docstrings, equations as MathML. Nothing is fetched."""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parent))
from api_reference import write_reference
from benchmarks.constants.page import write_page as write_constants
from key_tables import write_schemas, write_tables
from write_gallery import write_pages as write_gallery

_PROJECT = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8"))["project"]

project = "skisnow"
author = "The skisnow developers"
copyright = "The skisnow developers"
version = release = _PROJECT["version"]

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["_build", "_generated"]

myst_enable_extensions = ["dollarmath", "colon_fence", "attrs_block", "attrs_inline"]
myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_typehints = "description"  # beside what the docstrings say of shapes and units
autodoc_typehints_description_target = "documented"
autodoc_typehints_format = "short"
autodoc_class_signature = "separated"
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False

suppress_warnings = ["ref.python"]  # F and p are fields of several results: their names need no link

highlight_language = "text"  # what is no program is not coloured as one
html_theme = "furo"
html_title = f"skisnow {release}"
html_static_path = ["_static"]
html_extra_path = ["_generated/extra"]
html_css_files = ["skisnow.css"]
html_js_files = ["skisnow.js"]
html_copy_source = False
html_show_sourcelink = False
html_math_renderer = "mathml"


def mathml(equation: str, *, block: bool) -> str:
    """Equations become MathML when the pages are built: browsers show it without a script or a network.

    Raises math_core.LatexError at a command that it does not know.
    """
    from math_core import LatexToMathML

    return str(LatexToMathML(fancy_error=False).convert_with_local_state(equation, displaystyle=block))


def _visit(translator: Any, node: Any, form: str, *, block: bool) -> None:
    from docutils.nodes import SkipNode
    from math_core import LatexError
    from sphinx.util.logging import getLogger

    try:
        translator.body.append(form.format(mathml(node.astext(), block=block)))
    except LatexError as error:
        getLogger(__name__).warning("%s in the equation %s", error, node.astext(), location=node)
    raise SkipNode


def _visit_inline(translator: Any, node: Any) -> None:
    _visit(translator, node, "{}", block=False)


def _visit_block(translator: Any, node: Any) -> None:
    _visit(translator, node, '<div class="equation">{}</div>\n', block=True)


def _bars(_app: Sphinx, _what: str, _name: str, _object: Any, _options: Any, lines: list[str]) -> None:
    """Absolute values in docstrings, |t|, are bars and not the beginning of a substitution."""
    lines[:] = [line if "``" in line or ">>>" in line else line.replace("|", r"\|") for line in lines]


def _levels(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: object) -> None:  # noqa: ARG001
    """Say which level of heading the captions of lists of pages have, and let wide tables be scrolled by keyboard."""
    for part in ("body", "furo_navigation_tree"):
        if isinstance(context.get(part), str):
            found = context[part].replace('role="heading"', 'role="heading" aria-level="2"')
            context[part] = found.replace('<div class="table-wrapper', '<div tabindex="0" class="table-wrapper')


def _align_numbers(_app: Sphinx, doctree: Any) -> None:
    """Columns of CSV tables whose cells begin with digits are on the right."""
    from docutils import nodes

    for table in doctree.findall(
        lambda node: isinstance(node, nodes.table) and "colwidths-auto" not in node["classes"]
    ):
        rows = [row.children for row in table.findall(nodes.row)]
        for column in zip(*rows, strict=False):
            cells = [cell.astext() for cell in column[1:]]
            if any(cells) and all(re.match(r"[-+−]?\d", cell) for cell in cells if cell):
                for cell in column:
                    cell["classes"].append("text-right")


_ITEM = re.compile(r"([a-z]\w*(?:, [a-z]\w*)*|Returns|(?:Raises|Warns) \w+(?:, \w+)*): (.+)")


def _short_sections(_app: Sphinx, _what: str, _name: str, _obj: object, _options: object, lines: list[str]) -> None:
    """Show each line such as ``path: the file.`` of a docstring as a term with its text."""
    shown = []
    for paragraph in "\n".join(lines).split("\n\n"):
        items = [(line, None if line.startswith(" ") else _ITEM.fullmatch(line)) for line in paragraph.split("\n")]
        is_list = items[0][1] and all(match or not line or line.startswith("    ") for line, match in items)
        shown.append(
            "\n".join(f"{match[1]}\n    {match[2]}" if match else line for line, match in items)
            if is_list
            else paragraph
        )
    # several names of one field, which Sphinx would take for a type and a name
    fields = re.compile(r"^:(?:ivar|param) \w+(?:, \w+)+:", re.MULTILINE)
    lines[:] = fields.sub(lambda match: match[0].replace(", ", ","), "\n\n".join(shown)).split("\n")


def setup(app: Sphinx) -> None:
    """Write tables of keys, schemas and the gallery; register what reads and renders parts of pages."""
    write_tables()
    write_schemas()
    write_gallery()
    write_reference()
    write_constants()
    app.connect("autodoc-process-docstring", _bars)
    app.connect("autodoc-process-docstring", _short_sections)
    app.connect("doctree-read", _align_numbers)
    app.connect("html-page-context", _levels, priority=900)  # behind the theme's own
    app.add_html_math_renderer("mathml", (_visit_inline, None), (_visit_block, None))
