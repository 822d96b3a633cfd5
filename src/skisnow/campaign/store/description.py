"""campaign.toml of a campaign that is entered, written from its values and checked as every campaign.toml is."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

from ..._support.errors import FieldDataError
from ..reading.campaign_file import read_campaign_file

if TYPE_CHECKING:
    from ..problems import Problem

Value: TypeAlias = "str | float | Sequence[str] | Sequence[float]"


@dataclass(frozen=True, slots=True)
class Description:
    """Keys of campaign.toml with their values: of the whole, of each tool, of each plate. None and "" are left out."""

    values: Mapping[str, Value | None] = field(default_factory=dict)
    tools: Sequence[Mapping[str, Value]] = ()
    plates: Sequence[Mapping[str, Value]] = ()


def description_text(description: Description) -> str:
    """The text of campaign.toml.

    Raises
    ------
    FieldDataError
        With every problem of the text, as reading the file would tell it.
    """
    lines = [f"{key} = {_written(value)}" for key, value in description.values.items() if value not in (None, "")]
    for table, entries in (("tool", description.tools), ("plate", description.plates)):
        for entry in entries:
            lines += ["", f"[[{table}]]", *(f"{key} = {_written(value)}" for key, value in entry.items())]
    text = "\n".join(lines) + "\n"
    found: list[Problem] = []
    read_campaign_file(text, found)
    if any(problem.severity == "error" for problem in found):
        raise FieldDataError(found)
    return text


def _written(value: Value | None) -> str:
    if isinstance(value, str):  # a basic string of TOML is one of JSON, but for the letter DEL
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Sequence):
        return f"[{', '.join(_written(item) for item in value)}]"
    return repr(value)
