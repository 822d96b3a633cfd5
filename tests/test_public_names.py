"""What `import skisnow` offers: names that are there, load late and stay callable."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

import skisnow

PACKAGE = Path(skisnow.__file__).parent

IMPORT_ALONE = """
import sys
from importlib.metadata import version
import skisnow
heavy = {"numpy", "scipy", "matplotlib", "pandas", "xarray", "skisnow.simulation", "skisnow.scenario"}
assert not heavy & set(sys.modules), heavy & set(sys.modules)
"""
FUNCTIONS = """
import skisnow.simulation.run, skisnow.scenario.slope, skisnow.carving.answer
from skisnow import carve, identify, load_scenario, simulate, study, turn
assert all(map(callable, (carve, identify, load_scenario, simulate, study, turn)))
import skisnow.carving, skisnow.pipeline
assert skisnow.carving.Equilibrium is skisnow.Equilibrium and skisnow.simulation.run.Run is skisnow.Run
"""


@pytest.mark.parametrize("lines", [IMPORT_ALONE, FUNCTIONS], ids=["alone", "functions"])
def test_functions_and_packages_have_different_names(lines: str) -> None:
    subprocess.run([sys.executable, "-c", lines], check=True)


def test_every_public_name_is_there() -> None:
    assert [name for name in skisnow.__all__ if not hasattr(skisnow, name)] == []
    assert skisnow.__all__ == sorted(set(skisnow.__all__))


def test_type_checkers_see_the_same_names() -> None:
    tree = ast.parse((PACKAGE / "__init__.py").read_text(encoding="utf-8"))
    (block,) = (node for node in tree.body if isinstance(node, ast.If))
    imports = [name for node in block.body if isinstance(node, ast.ImportFrom) for name in node.names]
    assert sorted(each.asname or each.name for each in imports) == skisnow.__all__
    assert [name for name in skisnow.__all__ if f"``{name}``" not in (skisnow.__doc__ or "")] == []


def test_errors_derive_from_one_class() -> None:
    errors = [getattr(skisnow, name) for name in skisnow.__all__ if name.endswith("Error")]
    assert len(errors) == 7
    assert all(issubclass(each, skisnow.SkisnowError) for each in errors)


def test_the_version_is_that_of_the_installed_package() -> None:
    assert skisnow.__version__ == version("skisnow")


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="simulat"):
        _ = skisnow.simulat


def test_modules_are_imported_by_name_in_few_places() -> None:
    """The public names are loaded when they are first used, optional packages where they are installed."""
    places = {
        path.relative_to(PACKAGE).as_posix()
        for path in PACKAGE.rglob("*.py")
        if re.search(r"\b(import_module|__import__)\(", path.read_text(encoding="utf-8"))
    }
    assert {place for place in places if not place.startswith("web/")} == {
        "__init__.py",
        "_support/environment.py",
    }
