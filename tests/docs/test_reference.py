"""Docstrings of every public name: the page of the Python interface is made from them."""

import ast
import importlib
import inspect
import re
from pathlib import Path
from typing import Any

import pytest

import skisnow
from skisnow.forces import friction, penetration, shear

LAWS = (*penetration.LAWS, *penetration.POINT_LAWS, *shear.LAWS, *friction.LAWS)


def public_name(name: str) -> Any:
    """The object itself, also where the name is a callable package: the imports for type checkers say where."""
    for node in ast.walk(ast.parse(inspect.getsource(skisnow))):
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            for each in node.names:
                if (each.asname or each.name) == name:
                    return getattr(importlib.import_module(f"skisnow.{node.module}"), each.name)
    return getattr(skisnow, name)


PUBLIC = {name: public_name(name) for name in skisnow.__all__}
FUNCTIONS = {name: each for name, each in PUBLIC.items() if not inspect.isclass(each)}
CLASSES = {name: each for name, each in PUBLIC.items() if inspect.isclass(each)}
DOI = re.compile(r"\bdoi 10\.\d{4,9}/\S+")


def sections(documented: Any) -> dict[str, str]:
    """Headings of a docstring with the text below each."""
    text = inspect.getdoc(documented) or ""
    parts = re.split(r"^(\w[\w ]*)\n-{3,}\n", text, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def parameters(function: Any) -> set[str]:
    """Names that a caller may give."""
    return set(inspect.signature(function).parameters)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function(name: str) -> None:
    function = FUNCTIONS[name]
    told = sections(function)
    assert {"Returns", "See Also", "References"} <= set(told)
    asked = parameters(function)
    listed = {each.strip() for line in re.findall(r"^(\w.*)$", told.get("Parameters", ""), re.MULTILINE)
              for each in line.split(" : ")[0].split(",")}  # fmt: skip
    assert asked <= listed, asked - listed


@pytest.mark.parametrize("name", CLASSES)
def test_every_class(name: str) -> None:
    assert "See Also" in sections(CLASSES[name]) or issubclass(CLASSES[name], Exception)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
def test_every_law(law: Any) -> None:
    assert {"Attributes", "See Also", "Notes", "References", "Examples"} <= set(sections(law))


@pytest.mark.parametrize("documented", [*PUBLIC.values(), *LAWS], ids=[*PUBLIC, *(law.__name__ for law in LAWS)])
def test_what_is_named_beside_it_exists(documented: Any) -> None:
    """A name moved or misspelt would be a dead end."""
    for line in sections(documented).get("See Also", "").strip().splitlines():
        module, _, rest = line.split(" : ")[0].strip().removeprefix("skisnow.").rpartition(".")
        place: Any = skisnow
        for part in [*filter(None, module.split(".")), rest]:
            assert hasattr(place, part), line
            place = getattr(place, part)


def test_references_of_publications_have_their_doi() -> None:
    """Where there is one: books, proceedings and the paper of 2013 itself have none that we know."""
    without = ("J. Glaciol", "ASTM STP", "Beams on Elastic Foundation", "MATLAB", "The page docs/")
    for documented in (*PUBLIC.values(), *LAWS):
        for entry in re.split(r"^\* ", sections(documented).get("References", ""), flags=re.MULTILINE):
            if entry.strip() and not any(word in entry for word in without):
                assert DOI.search(" ".join(entry.split())), entry


def test_pages_that_are_referred_to_exist() -> None:
    root = Path(__file__).resolve().parents[2]
    for documented in (*PUBLIC.values(), *LAWS):
        for page in re.findall(r"docs/[\w/-]+\.md", inspect.getdoc(documented) or ""):
            assert (root / page).exists(), page
