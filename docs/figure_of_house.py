"""The picture of the packages on docs/architecture.md: ``python docs/figure_of_house.py`` draws it again.

Which package stands above which comes from the contract in pyproject.toml that import-linter holds; what is in a
package, and the two paths through them, stand here.
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
    "pipeline": "campaign, snow, turn and report in one call",
    "report": "tables, figures, pages, run.nc",
    "interop": "FMUs, MuJoCo, OpenSim, CAAML",
    "replay": "a run in three dimensions",
    "identification": "friction, drag and snow from tracks",
    "studies": "grids and samples of carves and runs",
    "racing": "the quickest line",
    "design": "the ski for a wanted turn",
    "simulation": "the run of a sledge on two skis, and how exact it is",
    "skier": "plans of turns, balance",
    "carving": "a ski in equilibrium",
    "scenario": "what a run is",
    "dynamics": "bodies, steps, static start",
    "estimation": "hardness, strength, models, intervals",
    "contact": "history-dependent snow, any runners",
    "campaign": "campaign files, records, store",
    "samples": "sample files of every format",
    "ski": "shape, stiffness, beam",
    "comparison": "how far two tracks are apart",
    "track": "readers, curvature, turns, gates",
    "statistics": "least squares, tests, resampling",
    "forces": "one law a file",
    "snow": "SnowProperties, published values",
    "geometry": "tools pressed into snow, slope surfaces",
    "parameters": "a quantity, declared once: name, unit, range, default, origin",
    "_support": "files, texts, errors, units, display, processes",
    "compiled": "the C++ core",
}
"""Each package, with what it holds."""
MEASURED, COMPUTED, BOTH = "#dcebf7", "#fde8d3", "#eef0ee"
COLOURS = {
    **dict.fromkeys(("campaign", "estimation", "statistics"), MEASURED),
    **dict.fromkeys(
        ("carving", "contact", "dynamics", "forces", "scenario", "simulation", "ski", "skier", "compiled"), COMPUTED
    ),
}
READING = ("cli", "campaign", "estimation", "snow", "report")
TURN = ("cli", "scenario", "ski", "simulation", "contact", "dynamics", "compiled", "track", "report", "replay")
"""The packages that a reading and a turn come through, in this order."""
LEFT_TO_RIGHT = ("campaign", "estimation", "statistics", "identification", "report")
"""Packages that stand left of the others in their layer: what was measured."""

WIDTH, EDGE, FLOOR, ROOF, GAP = 960, 30, 46, 96, 6
BLUE, ORANGE, INK, GREY = "#0b63a5", "#b85300", "#1c2430", "#55606b"


def floors() -> list[list[str]]:
    """The layers from the top down, each with its packages."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"][
        "contracts"
    ]
    (layers,) = (each["layers"] for each in contracts if each["type"] == "layers")
    return [re.findall(r"\w+", layer) for layer in layers if layer != "__main__"]


def picture() -> str:
    """The SVG."""
    above = floors()
    parts, y = [], ROOF
    for floor in above[1:]:
        parts.append(_floor(sorted(floor, key=lambda package: (package not in LEFT_TO_RIGHT, package)), y))
        y += FLOOR + GAP
    height = y + 54
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img" aria-labelledby="t" '
            'font-family="Helvetica, Arial, sans-serif">',
            '<title id="t">The packages of skisnow: each may import what stands below it</title>',
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


def _floor(packages: list[str], y: float) -> str:
    wanted = [60.0 + 6.2 * len(INSIDE[package]) for package in packages]
    width_for = WIDTH - 2 * EDGE - GAP * (len(packages) - 1)
    parts, x = [], float(EDGE)
    for package, width in zip(packages, (each * width_for / sum(wanted) for each in wanted), strict=True):
        parts.append(_box(x, y, width, FLOOR, COLOURS.get(package, BOTH)))
        parts.append(_name(x + 12, y + 20, package, INSIDE[package]))
        parts.append(_steps(package, x + width - 14, y + 15))
        x += width + GAP
    return "\n".join(parts)


def _box(x: float, y: float, width: float, height: float, colour: str) -> str:
    return (
        f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height}" rx="3" fill="{colour}" stroke="{INK}" '
        'stroke-width="0.8"/>'
    )


def _name(x: float, y: float, package: str, inside: str, *, middle: bool = False) -> str:
    anchor = ' text-anchor="middle"' if middle else ""
    return (
        f'<text x="{x:.1f}" y="{y:.1f}"{anchor} font-size="15" font-weight="bold" fill="{INK}">{package}</text>'
        f'<text x="{x:.1f}" y="{y + 16:.1f}"{anchor} font-size="12" fill="{GREY}">{escape(inside)}</text>'
    )


def _steps(package: str, right: float, y: float) -> str:
    """The numbers of the paths that come through a package, from the right."""
    found = [(path.index(package) + 1, colour) for path, colour in ((TURN, ORANGE), (READING, BLUE)) if package in path]
    return "".join(_dot(right - 22 * i, y, number, colour) for i, (number, colour) in enumerate(found))


def _dot(x: float, y: float, number: int, colour: str) -> str:
    return (
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="9" fill="{colour}"/><text x="{x:.1f}" y="{y + 4:.1f}" font-size="11" '
        f'font-weight="bold" text-anchor="middle" fill="#fff">{number}</text>'
    )


def _legend(y: float) -> str:
    def label(x: float, text: str) -> str:
        return f'<text x="{x}" y="{y + 4}" font-size="12.5" fill="{INK}">{text}</text>'

    return "".join(
        [
            _dot(EDGE + 9, y, 1, BLUE), label(EDGE + 24, "from a reading to the snow"),
            _dot(EDGE + 212, y, 1, ORANGE), label(EDGE + 227, "from a scenario to a track"),
            _box(EDGE + 410, y - 8, 16, 16, MEASURED), label(EDGE + 432, "what was measured"),
            _box(EDGE + 565, y - 8, 16, 16, COMPUTED), label(EDGE + 587, "what is computed of a ski"),
            _box(EDGE + 752, y - 8, 16, 16, BOTH), label(EDGE + 774, "both"),
        ]
    )  # fmt: skip


if __name__ == "__main__":
    PICTURE.parent.mkdir(exist_ok=True)
    PICTURE.write_text(picture(), encoding="utf-8")
    print(PICTURE)
