"""The set as files: schemas, units, licences, and that what is committed is what the commands write."""

import json
import math
import re
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from openbench.checking import unit_of
from openbench.making import answers, pages
from openbench.making.cases import CASES as MAKERS
from openbench.making.exact import EXACT
from openbench.reading import case_names, read_answer, read_case

import openbench

FOLDER = Path(openbench.__file__).parent
NAMES = case_names()


def schema(name: str) -> Any:
    return json.loads((FOLDER / "schemas" / f"{name}.schema.json").read_text(encoding="utf-8"))


def numbers(value: Any, key: str = "") -> list[str]:
    """Keys that stand above a number."""
    if isinstance(value, dict):
        return [found for k, v in value.items() for found in numbers(v, k)]
    if isinstance(value, list):
        return [found for v in value for found in numbers(v, key)]
    return [key] if isinstance(value, int | float) else []


def test_there_are_eight() -> None:
    assert len(NAMES) == 8


@pytest.mark.parametrize("name", NAMES)
def test_files_obey_their_schemas_and_each_number_of_a_case_has_its_unit(name: str) -> None:
    for content, kind in ((read_case(name), "case"), (read_answer(name), "answer")):
        validator = jsonschema.validators.validator_for(schema(kind))(schema(kind))
        assert list(validator.iter_errors(content)) == []
    keys = {key for key in numbers(read_case(name)) if key not in {"count", "spread_over"}}
    assert [key for key in keys if unit_of(key) is None] == []


@pytest.mark.parametrize("name", NAMES)
def test_answers_answer_what_is_asked(name: str) -> None:
    case, answer = read_case(name), read_answer(name)
    keys = [each["key"] for each in case["asked"]]
    assert list(answer["scale"]) == list(answer["uncertainty"]) == keys
    if "values" in answer:
        assert {key: len(row) for key, row in answer["values"].items()} == {e["key"]: e["count"] for e in case["asked"]}
        assert all(math.isfinite(v) for row in answer["values"].values() for v in row)


def test_cases_and_exact_answers_are_those_that_the_commands_write() -> None:
    for make in MAKERS:
        case = json.loads(json.dumps(make()))
        assert read_case(case["case"]) == case
    for name in EXACT:
        assert read_answer(name)["values"] == answers.exact(name)["values"]


@pytest.mark.parametrize("name", NAMES)
def test_pages_are_those_that_the_command_writes(name: str) -> None:
    assert (FOLDER / "v1" / name / "README.md").read_text(encoding="utf-8") == pages.page(name)
    assert (FOLDER / "v1" / name / "drawing.svg").exists()


def test_no_measured_number_is_in_the_set() -> None:
    answer = read_answer("05-sand")
    assert "values" not in answer
    assert set(answer["values_from"]["sha256"]) == set(read_case("05-sand")["data"]["files"])


def test_entries_of_strangers_are_fifty_lines() -> None:
    assert len((FOLDER / "entries" / "plain_python.py").read_text(encoding="utf-8").splitlines()) <= 50
    assert len((FOLDER / "entries" / "in_c.c").read_text(encoding="utf-8").splitlines()) <= 50
    words = (FOLDER / "entries" / "plain_python.py").read_text(encoding="utf-8")
    assert set(re.findall(r"^import (\w+)", words, re.MULTILINE)) == {"json", "math", "sys"}


def test_licence_and_citation() -> None:
    assert "CC BY 4.0" in (FOLDER / "LICENSE").read_text(encoding="utf-8")
    assert "license: CC-BY-4.0" in (FOLDER / "CITATION.cff").read_text(encoding="utf-8")
    zenodo = json.loads((FOLDER / ".zenodo.json").read_text(encoding="utf-8"))
    assert (zenodo["license"], zenodo["upload_type"]) == ("cc-by-4.0", "dataset")
    assert {read_answer(name)["licence"] for name in NAMES} == {"CC-BY-4.0"}
