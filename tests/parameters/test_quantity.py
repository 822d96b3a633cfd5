"""One quantity: what it allows in words and in numbers, lists, labels, a table of a file."""

import importlib
import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
import pytest
from tests.coded import coded, raises

from skisnow._support.errors import ParameterError
from skisnow._support.units import unit_of_name, without_unit
from skisnow.parameters import Allowed, Quantity, Search, build_declared, checked_table, own_quantities
from skisnow.parameters.json_schema import output_schema, schema_of, schema_text

ANGLE = Quantity("edge_angle_deg", "edge angle", lowest=0.0, highest=90.0, below=True)
LOAD = Quantity("load_N", "load", lowest=0.0, above=True)
STEPS = Quantity("load_steps_N", "discs", lowest=0.0, above=True, kind="numbers")


@dataclass(frozen=True)
class Range:
    """Ends in the unit of some key."""

    first: Annotated[float, Quantity("from", "its begin")]
    n: Annotated[int | None, Quantity("n", "how many"), Allowed(2)] = None


@pytest.mark.parametrize(
    ("quantity", "inside", "outside", "words"),
    [
        (ANGLE, (0.0, 89.999), (-1e-9, 90.0), "from 0 to below 90"),
        (LOAD, (1e-99, 1e99), (0.0, -1.0), "above 0"),
        (Quantity("T_C", "temperature"), (-1e99, 0.0), (math.inf, math.nan), "any finite number"),
        (Quantity("k", "ratio", lowest=1.0, infinite=True), (1.0, math.inf), (0.99, -math.inf), "1 or more"),
        (Quantity("m", "mass", lowest=0.0, highest=5.0, above=True), (5.0, 1e-3), (0.0, 5.1), "above 0 to 5"),
    ],
)
def test_range_in_words(quantity: Quantity, inside: tuple[float, ...], outside: tuple[float, ...], words: str) -> None:
    assert quantity.allowed == words
    assert [quantity.in_range(value) for value in inside] == list(inside)
    for value in outside:
        with pytest.raises(ParameterError, match=f"; allowed is {words}"):
            quantity.in_range(value)


def test_an_array_is_judged_like_its_numbers() -> None:
    values = np.array([-1.0, 0.0, 45.0, 90.0, np.nan])
    assert ANGLE.outside(values).tolist() == [True, False, False, True, False]
    assert LOAD.outside(np.array([0.0, 1.0])).tolist() == [True, False]


def test_a_list_names_the_place_of_what_is_wrong() -> None:
    assert STEPS.in_range([50, 100]) == (50.0, 100.0)
    with raises(
        ParameterError, "out_of_range", low=0.0, name="load_steps_N[2]", value="0", allowed="above 0", unit="N"
    ):
        STEPS.in_range([50, 0])
    with raises(ParameterError, "wrong_kind", name="load_steps_N[1]", value="'a'"):
        STEPS.in_range(["a"])
    nothing: tuple[object, ...] = ([], 50)
    for none in nothing:
        with raises(ParameterError, "wrong_kind"):
            STEPS.in_range(none)


@pytest.mark.parametrize("size", [1e-101, 1e101, 10**400])
def test_sizes_that_cannot_be_squared_are_no_quantities(size: float) -> None:
    with pytest.raises(ParameterError, match=r"not a quantity|above 0"):
        LOAD.in_range(size)


def test_unit_of_a_name() -> None:
    assert unit_of_name("EI_N_m2[3]").symbol == "N m²"
    assert (unit_of_name("m").symbol, unit_of_name("frames").symbol) == ("", "")
    assert without_unit("mass_per_length_kg_per_m") == "mass_per_length"


def test_label_of_an_axis() -> None:
    assert Quantity("H_V_N_per_mm3", "", label="snow hardness", symbol="$H_V$").axis_label == (
        "snow hardness $H_V$ (N/mm³)"
    )
    assert Quantity("k", "", symbol="$k_u/H_V$").axis_label == "$k_u/H_V$"
    assert Quantity("twist", "").axis_label == "twist"


def test_a_table_is_checked_and_made() -> None:
    assert build_declared(Range, checked_table(Range, {"from": 20, "n": 11}, "[grid]")) == Range(20.0, 11)
    for table, expected in (
        ({"from": 1, "till": 2}, coded("unknown_name", place="[grid]", name="till", allowed="Allowed: from, n.")),
        ({"form": 1}, coded("unknown_name", place="[grid]", name="form", similar="from")),
        ({"n": 2}, coded("missing", place="[grid]", name="from")),
        ({"from": 1, "n": 1}, coded("out_of_range", place="[grid]", name="n", value="1", low=2)),
        ({"from": "1"}, coded("wrong_kind", place="[grid]", name="from", value="'1'")),
    ):
        with raises(ParameterError, expected):
            checked_table(Range, table, "[grid]")


def test_search_in_a_table_of_a_page() -> None:
    searches = (
        Search(3.0, 0.002, 1000.0, logarithmic=True),
        Search(10.0, -15.0, 15.0, about=True),
        Search(10.0, -5.0, 15.0, about=True),
        Search(0.5, -1.0, 1.0),
        None,
    )
    tables = importlib.import_module("quantity_tables")
    rows = tables.page_table([Quantity("x_m", "", search=each) for each in searches], ("key", "usual size", "bounds"))
    assert rows.splitlines()[2:] == [
        "| `x_m` | factor e^3 | 0.002 to 1000 |",
        "| `x_m` | 10 m | the start ± 15 |",
        "| `x_m` | 10 m | the start and -5 to 15 |",
        "| `x_m` | 0.5 m | -1 to 1 |",
        "| `x_m` | | |",
    ]


def test_schema_of_what_is_written_allows_null_where_nothing_may_be_in_force() -> None:
    first, n = (schema_of(each) for each in own_quantities(Range))
    assert output_schema(own_quantities(Range))["properties"] == {
        "from": first,
        "n": {**n, "type": ["integer", "null"]},
    }
    told = output_schema(own_quantities(Range), every_null=True)
    assert (told["additionalProperties"], told["required"]) == (False, ["from", "n"])
    assert told["properties"]["from"]["type"] == ["number", "null"]
    assert schema_of(ANGLE)["exclusiveMaximum"] == 90.0
    numbers = {"type": "number", "exclusiveMinimum": 0.0}
    assert schema_of(STEPS) == {"type": "array", "description": "discs (N)", "minItems": 1, "items": numbers}


def test_three_numbers_are_three() -> None:
    schema = schema_of(Quantity("inertia_kg_m2", "moments of inertia", lowest=0.0, kind="three numbers"))
    assert schema == {
        "type": "array", "description": "moments of inertia (kg m²)", "minItems": 3, "maxItems": 3,
        "items": {"type": "number", "minimum": 0.0},
    }  # fmt: skip


def test_a_schema_is_in_its_file_as_people_read_it() -> None:
    assert schema_text({"unit": "°", "type": "number"}) == '{\n "unit": "°",\n "type": "number"\n}\n'
