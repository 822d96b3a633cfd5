"""A figure's SVG for a page: the same picture in little more than half the bytes."""

from __future__ import annotations

import re
from collections import Counter
from typing import Final

DIGITS: Final = 2
"""Behind the point, of a length in points: steps of 0.01 pt, 3.5 µm on paper."""
_LENGTH: Final = re.compile(r"-?\d+\.\d{3,}")
_PLACED: Final = re.compile(r' (?:d|x|y)="[^"]*"|translate\([^)]*\)')
_PATH: Final = re.compile(r' d="[^"]*"')
_STYLE: Final = re.compile(r' style="([^"]*)"')
_NAME: Final = re.compile(r'(?:id="|#)([mpc][0-9a-f]{8,})')
_FEW: Final = 2


def compact_svg(svg: str) -> str:
    r"""Lengths rounded, styles said once, no names that nothing refers to; for an SVG as the drawing library writes it.

    >>> compact_svg('<svg>\n <g id="a">\n  <path d="M 1.23456 2 \nL 3 4 \n" style="fill: none"/>\n </g>\n</svg>')
    '<svg><g><path d="M 1.23 2 L 3 4 " style="fill: none"/></g></svg>'
    """
    svg = _PLACED.sub(lambda found: _LENGTH.sub(_rounded, found[0]), svg)
    svg = _PATH.sub(lambda found: found[0].replace("\n", ""), svg)
    svg = re.sub(r'<g id="[^"]*"', "<g", re.sub(r">\s*\n\s*<", "><", svg)).replace("xlink:href", "href")
    for number, name in enumerate(dict.fromkeys(_NAME.findall(svg))):
        svg = svg.replace(name, f"i{number}")
    return _with_classes(svg)


def _rounded(found: re.Match[str]) -> str:
    text = f"{float(found[0]):.{DIGITS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _with_classes(svg: str) -> str:
    """Styles that several elements have become classes."""
    often = [style for style, count in Counter(_STYLE.findall(svg)).most_common() if count > _FEW]
    if not often:
        return svg
    classes = {style: f"s{number}" for number, style in enumerate(often)}
    rules = "".join(f".{name}{{{style}}}" for style, name in classes.items())
    svg = _STYLE.sub(lambda found: f' class="{classes[found[1]]}"' if found[1] in classes else found[0], svg)
    return svg.replace("</svg>", f"<style>{rules}</style></svg>")
