"""The head of OpenSim's tables of motion (.mot) and storage (.sto): lines ``key=value`` up to ``endheader``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from ..errors import ParameterError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

HEAD_END: Final = "endheader"
_COUNTS: Final = ("nRows", "nColumns")


def head_of_motion(lines: Sequence[str]) -> dict[str, str]:
    """Keys of a head, as they are written, with what they say.

    >>> head_of_motion(["Coordinates", "nRows = 2", "inDegrees=no"])
    {'nRows': '2', 'inDegrees': 'no'}
    """
    pairs = (line.partition("=") for line in lines if "=" in line)
    return {key.strip(): value.strip() for key, _, value in pairs}


def is_in_degrees(head: Mapping[str, str]) -> bool:
    """Whether angles are in degrees, as they are where nothing is said."""
    return _said(head).get("indegrees", "yes").lower() != "no"


def require_whole(path: str | Path, head: Mapping[str, str], *, rows: int, columns: int) -> None:
    """ParameterError where the head says another number of rows or columns than there are."""
    said = _said(head)
    for key, there in zip(_COUNTS, (rows, columns), strict=True):
        word = said.get(key.lower(), "")
        if word.isdecimal() and int(word) != there:
            raise ParameterError(
                f"{path}: the head says {key}={word}, there are {there}; it is cut or joined, or its head wrong"
            )


def _said(head: Mapping[str, str]) -> dict[str, str]:
    return {key.lower(): value for key, value in head.items()}
