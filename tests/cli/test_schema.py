"""``skisnow schema`` prints valid JSON Schemas of inputs and outputs."""

from __future__ import annotations

import json

import jsonschema
import pytest

from skisnow.cli import main
from skisnow.cli.schema import NAMES


@pytest.mark.parametrize("name", NAMES)
def test_each_schema_is_valid(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema", name]) == 0
    schema = json.loads(capsys.readouterr().out)
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["properties" if name != "carve" else "$defs"]
