"""Pages of the gallery are up to date; its examples are short and use public names."""

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
    assert all((builder().PAGES / f"{theme}.md").exists() for theme in builder().THEMES)


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
def test_every_example_is_described(name: str) -> None:
    example = builder().words(name)
    assert example.title and example.text and example.figure and example.known
    assert (builder().PICTURES / f"{name}.png").exists()


@pytest.mark.parametrize("theme", builder().THEMES)
def test_page_is_up_to_date(theme: str) -> None:
    """All but what the examples print, which the slow test below compares."""
    page = (builder().PAGES / f"{theme}.md").read_text(encoding="utf-8")
    assert page == builder().page(theme, builder().printed_on_pages())


def test_start_page_shows_them_all() -> None:
    text = (builder().PAGES / "index.md").read_text(encoding="utf-8")
    assert builder().index() in text


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_page_prints_what_the_script_prints(name: str) -> None:
    """After a change of the physics: python docs/write_gallery.py."""
    assert builder().printed_on_pages()[name] == builder().ran(name).printed
