"""The picture of the rooms on docs/architecture.md: ``python docs/figure_of_house.py`` draws it anew.

Which room stands above which comes from the contract in pyproject.toml that import-linter holds; what is in a room, and
the two ways through the house, stand here.
"""

from __future__ import annotations

import re
import tomllib
from html import escape
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PICTURE = Path(__file__).parent / "_static" / "architecture" / "house.svg"

INSIDE = {
    "cli": "the commands",
    "web": "the lab in a browser",
    "chain": "campaign, snow, turn and report in one call",
    "report": "tables, figures, pages, run.nc",
    "replay": "a run in three dimensions",
    "identify": "friction, drag and snow from tracks",
    "study": "grids and samples of carves and runs",
    "simulate": "the run of a sledge on two skis, and how exact it is",
    "carve": "a ski in equilibrium",
    "scenario": "what a run is",
    "dynamics": "bodies, steps, static start",
    "estimate": "hardness, strength, models, intervals",
    "sources": "named skis, snows",
    "contact": "history-dependent snow, any runners",
    "field": "campaign files, records, store",
    "parallel": "processes, kept rows",
    "ski": "shape, stiffness, beam",
    "track": "readers, curvature, turns, comparison of two tracks",
    "statistics": "least squares, tests, resampling",
    "forces": "one law a file",
    "snow": "SnowProperties, published values",
    "geometry": "tools pressed into snow, slope surfaces",
    "inputs": "a quantity, declared once: name, unit, range, default, origin",
    "compiled": "the C++ core",
}
"""Rooms with a box of their own; all others are the ground."""
MEASURED, COMPUTED, BOTH = "#dcebf7", "#fde8d3", "#eef0ee"
COLOURS = {
    **dict.fromkeys(("field", "estimate", "statistics"), MEASURED),
    **dict.fromkeys(("carve", "contact", "dynamics", "forces", "scenario", "simulate", "ski", "compiled"), COMPUTED),
}
READING = ("cli", "field", "estimate", "snow", "report")
TURN = ("cli", "scenario", "sources", "simulate", "contact", "dynamics", "compiled", "track", "report", "replay")
"""The rooms that a reading and a turn come through, in this order."""
LEFT_TO_RIGHT = ("field", "estimate", "statistics", "identify", "report")
"""Rooms that stand left of the others on their floor: what was measured."""

WIDTH, EDGE, FLOOR, ROOF, GAP = 960, 30, 46, 96, 6
BLUE, ORANGE, INK, GREY = "#0b63a5", "#b85300", "#1c2430", "#55606b"


def floors() -> list[list[str]]:
    """The floors from the roof down, each with its rooms."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"][
        "contracts"
    ]
    (layers,) = (each["layers"] for each in contracts if each["type"] == "layers")
    return [re.findall(r"\w+", layer) for layer in layers if layer != "__main__"]


def picture() -> str:
    """The SVG."""
    above = [floor for floor in floors() if set(floor) <= set(INSIDE)]
    ground = [room for floor in floors() for room in floor if not set(floor) <= set(INSIDE)]
    parts, y = [], ROOF
    for floor in above[1:]:
        parts.append(_floor(sorted(floor, key=lambda room: (room not in LEFT_TO_RIGHT, room)), y))
        y += FLOOR + GAP
    parts.append(_ground(ground, y))
    height = y + FLOOR + 62
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img" aria-labelledby="t" '
            'font-family="Helvetica, Arial, sans-serif">',
            '<title id="t">The rooms of skisnow: each may import what stands below it</title>',
            f'<rect width="{WIDTH}" height="{height}" fill="#fff"/>',
            f'<path d="M {EDGE} {ROOF - GAP} L {WIDTH / 2} 8 L {WIDTH - EDGE} {ROOF - GAP} Z" fill="{BOTH}" '
            f'stroke="{INK}"/>',
            _name(WIDTH / 2, ROOF - 32, above[0][0], INSIDE[above[0][0]], middle=True),
            _steps(above[0][0], WIDTH / 2 + 95, ROOF - 37),
            *parts,
            _legend(height - 22),
            "</svg>\n",
        ]
    )


def _floor(rooms: list[str], y: float) -> str:
    wanted = [60.0 + 6.2 * len(INSIDE[room]) for room in rooms]
    room_for = WIDTH - 2 * EDGE - GAP * (len(rooms) - 1)
    parts, x = [], float(EDGE)
    for room, width in zip(rooms, (each * room_for / sum(wanted) for each in wanted), strict=True):
        parts.append(_box(x, y, width, FLOOR, COLOURS.get(room, BOTH)))
        parts.append(_name(x + 12, y + 20, room, INSIDE[room]))
        parts.append(_steps(room, x + width - 14, y + 15))
        x += width + GAP
    return "\n".join(parts)


def _ground(rooms: list[str], y: float) -> str:
    """The small files that everything stands on, with the compiled core among them."""
    core = 170
    others = ", ".join(room for room in rooms if room != "compiled")
    words, lines = others.split(", "), [""]
    for word in words:
        if len(lines[-1]) + len(word) > 88:
            lines.append("")
        lines[-1] += (", " if lines[-1] else "") + word
    height = FLOOR + 8
    left = WIDTH - 2 * EDGE - core - GAP
    text = "\n".join(
        f'<text x="{EDGE + 12}" y="{y + 20 + 16 * i}" font-size="12.5" fill="{INK}">{escape(line)}</text>'
        for i, line in enumerate(lines)
    )
    x = EDGE + left + GAP
    return "\n".join(
        [
            _box(EDGE, y, left, height, BOTH),
            text,
            _box(x, y, core, height, COMPUTED),
            _name(x + 12, y + 22, "compiled", INSIDE["compiled"]),
            _steps("compiled", x + core - 14, y + 17),
        ]
    )


def _box(x: float, y: float, width: float, height: float, colour: str) -> str:
    return (
        f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height}" rx="3" fill="{colour}" stroke="{INK}" '
        'stroke-width="0.8"/>'
    )


def _name(x: float, y: float, room: str, inside: str, *, middle: bool = False) -> str:
    anchor = ' text-anchor="middle"' if middle else ""
    return (
        f'<text x="{x:.1f}" y="{y:.1f}"{anchor} font-size="15" font-weight="bold" fill="{INK}">{room}</text>'
        f'<text x="{x:.1f}" y="{y + 16:.1f}"{anchor} font-size="12" fill="{GREY}">{escape(inside)}</text>'
    )


def _steps(room: str, right: float, y: float) -> str:
    """The numbers of the ways that come through a room, from the right."""
    found = [(way.index(room) + 1, colour) for way, colour in ((TURN, ORANGE), (READING, BLUE)) if room in way]
    return "".join(_dot(right - 22 * i, y, number, colour) for i, (number, colour) in enumerate(found))


def _dot(x: float, y: float, number: int, colour: str) -> str:
    return (
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="9" fill="{colour}"/><text x="{x:.1f}" y="{y + 4:.1f}" font-size="11" '
        f'font-weight="bold" text-anchor="middle" fill="#fff">{number}</text>'
    )


def _legend(y: float) -> str:
    def told(x: float, text: str) -> str:
        return f'<text x="{x}" y="{y + 4}" font-size="12.5" fill="{INK}">{text}</text>'

    return "".join(
        [
            _dot(EDGE + 9, y, 1, BLUE), told(EDGE + 24, "the way of a reading"),
            _dot(EDGE + 174, y, 1, ORANGE), told(EDGE + 189, "the way of a turn"),
            _box(EDGE + 320, y - 8, 16, 16, MEASURED), told(EDGE + 342, "what was measured"),
            _box(EDGE + 480, y - 8, 16, 16, COMPUTED), told(EDGE + 502, "what is computed of a ski"),
            _box(EDGE + 690, y - 8, 16, 16, BOTH), told(EDGE + 712, "both"),
        ]
    )  # fmt: skip


if __name__ == "__main__":
    PICTURE.parent.mkdir(exist_ok=True)
    PICTURE.write_text(picture(), encoding="utf-8")
    print(PICTURE)
