"""JSON that a command prints."""

import json
from typing import Any

import jsonschema
import pytest

from skisnow.cli import main


def json_answer(words: list[str], schema: Any, printed: pytest.CaptureFixture[str], *, status: int = 0) -> Any:
    """The JSON that a command prints with --json, which meets a schema."""
    assert main([*words, "--json"]) == status
    found = json.loads(printed.readouterr().out, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))
    jsonschema.validate(found, schema)
    return found
