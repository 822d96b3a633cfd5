"""An analysis as a figure, a pandas DataFrame and an xarray Dataset."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ..._support.environment import needed
from ..._support.errors import ParameterError, nearest
from ..._support.messages import Message
from ..._support.units import unit_of_name
from ..figures.drawing import Drawing
from ..figures.style import journal_style, site_styles
from .data import ReportData
from .page import DRAWERS, RECORDING_DRAWERS

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame
    from xarray import Dataset

    from ...estimation.analysis import Analysis

KINDS: Final = ("penetration", "shear")
_ENDS: Final = ("low", "high")


def analysis_figure(analysis: Analysis, what: str) -> Figure:
    """One figure of the report by its name; see `Analysis.plot`."""
    recordings = RECORDING_DRAWERS if analysis.campaign.snow_micro_pen else ()
    drawers = {drawer.__name__: drawer for drawer in (*DRAWERS, *recordings)}
    if what not in drawers:
        raise ParameterError(
            "No figure {what!r} of an analysis. {names}", code="unknown_figure", what=what, names=nearest(what, drawers)
        )
    data = ReportData(analysis)
    with journal_style():
        drawing = drawers[what](data, site_styles(data))
    if not isinstance(drawing, Drawing):
        raise ParameterError("The campaign has no data for the figure {what}.", code="no_data", what=what)
    return drawing.figure


def analysis_dataframe(analysis: Analysis, kind: str) -> DataFrame:
    """One row per experiment; see `Analysis.to_dataframe`."""
    pandas = needed("pandas", extra="pandas", what=Message("An analysis as a DataFrame"))
    if kind not in KINDS:
        raise ParameterError(
            "No experiments {kind!r}. {names}", code="unknown_kind", kind=kind, names=nearest(kind, KINDS)
        )
    return pandas.DataFrame(_rows(analysis, kind))


def analysis_dataset(analysis: Analysis) -> Dataset:
    """All experiments; see `Analysis.to_xarray`."""
    xarray = needed("xarray", extra="xarray", what=Message("An analysis as a Dataset"))
    variables: dict[str, Any] = {}
    for kind in KINDS:
        rows = _rows(analysis, kind)
        for name in rows[0] if rows else ():
            column = np.array([math.nan if row[name] is None else row[name] for row in rows])
            unit = unit_of_name(name).symbol
            variables[f"{kind}_{name}"] = (f"{kind}_experiment", column, {"units": unit} if unit else {})
    return xarray.Dataset(variables, attrs={"campaign": analysis.campaign.name})


def _rows(analysis: Analysis, kind: str) -> list[dict[str, Any]]:
    """Experiments of results.json, with an interval as two columns; other lists are left to results.json."""
    rows = []
    for row in analysis.results[kind].get("experiments", ()):
        flat: dict[str, Any] = {}
        for name, value in row.items():
            if "interval" in name:
                ends = value or (None, None)
                flat |= {name.replace("interval", end): limit for end, limit in zip(_ENDS, ends, strict=True)}
            elif not isinstance(value, list | dict):
                flat[name] = value
        rows.append(flat)
    return rows
