"""Sphinx configuration: Markdown pages, API reference from docstrings, equations as MathML. Nothing is fetched."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx

_PROJECT = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8"))["project"]

project = "skisnow"
author = "The skisnow developers"
copyright = "The skisnow developers"
version = release = _PROJECT["version"]

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["_build"]

myst_enable_extensions = ["dollarmath", "colon_fence", "attrs_block", "attrs_inline"]
myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings say types, shapes and units in words
autodoc_class_signature = "separated"
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False

suppress_warnings = ["ref.python"]  # F and p are fields of several results: their names need no link

html_theme = "furo"
html_title = f"skisnow {release}"
html_static_path = ["_static"]
html_css_files = ["skisnow.css"]
html_copy_source = False
html_show_sourcelink = False
html_math_renderer = "mathml"


def _mathml(node: Any, *, block: bool) -> str:
    """Equations become MathML when the pages are built: browsers show it without a script or a network."""
    from docutils.utils.math.latex2mathml import tex2mathml

    return tex2mathml(node.astext(), as_block=block)


def _visit_inline(translator: Any, node: Any) -> None:
    from docutils.nodes import SkipNode

    translator.body.append(_mathml(node, block=False))
    raise SkipNode


def _visit_block(translator: Any, node: Any) -> None:
    from docutils.nodes import SkipNode

    translator.body.append(f'<div class="equation">{_mathml(node, block=True)}</div>\n')
    raise SkipNode


def _bars(_app: Sphinx, _what: str, _name: str, _object: Any, _options: Any, lines: list[str]) -> None:
    """Absolute values in docstrings, |t|, are bars and not the beginning of a substitution."""
    lines[:] = [line if "``" in line or ">>>" in line else line.replace("|", r"\|") for line in lines]


def setup(app: Sphinx) -> None:
    """Register the renderer of equations and the reader of bars."""
    app.connect("autodoc-process-docstring", _bars)
    app.add_html_math_renderer("mathml", (_visit_inline, None), (_visit_block, None))
