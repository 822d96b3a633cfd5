"""The gallery's pages say what its examples say; the examples are short and use public names."""

from __future__ import annotations

import ast
import re

import pytest

import skisnow

from .gallery import builder

PUBLIC_PACKAGES = ("skisnow.forces", "skisnow.geometry", "skisnow.identification")
"""Packages whose names docs/api.md shows beside those of `skisnow`."""
NAMES = tuple(builder().names())


def test_every_script_has_its_place() -> None:
    assert sorted(NAMES) == sorted(path.stem for path in builder().EXAMPLES.glob("*.py"))
    assert len(set(NAMES)) == len(NAMES) == 16
    assert sorted(NAMES) == sorted(
        path.stem for path in builder().PAGES.glob("*.md") if path.stem not in {"index"} and "-" not in path.stem
    )


@pytest.mark.parametrize("name", NAMES)
def test_short_and_of_public_names(name: str) -> None:
    source = (builder().EXAMPLES / f"{name}.py").read_text(encoding="utf-8")
    assert len(source.splitlines()) < 60
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("skisnow"):
            assert (node.module or "").startswith(PUBLIC_PACKAGES)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "skisnow":
            assert node.attr in skisnow.__all__
    assert not re.search(r"skisnow\S*\._", source)


@pytest.mark.parametrize("name", NAMES)
def test_page_says_what_the_script_says(name: str) -> None:
    """All but what it prints, which the slow test below holds."""
    said = builder().words(name)
    assert said.title and said.text and said.figure and said.known
    page = (builder().PAGES / f"{name}.md").read_text(encoding="utf-8")
    printed = page.partition("```\n")[2].partition("```")[0]
    assert page == builder().page(name, printed)
    assert (builder().PICTURES / f"{name}.png").exists()


def test_start_page_shows_them_all() -> None:
    text = (builder().PAGES / "index.md").read_text(encoding="utf-8")
    assert builder().index() in text


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_page_prints_what_the_script_prints(name: str) -> None:
    """After a change of the physics: python docs/write_gallery.py."""
    page = (builder().PAGES / f"{name}.md").read_text(encoding="utf-8")
    assert page == builder().page(name, builder().ran(name).printed)
