"""Shapes from the design files of MonkeyCAM (``ski-def.json``): outline only, no stiffness, no camber, no mass.

MonkeyCAM (github mikemag/MonkeyCAM) is a program for building skis and snowboards. Its file gives the lengths of nose,
effective edge and tail, the waist width at the middle of the effective edge, the sidecut radius R and the taper t. With
the sagitta s = R - √(R² - L²/4) of the effective edge L the nose is w + 2 s + t/2 wide and the tail w + 2 s - t/2, and
the edge is the arc through the three.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any, Final

from .._support.errors import ParameterError
from .._support.units import CM, MM
from .._support.user_files import read_json, shown_value
from .assembling import ArcOutline
from .layout import layout_of_lengths

STRAIGHTEST: Final = 1000.0
"""Sidecut radius (m) beyond which no ski with a sidecut is made."""
_UNITS = {"": CM, "cm": CM, "mm": MM, "m": 1.0, "in": 25.4 * MM, "inch": 25.4 * MM, "inches": 25.4 * MM, '"': 25.4 * MM}
_MOST_BYTES = 1 << 22
_LARGEST = 1e9
_LENGTH = re.compile(r"([+-]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][+-]?\d++)?)\s*+([a-zA-Z\"]*+)")


def monkeycam_shape(path: Path, *, running_length: float | None = None) -> tuple[str, ArcOutline]:
    """Name and outline (SI) of a ski in a design file of MonkeyCAM.

    running_length: between the contact points (m); default: the effective edge (modelling assumption).

    The sidecut length is the effective edge; the boot is behind its middle by the stance setback. Nose and tail beyond
    it are closed as in `ArcOutline`: the curves of the file's nose and tail shape are not read, nor is the thickness
    of the core, from which no stiffness follows without the materials.
    """
    board = _read_board(path)
    edge, waist, taper = (_length(path, board, key) for key in ("effective edge length", "waist width", "taper"))
    radius = _length(path, board, "sidecut radius")
    if not edge / 2.0 < radius <= STRAIGHTEST or not edge > 0.0:
        raise ParameterError(
            "{path}: board: sidecut radius is {value}; allowed is more than half the edge length, at most {limit:g} m. "
            "Correct it."
        ).tag("out_of_range", path=path, value=shown_value(board["sidecut radius"]), limit=STRAIGHTEST)
    nose, tail = _length(path, board, "nose length"), _length(path, board, "tail length")
    layout = layout_of_lengths(
        length=nose + edge + tail,
        running_length=edge if running_length is None else running_length,
        sidecut_length=edge,
        tail_overhang=tail,
        boot_position=-_length(path, board, "stance setback") if "stance setback" in board else 0.0,
    )
    widest = waist + 2.0 * (radius - math.sqrt(radius**2 - edge**2 / 4.0))
    outline = ArcOutline(
        layout=layout, tip_width=widest + taper / 2.0, waist_width=waist, tail_width=widest - taper / 2.0
    )
    return str(board.get("name") or path.stem), outline


def _read_board(path: Path) -> dict[str, Any]:
    design = read_json(path, most_bytes=_MOST_BYTES)
    board = design.get("board") if isinstance(design, dict) else None
    if not isinstance(board, dict):
        raise ParameterError(
            "{path} has no section 'board'. Give a design file of MonkeyCAM, such as ski-def.json."
        ).tag("missing", path=path)
    if board.get("splitboard"):
        raise ParameterError(
            "{path}: board: splitboard is true. Its outline is of two halves together; give a ski."
        ).tag("wrong_kind", path=path)
    form = board.get("edge shape")
    kind = form.get("type") if isinstance(form, dict) else None
    if kind != "Basic Arc":
        raise ParameterError(
            "{path}: board: edge shape: type is {value}; allowed is 'Basic Arc'. Give other side lines as a table of "
            "widths."
        ).tag("out_of_range", path=path, value=shown_value(kind))
    return board


def _length(path: Path, board: dict[str, Any], key: str) -> float:
    """A length in m; a number without unit is in cm, as in MonkeyCAM."""
    value = board.get(key)
    read = None if isinstance(value, bool) else _LENGTH.fullmatch(str(value).strip())
    if read is None or read[2].lower() not in _UNITS or not abs(float(read[1])) <= _LARGEST:
        raise ParameterError(
            "{path}: board: {key} is {value}; allowed is a number in cm or a text such as '161cm', '2mm', '4in'. "
            "Correct it."
        ).tag("out_of_range", path=path, key=key, value=shown_value(value))
    return float(read[1]) * _UNITS[read[2].lower()]
