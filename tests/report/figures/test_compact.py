"""The SVG of a page is that of the file: the same elements and words, lengths to a hundredth of a point."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import numpy as np
import pytest
from markupsafe import Markup

from skisnow.report.figures.drawing import Drawing, compact_svg, drawing_svg
from skisnow.report.figures.style import journal_style, new_figure

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
TAG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def svg() -> str:
    with journal_style():
        figure = new_figure()
        axes = figure.subplots()
        x = np.linspace(0.0, 1.0, 60)
        axes.plot(x, np.sin(9.0 * x), "o")
        axes.plot(x, np.cos(9.0 * x))
        axes.imshow([[0.0, 1.0], [0.5, 0.2]], extent=(0.0, 0.5, 0.0, 0.5))
        axes.set_xlabel("0.123456 < a word")
        return drawing_svg(Drawing("name", Markup(""), "words", figure))


def elements(text: str) -> list[ElementTree.Element]:
    style = f"{TAG}style"
    return [each for each in ElementTree.fromstring(text).iter() if each.tag != style]


def test_it_is_the_same_picture_in_fewer_bytes(svg: str) -> None:
    compact = compact_svg(svg)
    assert len(compact) < 0.7 * len(svg)
    before, after = elements(svg), elements(compact)
    assert [each.tag for each in after] == [each.tag for each in before]
    assert [(each.text or "").strip() for each in after] == [(each.text or "").strip() for each in before]
    for one, other in zip(before, after, strict=True):
        for key in ("d", "x", "y", "transform", "viewBox", "width", "height"):
            given = [float(each) for each in NUMBER.findall(one.get(key, ""))]
            assert [float(each) for each in NUMBER.findall(other.get(key, ""))] == pytest.approx(given, abs=0.0051)


def test_styles_and_references_lead_to_what_they_were(svg: str) -> None:
    compact = compact_svg(svg)
    rules = dict(re.findall(r"\.(s\d+)\{([^}]*)\}", compact))
    styles = [each.get("style") or rules.get(each.get("class", "")) for each in elements(compact)]
    assert styles == [each.get("style") for each in elements(svg)]
    href = "{http://www.w3.org/1999/xlink}href"
    before, after = paths_of_uses(svg, href), paths_of_uses(compact, "href")
    assert len(after) > 60
    assert after == pytest.approx(before, abs=0.0051)


def paths_of_uses(text: str, href: str) -> list[float]:
    """The numbers of all paths that are used, in order."""
    paths = {each.get("id"): each.get("d", "") for each in elements(text)}
    used = [paths[each.get(href, "")[1:]] for each in elements(text) if each.tag == f"{TAG}use"]
    return [float(number) for path in used for number in NUMBER.findall(path)]
