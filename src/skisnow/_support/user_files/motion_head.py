"""The head of OpenSim's tables of motion (.mot) and storage (.sto): lines ``key=value`` up to ``endheader``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from ..errors import ParameterError

HEAD_END: Final = "endheader"
_LONGEST_SHOWN: Final = 40
_ONE_NUMBER: Final = "double"
_WORDS: Final = {"yes": True, "y": True, "no": False, "n": False}


def head_of_motion(lines: Sequence[str]) -> dict[str, str]:
    """Values by key, as written, in the lines of the header of an OpenSim file.

    >>> head_of_motion(["Coordinates", "nRows = 2", "inDegrees=no"])
    {'nRows': '2', 'inDegrees': 'no'}
    """
    pairs = (line.partition("=") for line in lines if "=" in line)
    return {key.strip(): value.strip() for key, _, value in pairs}


def degrees_stated(path: str | Path, head: Mapping[str, str]) -> bool | None:
    """True or False as the header states degrees or not; None without a statement."""
    word = _header_values(head).get("indegrees")
    if word is None:
        return None
    if word.lower() not in _WORDS:
        raise ParameterError("{path}: the header states inDegrees={word}. Allowed: yes, no. Correct the line.").tag(
            "head_says_indegrees", path=path, word=word
        )
    return _WORDS[word.lower()]


def is_in_degrees(path: str | Path, head: Mapping[str, str]) -> bool:
    """True if OpenSim reads the angles of a file in degrees: if its header states so; otherwise they are in radians.

    Raises ParameterError: the header of a .mot file has neither a statement nor a version, so that OpenSim reads
        degrees.
    """
    stated = degrees_stated(path, head)
    if stated is None and "version" not in _header_values(head) and str(path).lower().endswith(".mot"):
        raise ParameterError(
            "{path}: the header states neither the unit of angles nor a version. Add the line inDegrees=yes or "
            "inDegrees=no before endheader."
        ).tag("head_says_neither_whether", path=path)
    return stated is True


def require_whole(path: str | Path, head: Mapping[str, str], **counts: int) -> None:
    """Raise a ParameterError if the header states cells of several numbers, or counts that differ from the file's.

    counts: numbers of rows or the like in the file, by the key of the header.
    """
    said = _header_values(head)
    kind = said.get("datatype", _ONE_NUMBER)
    if kind.lower() != _ONE_NUMBER:
        raise ParameterError(
            "{path}: the header states DataType={kind}. Allowed: DataType=double, one number in each cell. Export "
            "coordinates, such as the angles that OpenSense's inverse kinematics writes."
        ).tag("head_says_data_type", path=path, kind=kind[:_LONGEST_SHOWN])
    for key, there in counts.items():
        word = said.get(key.lower(), "")
        if word.isdecimal() and word.lstrip("0") != str(there).lstrip("0"):  # int refuses 4300 digits
            raise ParameterError(
                "{path}: the header states {key}={word}, but the file has {there}; it is truncated or joined, or its "
                "header is wrong"
            ).tag("head_says", path=path, key=key, word=word[:_LONGEST_SHOWN], there=there)


def _header_values(head: Mapping[str, str]) -> dict[str, str]:
    """Values of a header by key in lower case."""
    return {key.lower(): value for key, value in head.items()}
