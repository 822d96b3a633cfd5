"""What `import skisnow` offers: names that are there, load late and stay callable."""

from __future__ import annotations

import ast
import inspect
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import skisnow
from skisnow.carve.equilibrium import carve
from skisnow.identify.identifying import identify
from skisnow.scenario import read_scenario
from skisnow.simulate.simulated_run import simulate
from skisnow.study import run_study

PACKAGE = Path(skisnow.__file__).parent

IMPORT_ALONE = """
import sys
import skisnow
heavy = {"numpy", "scipy", "matplotlib", "pandas", "xarray", "skisnow.compiled", "skisnow.simulate", "skisnow.scenario"}
assert not heavy & set(sys.modules), heavy & set(sys.modules)
"""
NAME_FIRST = """
import skisnow
for name in ("simulate", "scenario", "carve", "identify", "study", "chain"):
    assert callable(getattr(skisnow, name)), name
import skisnow.simulate.run, skisnow.scenario.slope, skisnow.carve.answer
import skisnow.identify.data, skisnow.study.axes, skisnow.chain.ensemble
for name in ("simulate", "scenario", "carve", "identify", "study", "chain"):
    assert callable(getattr(skisnow, name)), name
assert skisnow.simulate.run.Run is skisnow.Run
"""
PACKAGE_FIRST = """
import skisnow.simulate.run, skisnow.scenario.slope, skisnow.carve.answer
import skisnow.identify.data, skisnow.study.axes, skisnow.chain.ensemble
from skisnow import carve, chain, identify, scenario, simulate, study
assert all(map(callable, (carve, chain, identify, scenario, simulate, study)))
import skisnow
assert skisnow.simulate is simulate and skisnow.simulate.run.Run is skisnow.Run
"""


@pytest.mark.parametrize("lines", [IMPORT_ALONE, NAME_FIRST, PACKAGE_FIRST], ids=["alone", "name", "package"])
def test_names_in_either_order_of_imports(lines: str) -> None:
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


def test_a_room_that_is_a_verb_is_its_function() -> None:
    for package, function in (
        (skisnow.simulate, simulate),
        (skisnow.scenario, read_scenario),
        (skisnow.carve, carve),
        (skisnow.identify, identify),
        (skisnow.study, run_study),
    ):
        assert inspect.signature(package) == inspect.signature(function)
    with pytest.raises(TypeError, match="scenario"):
        skisnow.simulate()  # type: ignore[call-arg]


def test_former_names_stay_and_say_what_they_are_called_now() -> None:
    with pytest.warns(DeprecationWarning, match=r"skisnow\.simulated_run is called skisnow\.simulate now"):
        assert skisnow.simulated_run is skisnow.simulate
    with pytest.warns(DeprecationWarning, match=r"skisnow\.read_scenario is called skisnow\.scenario now"):
        assert skisnow.read_scenario is skisnow.scenario


@pytest.mark.parametrize(
    ("former", "now", "name"),
    [("simulate.scenario", "scenario", "Plane"), ("web.replay", "replay", "write_replay")],
)
def test_a_room_that_moved_is_found_where_it_was_with_a_warning(former: str, now: str, name: str) -> None:
    with pytest.warns(DeprecationWarning, match=rf"skisnow\.{former}\.{name} is called skisnow\.{now}\.{name} now"):
        assert getattr(import_module(f"skisnow.{former}"), name) is getattr(import_module(f"skisnow.{now}"), name)
    with pytest.raises(AttributeError, match=rf"module 'skisnow\.{former}' has no attribute 'Plain'"):
        _ = import_module(f"skisnow.{former}").Plain


@pytest.mark.parametrize(
    ("module", "former", "now"),
    [
        ("simulate.simulated_run", "simulated_run", "simulate"),
        ("simulate.verification", "verified", "verify"),
        ("track.comparison", "compared", "compare_tracks"),
    ],
)
def test_a_former_function_is_the_present_one_with_a_warning(module: str, former: str, now: str) -> None:
    names = vars(import_module(f"skisnow.{module}"))
    assert inspect.signature(names[former]) == inspect.signature(names[now])
    with pytest.warns(DeprecationWarning, match=f"{former} is called {now} now"), pytest.raises(TypeError):
        names[former]()


@pytest.mark.parametrize(
    ("package", "former", "now"),
    [
        ("field", "MARKS", "QUALITY_FLAGS"),
        ("field", "Mark", "QualityFlag"),
        ("field", "mark_problems", "flag_problems"),
        ("field.store", "KeptTable", "StoredTable"),
        ("field.store", "grown", "replayed"),
        ("field.store", "kept_tables", "stored_tables"),
        ("estimate", "marks_of", "quality_flags"),
        ("estimate", "remarks", "campaign_notes"),
    ],
)
def test_a_renamed_part_of_a_package_is_found_with_a_warning(package: str, former: str, now: str) -> None:
    package = f"skisnow.{package}"
    with pytest.warns(DeprecationWarning, match=rf"{package}\.{former} is called {package}\.{now} now") as caught:
        assert getattr(import_module(package), former) is getattr(import_module(package), now)
    assert caught[0].filename == __file__
    with pytest.raises(AttributeError, match=rf"module '{package}' has no attribute 'Plain'"):
        _ = import_module(package).Plain


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
        "callable_packages.py",
        "optional_packages.py",
    }
