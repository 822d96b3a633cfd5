"""Quantities that dataclasses declare: what their fields say of them, checks in constructors, values there and back."""

import importlib
import math
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import jsonschema
import numpy as np
import pytest
from tests.coded import Coded, coded, raises

import skisnow
from skisnow._support.errors import ParameterError
from skisnow.parameters import Allowed, Quantity, Section, Word, build_declared, quantities, require_declared, values_of
from skisnow.parameters.json_schema import table_schema

tables: Any = importlib.import_module("quantity_tables")


@dataclass(frozen=True, kw_only=True)
class Snow:
    """Shared by several; its names have no section."""

    hardness: Annotated[float, Quantity("H_V_N_per_mm3", "hardness"), Allowed(0.0, above=True)]
    strength: Annotated[float | None, Quantity("S_f_N_per_mm2", "strength"), Allowed(0.0)]
    source: Annotated[str, Word("published", "name of a snow")] = "numbers"

    def __post_init__(self) -> None:
        require_declared(self)


@dataclass(frozen=True, kw_only=True)
class Bench:
    """Something that is held on snow."""

    snow: Annotated[Snow, Section("snow", otherwise=True)]
    law: Annotated[Literal["a", "b"], Quantity("bench.law", "which law")] = "a"
    step: Annotated[float, Quantity("bench.step_ms", "step"), Allowed(0.1, 5.0, origin="choice")] = 0.5e-3
    parts: Annotated[int | None, Quantity("bench.parts", "parts"), Allowed(4)] = None
    fixed: Annotated[bool, Quantity("bench.fixed", "whether fixed")] = False
    inertia: Annotated[tuple[float, float, float], Quantity("bench.inertia_kg_m2", "inertia"), Allowed(0.0, above=True)]
    centre: Annotated[
        tuple[float, float],
        Quantity("bench.height_mm", "height", lowest=0.0, highest=100.0, index=1),
        Quantity("bench.forward_mm", "forward", index=0, default=0.0),
    ]
    angle: Annotated[float, Quantity("snow.angle_deg", "angle"), Allowed(-85.0, 85.0)] = 0.0
    load_N: Annotated[float, Quantity("bench.load_N", "load")] = 1.0
    table: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        require_declared(self)


GIVEN = {
    "snow.H_V_N_per_mm3": 0.2,
    "bench.step_ms": 2.0,
    "bench.inertia_kg_m2": [1.0, 2.0, 3.0],
    "bench.height_mm": 50.0,
    "snow.angle_deg": 45.0,
    "bench.fixed": True,
}


def bench(**values: Any) -> Bench:
    snow = build_declared(Snow, GIVEN, section="snow", strength=None)
    return build_declared(Bench, GIVEN | {f"bench.{name}": value for name, value in values.items()}, snow=snow)


def test_fields_say_kind_choices_default_and_need() -> None:
    found = {key.name: (key.kind, key.choices, key.default, key.needed) for key in quantities(Bench)}
    assert found == {
        "snow.H_V_N_per_mm3": ("number", (), None, False),  # a word may stand for it
        "snow.S_f_N_per_mm2": ("number", (), None, False),
        "snow.published": ("text", (), None, False),
        "snow.angle_deg": ("number", (), 0.0, False),
        "bench.law": ("text", ("a", "b"), "a", False),
        "bench.step_ms": ("number", (), 0.5, False),
        "bench.parts": ("whole number", (), None, False),
        "bench.fixed": ("switch", (), False, False),
        "bench.inertia_kg_m2": ("three numbers", (), None, True),
        "bench.height_mm": ("number", (), None, True),
        "bench.forward_mm": ("number", (), 0.0, False),
        "bench.load_N": ("number", (), 1.0, False),
    }


def test_sections_stand_together_in_the_order_of_first_sight() -> None:
    assert [key.name.partition(".")[0] for key in quantities(Bench)] == ["snow"] * 4 + ["bench"] * 8


def test_values_as_given_become_si() -> None:
    found = bench()
    assert (found.snow.hardness, found.step, found.inertia, found.centre) == (2e8, 2e-3, (1.0, 2.0, 3.0), (0.0, 0.05))
    assert found.angle == pytest.approx(math.pi / 4.0, rel=1e-15)
    assert (found.law, found.parts, found.fixed, found.load_N) == ("a", None, True, 1.0)


def test_what_a_dataclass_holds_is_made_with_it() -> None:
    found = build_declared(Bench, GIVEN | {"snow.S_f_N_per_mm2": 0.5})
    assert found.snow == Snow(hardness=2e8, strength=5e5)


def test_values_are_reported_back_in_the_units_of_their_keys() -> None:
    told = values_of(bench(parts=8))
    assert told.pop("bench.inertia_kg_m2") == [1.0, 2.0, 3.0]
    given = {name: value for name, value in GIVEN.items() if name in told}
    assert {name: told[name] for name in given} == pytest.approx(given)
    assert (told["bench.parts"], told["bench.law"], told["snow.published"]) == (8, "a", None)
    assert {*told, "bench.inertia_kg_m2"} == {key.name for key in quantities(Bench)}


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"law": "c"}, coded("out_of_range", first="a", second="b", name="bench.law", value="'c'", allowed="a or b")),
        ({"law": " a"}, coded("out_of_range", first="a", second="b", name="bench.law", value="' a'", allowed="a or b")),
        ({"step": 1.0}, coded("out_of_range", low=0.1, high=5.0, name="bench.step_ms", value="1000.0", unit="ms")),
        ({"step": None}, coded("wrong_kind", name="bench.step_ms")),
        ({"step": True}, coded("wrong_kind", name="bench.step_ms")),
        ({"parts": 4.5}, coded("wrong_kind", name="bench.parts", value="4.5")),
        (
            {"parts": 3},
            coded("out_of_range", low=4, name="bench.parts", value="3.0", allowed="whole numbers 4 or more"),
        ),
        ({"fixed": 1}, coded("wrong_kind", name="bench.fixed", value="1")),
        ({"inertia": 3.0}, coded("wrong_kind", name="bench.inertia_kg_m2", value="3.0")),
        ({"load_N": [1.0]}, coded("wrong_kind", name="bench.load_N", value="[1.0]")),
        ({"inertia": (1.0, 2.0)}, "wrong_kind"),
        ({"inertia": (1.0, 0.0, 2.0)}, coded("out_of_range", low=0.0, allowed="three numbers, each above 0")),
        (
            {"centre": (0.0, 0.2)},
            coded("out_of_range", low=0.0, high=100.0, name="bench.height_mm", value="200.0", unit="mm"),
        ),
        ({"angle": math.nan}, coded("out_of_range", name="snow.angle_deg", value="nan")),
        (
            {"load_N": math.inf},
            coded("out_of_range", name="bench.load_N", value="inf", allowed="any finite number", unit="N"),
        ),
    ],
)
def test_constructor_rejects_what_a_file_could_not_give(changes: dict[str, object], told: str | Coded) -> None:
    with raises(ParameterError, told):
        replace(bench(), **changes)  # type: ignore[arg-type]


def test_numbers_of_numpy_and_ends_of_ranges_are_taken() -> None:
    changed = replace(bench(), parts=np.int64(8), step=np.float32(1e-3), angle=math.radians(85.0))  # type: ignore[arg-type]
    assert (changed.parts, changed.angle) == (8, math.radians(85.0))


def test_schema_rejects_what_the_constructor_rejects() -> None:
    schema = table_schema(key for key in quantities(Bench) if key.name.startswith("bench."))
    good = {"inertia_kg_m2": [1, 2, 3], "height_mm": 50}
    jsonschema.validate(good, schema)
    for bad in ({"law": "c"}, {"step_ms": 6}, {"parts": 3}, {"fixed": 1}, {"inertia_kg_m2": [1, 0, 3]}, {"lay": "a"}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(good | bad, schema)
    with pytest.raises(jsonschema.ValidationError, match="height_mm"):
        jsonschema.validate({"inertia_kg_m2": [1, 2, 3]}, schema)


def test_table_of_a_page() -> None:
    rows = tables.page_table(quantities(Bench)).splitlines()
    assert rows[7] == "| `bench.step_ms` | ms | from 0.1 to 5 | 0.5 | choice | step |"
    assert rows[4] == "| `snow.published` | | a text | none | | name of a snow |"


PACKAGE = Path(skisnow.__file__).parent
DOCS = Path(tables.__file__).parent
BEFORE = "    friction: Annotated[\n"
DECLARED = """    crust: Annotated[
        float,
        Quantity(
            "snow.crust_mm",
            "a length that is new",
            lowest=0.5,
            highest=20.0,
            origin="choice: to be tried",
        ),
    ] = 2e-3
"""
ASKED = """
from dataclasses import replace

from skisnow._support.errors import ParameterError
from quantity_tables import page_table
from skisnow.scenario import load_scenario, scenario_file, scenario_text
from skisnow.scenario.keys import free_key
from skisnow.scenario.keys import parse_change
from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.scenario.schema import scenario_schema, output_scenario_schema
from skisnow.studies.points import Axis

print(load_scenario("carved-46m", changes=dict([parse_change("crust_mm=4")])).contact.crust)
print(scenario_file("carved-46m").values["snow.crust_mm"])
contact = load_scenario("carved-46m").contact
for refused in (lambda: scenario_file("carved-46m", changes={"crust_mm": 40}), lambda: replace(contact, crust=0.04)):
    try:
        refused()
    except ParameterError as error:
        print(error)
print(scenario_schema()["properties"]["snow"]["properties"]["crust_mm"])
print(output_scenario_schema()["properties"]["snow"]["properties"]["crust_mm"]["type"])
print([line for line in page_table(SCENARIO_KEYS.values()).splitlines() if "crust" in line])
print([line for line in scenario_text("carved-46m").splitlines() if "crust" in line])
print(free_key("crust"))
print(Axis.of(SCENARIO_KEYS["snow.crust_mm"], {"from": 1, "to": 3, "n": 3}).on_grid())
"""


def test_a_new_key_is_one_declaration(tmp_path: Path) -> None:
    """In a copy of the package one file is changed; the second would be the one that uses the value."""
    copy = tmp_path / "skisnow"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("static", "web"))
    place = copy / "scenario" / "contact.py"
    text = place.read_text(encoding="utf-8")
    assert text.count(BEFORE) == 1
    place.write_text(text.replace(BEFORE, DECLARED + BEFORE), encoding="utf-8")
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join((str(tmp_path), str(DOCS))),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    done = subprocess.run(
        [sys.executable, "-c", ASKED], env=environment, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [
        "0.004",
        "2.0",
        "snow.crust_mm is 40; allowed is from 0.5 to 20 mm",
        "snow.crust_mm is 40.0; allowed is from 0.5 to 20 mm",
        "{'type': 'number', 'description': 'a length that is new (mm)', 'minimum': 0.5, 'maximum': 20.0, "
        "'default': 2.0}",
        "['number', 'null']",
        "['| `snow.crust_mm` | mm | from 0.5 to 20 | 2 | choice: to be tried | a length that is new |']",
        "['crust_mm = 2.0                          # default, choice: to be tried']",
        "snow.crust_mm",
        "[1.0, 2.0, 3.0]",
    ]
