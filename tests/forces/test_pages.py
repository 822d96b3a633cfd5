"""The page on force laws has a row for each law and shows the figures that its script draws."""

import importlib
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
PAGE = (DOCS / "methods" / "forces.md").read_text(encoding="utf-8")
REFERENCE: str = importlib.import_module("api_reference").reference()
LAWS = (*penetration.LAWS, *penetration.POINT_LAWS, *shear.LAWS, *friction.LAWS)
LIMIT = 60_000
"""Bytes of a figure: a page of the docs stays light."""


def drawing_script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("figures_of_forces", DOCS / "figures_of_forces.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
def test_every_law_has_a_row_and_a_reference(law: type) -> None:
    assert f"| `{law.__name__}` |" in PAGE
    assert f"autoclass:: {law.__module__.rsplit('.', 1)[0]}.{law.__name__}\n" in REFERENCE


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
        rows = [line for line in PAGE.splitlines() if line.startswith(f"| `{type(law).__name__}`")]
        assert any(f"| {check} | {reason} |" in row for row in rows)


FIGURES = sorted(path.stem for path in (DOCS / "_static" / "forces").iterdir())


def test_every_figure_is_drawn_and_shown() -> None:
    assert sorted(drawing_script().FIGURES) == FIGURES
    for name in FIGURES:
        assert f"](../_static/forces/{name}.png)" in PAGE
        assert (DOCS / "_static" / "forces" / f"{name}.png").stat().st_size < LIMIT


@SAME_PIXELS
@pytest.mark.parametrize("name", FIGURES)
def test_the_committed_figure_is_that_which_the_script_draws(name: str, tmp_path: Path) -> None:
    """Compared as pictures: another version of the drawing library may move an edge by a pixel."""
    drawing_script().draw(tmp_path, [name])
    drawn, committed = (imread(folder / f"{name}.png") for folder in (tmp_path, DOCS / "_static" / "forces"))
    assert drawn.shape == committed.shape
    assert float(np.mean(np.abs(drawn - committed))) < 0.01


@pytest.mark.parametrize("name", published_names())
def test_every_named_snow_stands_in_the_table(name: str) -> None:
    snow = published_snow(name)
    (row,) = [line for line in PAGE.splitlines() if line.startswith(f"| `{name}` |")]
    _, _, hardness, stress, *_ = (cell.strip() for cell in row.split("|"))
    assert float(hardness) == pytest.approx(snow.snow_hardness / 1e9, rel=0.03)  # two digits
    assert float(stress) == pytest.approx((snow.failure_shear_stress or 0.0) / 1e6, rel=0.01)
