"""Cases and answers from their files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, TypeAlias

from . import CASES
from .words import OpenbenchError

Json: TypeAlias = dict[str, Any]


def case_names(folder: Path = CASES) -> list[str]:
    """In order."""
    return sorted(path.parent.name for path in folder.glob("*/case.json"))


def read_case(name: str, folder: Path = CASES) -> Json:
    """A case by its name."""
    return _read(folder / name / "case.json")


def read_answer(name: str, folder: Path = CASES) -> Json:
    """Its answer: values, uncertainty and scale by key, kind and provenance."""
    return _read(folder / name / "answer.json")


def _read(path: Path) -> Json:
    try:
        read: Json = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise OpenbenchError(f"{path} is not there; cases of this set: {', '.join(case_names())}") from None
    return read
