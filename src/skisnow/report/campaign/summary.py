"""Results of a campaign as text for a terminal, as a figure, a pandas DataFrame and an xarray Dataset."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ..._support.environment import import_extra
from ..._support.errors import ParameterError, suggest_and_list
from ..._support.messages import Message
from ..._support.units import unit_of_name
from ..formatting import terminal_text
from .data import Json, ReportData
from .key_results import key_results
from .verdicts import caveats, verdicts

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame
    from xarray import Dataset

    from ...estimation.analysis import Analysis

KINDS: Final = ("penetration", "shear")
_ENDS: Final = ("low", "high")


def summary(analysis: Analysis) -> str:
    """Verdicts, numbers of experiments, key results and caveats of the report as lines of plain English text."""
    data = ReportData(analysis)
    described = data.results["campaign"]
    tag = " (synthetic)" if data.synthetic else ""  # in each line, because numbers are copied line by line
    corrections = len(described["corrections"])
    lines = [f"{described['name']}, {described['place']}" if described["place"] else described["name"], ""]
    lines += [f"{verdict}{tag}" for verdict in verdicts(data.results)]
    lines += [_experiment_line(kind, data.results[kind]["experiments"]) for kind in KINDS]
    lines += [f"{terminal_text(sentence)}{tag}" for sentence in key_results(data)]
    lines += [f"corrections applied: {corrections}"] if corrections else []
    return "\n".join([*lines, *map(terminal_text, caveats(data))])


def _experiment_line(kind: str, rows: list[Json]) -> str:
    """Line with the numbers of experiments, used and flagged ones, and of each flag."""
    if not rows:
        return f"{kind} experiments: none"
    used, flagged = sum(row["used"] for row in rows), sum(bool(row["flags"]) for row in rows)
    counts = Counter(code for row in rows for code in row["flags"])
    codes = f" ({', '.join(f'{code} {count}' for code, count in counts.items())})" if counts else ""
    return f"{kind} experiments: {len(rows)}, used {used}, flagged {flagged}{codes}"


def analysis_figure(analysis: Analysis, what: str) -> Figure:
    """Figure of an analysis with the name `what`, in the style of the report; rejects an unknown name."""
    from ..figures.drawing import Drawing
    from ..figures.style import journal_style, site_styles
    from .page import drawers_of

    drawers = {drawer.__name__: drawer for drawer in drawers_of(analysis.campaign)}
    if what not in drawers:
        raise ParameterError("Unknown figure {what!r} of an analysis. {names}").tag(
            "unknown_figure", what=what, names=suggest_and_list(what, drawers)
        )
    data = ReportData(analysis)
    with journal_style():
        drawing = drawers[what](data, site_styles(data))
    if not isinstance(drawing, Drawing):
        raise ParameterError("The campaign has no data for the figure {what}.").tag("no_data", what=what)
    return drawing.figure


def analysis_dataframe(analysis: Analysis, kind: str) -> DataFrame:
    """DataFrame with a row per experiment of `kind`, penetration or shear; needs pandas."""
    pandas = import_extra("pandas", extra="pandas", what=Message("An analysis as a DataFrame"))
    if kind not in KINDS:
        raise ParameterError("No experiments {kind!r}. {names}").tag(
            "unknown_kind", kind=kind, names=suggest_and_list(kind, KINDS)
        )
    return pandas.DataFrame(_rows(analysis, kind))


def analysis_dataset(analysis: Analysis) -> Dataset:
    """Dataset of all experiments: variables by kind and column, with their units; needs xarray."""
    xarray = import_extra("xarray", extra="xarray", what=Message("An analysis as a Dataset"))
    variables: dict[str, Any] = {}
    for kind in KINDS:
        rows = _rows(analysis, kind)
        for name in rows[0] if rows else ():
            column = np.array([math.nan if row[name] is None else row[name] for row in rows])
            unit = unit_of_name(name).symbol.replace("°", "degree")
            variables[f"{kind}_{name}"] = f"{kind}_experiment", column, {"units": unit} if unit else {}
    return xarray.Dataset(variables, attrs={"campaign": analysis.campaign.name})


def _rows(analysis: Analysis, kind: str) -> list[dict[str, Any]]:
    """Rows of the experiments as in results.json, with an interval as two values; other lists are omitted."""
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
