"""JSON that a command prints."""

import json
from functools import lru_cache
from typing import Any

import jsonschema
import pytest

from skisnow.cli import main


def json_answer(words: list[str], schema: Any, printed: pytest.CaptureFixture[str], *, status: int = 0) -> Any:
    """The JSON that a command prints with --json, which meets a schema."""
    assert main([*words, "--json"]) == status
    found = json.loads(printed.readouterr().out, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))
    _validator(json.dumps(schema)).validate(found)
    return found


@lru_cache
def _validator(schema: str) -> Any:
    """It does not check the schema each time, as `jsonschema.validate` does; test_export.py checks all schemas."""
    return jsonschema.Draft202012Validator(json.loads(schema))
