"""Public names, and unknown names with proposals."""

import ast
import importlib
import inspect
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import skisnow
from skisnow import Course, Gate, Profile, SnowField, carve, check_campaign, load_scenario, read_ski, run_batch
from skisnow._support.errors import ParameterError, SkisnowError
from skisnow.geometry import SkiPiece, in_form
from skisnow.interop.opensim import BootMarkers, Markers, boots_of_markers
from skisnow.racing import compare_variants
from skisnow.scenario import Boots, Solver, scenario_values
from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.scenario.reading import build_input, load_input
from skisnow.scenario.resolution import CONDITIONS, ContradictionError
from skisnow.scenario.skier import Skier
from skisnow.scenario.sledge import Shear
from skisnow.ski.editing import SkiEdit, edit_stations
from tests.fuzzing.reader import Reader
from tests.fuzzing.registry import BY_NAME

TURN = load_scenario("carved-46m")
SKI, SNOW = read_ski("slalom"), skisnow.load_snow("race-piste")
MARKED = BootMarkers("heel", "toe", "left")
MARKERS = Markers(time=np.arange(4.0), names=("heel", "toe", "left"), place=np.zeros((4, 3, 3)), rate=100.0)
FREE_NAME = '"first"'
"""A name of the user."""


def misspelt(name: str) -> str:
    """One letter too many."""
    return name[:1] + name


@pytest.mark.parametrize("name", [name for name, reader in BY_NAME.items() if reader.target.endswith(".toml")])
def test_misspelt_key_of_a_toml_file(name: str, tmp_path: Path) -> None:
    reader = BY_NAME[name]
    lines = reader.files()[reader.target].decode().splitlines()
    for number, line in enumerate(lines):
        if re.match(r"\s*(\w+\s*=|\[)", line) and FREE_NAME not in line:
            (key,) = re.findall(r"^\s*(\w+)\s*=", line) or re.findall(r"(\w+)\"?\]+$", line)
            wrong = [*lines[:number], line.replace(key, misspelt(key), 1), *lines[number + 1 :]]
            reader.lay(tmp_path, "\n".join(wrong).encode())
            assert key in rejection(reader, tmp_path).replace(misspelt(key), "")


def rejection(reader: Reader, folder: Path) -> str:
    if reader.target.endswith("campaign.toml"):
        return "\n".join(map(str, check_campaign((folder / reader.target).parent)))
    with pytest.raises(SkisnowError) as caught:
        reader.read(folder)
    return str(caught.value)


def test_misspelt_key_of_a_scenario() -> None:
    for key in SCENARIO_KEYS:
        section, _, name = key.partition(".")
        matches = rf"\b{re.escape(name)}\b"
        with pytest.raises(ParameterError, match=matches):
            TURN.with_(**{misspelt(name): 1.0})
        for word in (f"{section}.{misspelt(name)}", misspelt(name)):
            with pytest.raises(ParameterError, match=matches):
                load_scenario("carved-46m", changes={word: 1.0})


def public_names() -> Iterator[tuple[str, Any]]:
    for name in skisnow.__all__:
        thing = getattr(skisnow, name)
        if inspect.isclass(thing) and not issubclass(thing, BaseException):
            yield from ((f"{name}.{each}", getattr(thing, each)) for each in dir(thing) if not each.startswith("_"))
        if not (inspect.isclass(thing) and issubclass(thing, BaseException)):
            yield name, thing


def test_no_public_callable_takes_any_keyword() -> None:
    """Of `Scenario.with_` the test above; all others have named parameters, so that Python rejects unknown ones."""
    catch_all = {
        name
        for name, thing in public_names()
        if callable(thing)
        and any(each.kind is each.VAR_KEYWORD for each in inspect.signature(thing).parameters.values())
    }
    assert catch_all == {"Scenario.with_"}


CHOICES: dict[str, tuple[Callable[[], object], str]] = {
    "in_form": (lambda: in_form(SkiPiece(0.1, 0.06), "extendet"), "extended"),  # type: ignore[arg-type]
    "method": (lambda: Solver(method="fastt"), "fast"),  # type: ignore[arg-type]
    "acts_on": (lambda: SnowField(2e8, 3e5, 10.0, friction_acts_on="snow-norml"), "snow-normal"),  # type: ignore[arg-type]
    "gap": (lambda: Profile(np.arange(4.0), -np.arange(4.0), gap="eror"), "error"),  # type: ignore[arg-type]
    "groove": (lambda: carved(groove="edg"), "edge"),
    "spread": (lambda: carved(side_force_spread="dept"), "depth"),
    "balance": (lambda: carved(moment_balance="bot"), "boot"),
    "side": (lambda: Gate(name="1", turning=(0.0, 0.0), side="lefft"), "left"),  # type: ignore[arg-type]
    "axes": (lambda: Course(gates=gates(), axes="metre"), "metres"),  # type: ignore[arg-type]
    "frame": (lambda: still(frame="slop"), "slope"),
    "over": (lambda: still(over="tim"), "time"),
    "up": (lambda: boots_of_markers(MARKERS, MARKED, MARKED, up="yy"), "y"),  # type: ignore[arg-type]
    "model": (lambda: skisnow.race(TURN, model="skierr"), "skier"),  # type: ignore[arg-type]
    "compared": (lambda: compare_variants(TURN, {"a": TURN}, None, [SNOW], model="poin"), "point"),  # type: ignore[arg-type]
    "executor": (lambda: run_batch([1], str, executor="thread"), "threads"),  # type: ignore[arg-type]
    "factors": (lambda: SkiEdit(edit_stations(SKI), {"sidecut": 1.1}), "sidecut_depth"),
    "values": (lambda: SkiEdit(edit_stations(SKI), values={"widht_mm": edit_stations(SKI)}), "width_mm"),
    "part": (lambda: TURN.with_(contct=TURN.contact), "contact"),
    "ski": (lambda: TURN.with_(ski="slalmo"), "slalom"),
    "snow": (lambda: TURN.with_(snow="race-pist"), "race-piste"),
    "scenario": (lambda: load_scenario("carved-46"), "carved-46m"),
}


def carved(**choice: Any) -> object:
    return carve(SKI, SNOW, edge_angle=0.7, load=400.0, unloading_ratio=10.0, **choice)


def gates() -> tuple[Gate, ...]:
    return tuple(Gate(name=str(n), turning=(10.0 * n, 0.0), side="left") for n in range(4))


def still(**choice: Any) -> Boots:
    return Boots(np.arange(4.0), np.zeros((4, 2, 3)), np.tile(np.eye(3), (4, 2, 1, 1)), **choice)


@pytest.mark.parametrize(("call", "nearest"), CHOICES.values(), ids=CHOICES)
def test_misspelt_choice(call: Callable[[], object], nearest: str) -> None:
    with pytest.raises(ParameterError, match=rf"\b{re.escape(nearest)}\b"):
        call()


WITHOUT_EFFECT: dict[str, tuple[str, str | float]] = {
    "shear.law": ("carved-46m", "constant"),
    "skier.steers": ("slalom-20-gates", "gates"),
    "snow.delayed_share": ("carved-46m", 0.0),
    "shear.residual_ratio": ("carved-46m", 1.0),
}
"""Scenario and value of each key that can leave others without effect."""


@pytest.mark.parametrize("key", [key for key, needed in CONDITIONS.items() if needed.key != "slope.kind"])
def test_key_without_effect(key: str) -> None:
    """A key that another one leaves without effect is rejected, unless a later change did that."""
    main, needed = CONDITIONS[key].key, CONDITIONS[key]
    base, other = WITHOUT_EFFECT[main]
    value = 0.5 if needed.differs else needed.value
    other = "turns" if value == "gates" else other
    quantity = SCENARIO_KEYS[key]
    given = not quantity.default if quantity.kind == "switch" else max(quantity.lowest or 0.0, 0.0) + 0.05
    with pytest.raises(ContradictionError) as caught:
        load_scenario(base, changes={key: given, main: other})
    assert caught.value.keys == (key, main)
    with pytest.raises(ContradictionError) as caught:
        load_scenario(base, changes={main: other}).with_(**{key.partition(".")[2]: given})
    assert caught.value.keys == (key, main)
    density = {"shear.snow_density_kg_per_m3": 300.0} if value == "by-density" else {}
    found = load_scenario(base, changes={**density, key: density.get(key, given), main: value})
    changed = found.with_(**{main.partition(".")[2]: other})
    assert scenario_values(changed)[key] == quantity.default
    assert scenario_values(build_input(load_input(found).changed({main: other})).scenario)[key] == quantity.default


@pytest.mark.parametrize(
    "call",
    [
        lambda: Shear(transverse_friction=0.3),
        lambda: Shear(law="by-angle", snow_density=300.0),
        lambda: Shear(slip_weakening=5e-3),
        lambda: replace(TURN.contact, retardation_time=0.5),
        lambda: TURN.with_(solver=Solver(delayed_spacing=2e-3)),
        lambda: Skier(steers="gates", turns=3),
    ],
)
def test_value_without_effect_in_a_constructor(call: Callable[[], object]) -> None:
    with pytest.raises(ParameterError) as caught:
        call()
    assert caught.value.code == "contradiction"


PACKAGE = Path(skisnow.__file__).parent

IMPORT_ALONE = """
import sys
from importlib.metadata import version
import skisnow
heavy = {"numpy", "scipy", "matplotlib", "pandas", "xarray", "skisnow.simulation", "skisnow.scenario"}
assert not heavy & set(sys.modules), heavy & set(sys.modules)
import skisnow.report.campaign.summary
assert not {"matplotlib", "jinja2"} & set(sys.modules)
import skisnow.replay
assert not {"nicegui", "fastapi", "starlette"} & set(sys.modules)
"""


def test_modules_do_not_import_what_they_do_not_need() -> None:
    """The summary does not wait for the drawing library; replay.html is written without the extra for the web."""
    assert subprocess.run([sys.executable, "-c", IMPORT_ALONE], check=False).returncode == 0


@pytest.mark.parametrize("name", ["carving.answer", "identification", "pipeline", "scenario.slope", "simulation.run"])
def test_functions_and_packages_have_different_names(name: str) -> None:
    importlib.import_module(f"skisnow.{name}")
    functions = ("carve", "identify", "load_scenario", "simulate", "study", "turn")
    assert all(callable(getattr(skisnow, function)) for function in functions)
    assert isinstance(getattr(skisnow, name.partition(".")[0]), ModuleType)


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
    assert {place for place in places if not place.startswith("web/")} == {"__init__.py", "_support/environment.py"}
