"""Docstrings of every public name: the page of the Python interface is made from them."""

import ast
import importlib
import inspect
import re
from pathlib import Path
from typing import Any

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


def test_every_function_and_every_class_and_every_law() -> None:
    for name, function in FUNCTIONS.items():
        parts = sections(function)
        assert {"Returns", "See Also", "References"} <= set(parts), name
        listed = {each.strip() for line in re.findall(r"^(\w.*)$", parts.get("Parameters", ""), re.MULTILINE)
                  for each in line.split(" : ")[0].split(",")}  # fmt: skip
        assert set(inspect.signature(function).parameters) - listed == set(), name
    undocumented = [name for name, each in CLASSES.items() if "See Also" not in sections(each)]
    assert [name for name in undocumented if not issubclass(CLASSES[name], Exception)] == []
    headings = {"Attributes", "See Also", "Notes", "References", "Examples"}
    assert [law.__name__ for law in LAWS if not headings <= set(sections(law))] == []


def test_what_is_named_beside_it_exists() -> None:
    """A name moved or misspelt would be a dead end."""
    for documented in (*PUBLIC.values(), *LAWS):
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
