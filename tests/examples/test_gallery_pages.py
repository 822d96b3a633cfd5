"""The gallery has all examples; they are short and use public names."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

import skisnow

from .gallery import builder

PUBLIC_PACKAGES = ("skisnow.forces", "skisnow.geometry", "skisnow.identification")
"""Packages whose names docs/api.md shows beside those of `skisnow`."""
NAMES = tuple(builder().names())


def test_every_script_has_its_place() -> None:
    assert sorted(NAMES) == sorted(path.stem for path in builder().EXAMPLES.glob("*.py"))
    assert len(set(NAMES)) == len(NAMES) == 16
    assert sorted(NAMES) == sorted(path.stem for path in builder().PRINTED.iterdir())


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


def test_the_build_writes_a_card_and_a_section_for_each(tmp_path: Path) -> None:
    builder().write_pages(tmp_path)
    cards, sections = ((tmp_path / f"{name}.md").read_text(encoding="utf-8") for name in ("cards", "examples"))
    assert [cards.count(f"(#{name})") for name in NAMES] == [1] * len(NAMES)
    assert [sections.count(f"({name})=") for name in NAMES] == [1] * len(NAMES)
    assert all(builder().printed(name) in sections for name in NAMES)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_page_prints_what_the_script_prints(name: str) -> None:
    """After a change of the physics: python docs/write_gallery.py."""
    assert builder().printed(name) == builder().ran(name).printed
