"""The pages on force laws tell what the laws say of themselves, and have their figures."""

import importlib.util
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread

from skisnow.forces import friction, penetration, shear
from skisnow.forces.penetration import AreaLaw, BilinearLaw, HypoplasticPoint, MeanPressureLaw
from skisnow.forces.shear import MachiningShear
from skisnow.snow import published_names, published_snow

from ..versions import SAME_PIXELS

DOCS = Path(__file__).resolve().parents[2] / "docs"
INDEX = (DOCS / "forces" / "index.md").read_text(encoding="utf-8")
LAWS = (*penetration.LAWS, *penetration.POINT_LAWS, *shear.LAWS, *friction.LAWS)
PAGES = sorted(path for path in (DOCS / "forces").glob("*.md") if path.name != "index.md")
LIMIT = 60_000
"""Bytes of a figure: a page of the docs stays light."""


def drawing_script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("figures_of_forces", DOCS / "figures_of_forces.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
def test_every_law_has_a_line_and_a_page(law: type) -> None:
    assert f"[`{law.__name__}`](" in INDEX
    of_it = [
        page
        for page in PAGES
        if f"autoclass:: {law.__module__.rsplit('.', 1)[0]}.{law.__name__}\n" in page.read_text("utf-8")
    ]
    assert len(of_it) == 1


@pytest.mark.parametrize(
    "law",
    [
        BilinearLaw(0.2e9, 1e-3, 0.0, 1.0, 0.0),
        AreaLaw(0.2e6),
        MeanPressureLaw(0.01e9, 0.1e6),
        HypoplasticPoint(0.2e9, float("inf")),
        MachiningShear(0.05e6, 0.1),
    ],
    ids=lambda law: type(law).__name__,
)
def test_every_exception_stands_in_the_table(law: Any) -> None:
    assert law.exceptions
    for check, reason in law.exceptions.items():
        rows = [line for line in INDEX.splitlines() if line.startswith(f"| `{type(law).__name__}`")]
        assert any(f"| {check} | {reason} |" in row for row in rows)


def test_every_page_has_its_figure_and_every_figure_its_page() -> None:
    figures = {path.stem: path for path in (DOCS / "_static" / "forces").iterdir()}
    assert set(figures) == {page.stem for page in PAGES} == set(drawing_script().FIGURES)
    for page in PAGES:
        assert f"](../_static/forces/{page.stem}.png)" in page.read_text("utf-8")
        assert figures[page.stem].stat().st_size < LIMIT


DRAWN_QUICKLY = ("penetration-volume", "penetration-hypoplastic-point", "shear-machining", "drag")
"""One of each kind; the rest takes half a second each."""


@SAME_PIXELS
@pytest.mark.parametrize(
    "name",
    [pytest.param(page.stem, marks=() if page.stem in DRAWN_QUICKLY else pytest.mark.slow) for page in PAGES],
)
def test_the_committed_figure_is_that_which_the_script_draws(name: str, tmp_path: Path) -> None:
    """Compared as pictures: another version of the drawing library may move an edge by a pixel."""
    drawing_script().draw(tmp_path, [name])
    drawn, committed = (imread(folder / f"{name}.png") for folder in (tmp_path, DOCS / "_static" / "forces"))
    assert drawn.shape == committed.shape
    assert float(np.mean(np.abs(drawn - committed))) < 0.01


@pytest.mark.parametrize("name", published_names())
def test_every_named_snow_stands_in_the_table(name: str) -> None:
    snow = published_snow(name)
    (row,) = [line for line in INDEX.splitlines() if line.startswith(f"| `{name}` |")]
    _, _, hardness, stress, *_ = (cell.strip() for cell in row.split("|"))
    assert float(hardness) == pytest.approx(snow.snow_hardness / 1e9, rel=0.03)  # two digits
    assert float(stress) == pytest.approx((snow.failure_shear_stress or 0.0) / 1e6, rel=0.01)
