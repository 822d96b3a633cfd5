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
from ...estimation.regressions import FEWEST_VALUES
from ..formatting import interval, p_equals, plain
from .verdicts import verdicts

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.figure import Figure
    from pandas import DataFrame
    from xarray import Dataset

    from ...estimation.analysis import Analysis

Json = dict[str, Any]

MOST_REGRESSIONS: Final = 20
MOST_SITES: Final = 8
_OF_RECORDINGS: Final = (
    ("mean_force_N", "force", "N"),
    ("penetration_resistance_kPa", "penetration resistance", "kPa"),
    ("snow_density_kg_per_m3", "density", "kg/m³"),
)


def summary(results: Json) -> str:
    """Campaign, experiments, H_V, S_f, the nine candidate models, the selected law and the regressions.

    results: contents of `skisnow.estimation.results_dict`.
    """
    return "\n".join(_summary_lines(results))


def _summary_lines(results: Json) -> Iterator[str]:
    name = results["campaign"]["name"]
    # in each line, because numbers are copied line by line
    tag = " (synthetic)" if "synthetic" in name.casefold() else ""
    yield f"{name}, {results['campaign']['place']}" if results["campaign"]["place"] else name
    yield ""
    yield from (f"{verdict}{tag}" for verdict in verdicts(results))
    yield from _experiment_lines(results)
    yield from _measured(results, "H_V_N_per_mm3", f"H_V{tag}", "N/mm³", "geometric mean")
    yield from _unloading(results, tag)
    yield from _measured(results, "S_f_N_per_mm2", f"S_f{tag}", "N/mm²", "mean")
    yield from _displacement(results, tag)
    yield from _recordings(results, tag)
    relations = results.get("published_relations", ())
    yield from map(_by_relation, relations)
    yield from _missing_values(results["campaign"], has_tests=not relations)
    if results["penetration"]["selected"]:
        yield ""
        yield from _model_lines(results["penetration"], tag)
    shown = [row for row in results["regressions"] if row["p"] is not None or row["withheld"]]
    if shown:
        yield ""
        yield f"Regressions{tag}, slope with 95 % interval:"
        yield from map(_regression_line, shown[:MOST_REGRESSIONS])
        if len(shown) > MOST_REGRESSIONS:
            yield f"  and {len(shown) - MOST_REGRESSIONS} more in results.json"
        if any(row["withheld"] for row in shown[:MOST_REGRESSIONS]):
            few = f"fewer than {FEWEST_VALUES} values of the predictor"
            yield f"  not judged: with {few}, whatever else differs between them would show as well"


def _experiment_lines(results: Json) -> Iterator[str]:
    for kind in ("penetration", "shear"):
        rows = results[kind]["experiments"]
        if not rows:
            yield f"{kind} experiments: none"
            continue
        used, flagged = sum(row["used"] for row in rows), sum(bool(row["flags"]) for row in rows)
        yield f"{kind} experiments: {len(rows)}, used {used}, flagged {flagged}{_flag_counts(rows)}"


def _flag_counts(rows: list[Json]) -> str:
    counts = Counter(code for row in rows for code in row["flags"])
    return f" ({', '.join(f'{code} {count}' for code, count in counts.items())})" if counts else ""


def _measured(results: Json, quantity: str, symbol: str, unit: str, kind: str) -> Iterator[str]:
    """Mean of each site, then over all sites."""
    row = next((row for row in results["comparisons"] if row["quantity"] == quantity), None)
    if row is None or row["own"] is None:
        yield f"{symbol}: none"
        return
    sites = [item for item in results["site_means"] if item["quantity"] == quantity]
    over = f"over {len(sites)} sites" if len(sites) > 1 else f"over the experiments of one site, {sites[0]['site']}"
    for item in sites[:MOST_SITES] if len(sites) > 1 else ():
        numbers, own = (item["mean"], item["interval"], item["range"]), f"over its experiments, n = {item['n']}"
        yield _mean(f"{symbol} at {item['site']}", kind, unit, numbers, own)
    if len(sites) > MOST_SITES:
        yield f"  and {len(sites) - MOST_SITES} more sites in results.json"
    yield _mean(symbol, kind, unit, (row["own"], row["own_interval"], row["own_range"]), over)


def _unloading(results: Json, tag: str) -> Iterator[str]:
    """k_u/H_V of each site with unloading, and over all sites."""
    rows = results["penetration"]["unloading"]
    for row in rows if len(rows) > 2 else rows[:1]:
        where = "over all" if row["site"] is None else f"at {row['site']}"
        yield f"k_u/H_V{tag} {where}: {_ratio_in_words(row)}, n = {row['n']} series"


def _displacement(results: Json, tag: str) -> Iterator[str]:
    """u_y over all tests with turning angles."""
    for row in results["shear"]["displacement"][-1:]:
        ends = row["shear_displacement_interval_mm"]
        spread = f", 95 % interval {interval(ends, style='plain')}" if ends else ""
        yield f"u_y{tag}: {plain(row['shear_displacement_mm'])} mm{spread}, n = {row['n']} tests"


def _recordings(results: Json, tag: str) -> Iterator[str]:
    """Force, resistance and density of each site by the recordings of a SnowMicroPen."""
    pen = results.get("snow_micro_pen", {"recordings": []})
    rows = [row for row in pen["recordings"] if row["used"]]
    for site in dict.fromkeys(row["site"] for row in rows):
        mine = [row for row in rows if row["site"] == site]
        means = [
            f"{name} {plain(sum(values) / len(values))} {unit}"
            for key, name, unit in _OF_RECORDINGS
            if (values := [row[key] for row in mine if row[key] is not None])
        ]
        yield f"SnowMicroPen{tag} at {site}: mean {', '.join(means)} (by {pen['relation']}), recordings: {len(mine)}"


def _by_relation(row: Json) -> str:
    """Density, hardness and S_f of a site by published relations."""
    density, stress, index = (row[key] for key in ("snow_density_kg_per_m3", "S_f_N_per_mm2", "hand_hardness_index"))
    density_text = "none" if density is None else f"{plain(density)} kg/m³"
    hand = "outside its range" if index is None else f"{row['hand_hardness']} (index {plain(index)})"
    stress_text = "outside its range" if stress is None else f"{plain(stress)} N/mm²"
    return (
        f"density at {row['site']} ({row['source']}): {density_text}, n = {row['n']}; by published relations, not by "
        f"plate tests: hand hardness {hand} ({row['hardness_relation']}), S_f {stress_text}; none gives H_V"
    )


def _ratio_in_words(row: Json) -> str:
    ends, rebound = row["unloading_ratio_interval"], row["rebound_ratio_interval"]
    if ends:
        return f"{plain(row['unloading_ratio'])}, 95 % interval {interval(ends, style='plain')}"
    if rebound and rebound[1] > 0:
        return f"above {plain(1.0 / rebound[1])}"
    return "not resolved"


def _mean(symbol: str, kind: str, unit: str, numbers: tuple[float, list[float] | None, list[float]], over: str) -> str:
    mean, ends, extremes = numbers
    interval_words = f"95 % interval {interval(ends, style='plain')} {over}" if ends else f"no interval {over}"
    spread = " to ".join(plain(end) for end in extremes)
    return f"{symbol}: {kind} {plain(mean)} {unit}, {interval_words}, range {spread}"


def _missing_values(campaign: Json, *, has_tests: bool) -> Iterator[str]:
    if campaign["corrections"]:
        yield f"corrections applied: {len(campaign['corrections'])}"
    yield from (f"note: {note}" for note in campaign["remarks"])
    if not has_tests:
        return
    if campaign["gauge_resolution_mm"] is None:
        yield "gauge_resolution_mm is not stated: no depth uncertainty in any interval"
    keys = ("load_uncertainty_N", "moment_uncertainty_Nm", "lever_arm_uncertainty_mm")
    missing = [key for key in keys if campaign[key] is None]
    if missing:
        yield f"not stated, counted as 0: {', '.join(missing)}"


def _model_lines(penetration: Json, tag: str) -> Iterator[str]:
    yield f"{f'Laws of the force{tag}':<34}{'rmse (N)':>9}{'n - p':>9}{'free':>9}   coefficients"
    chosen = penetration["selected"]["id"]
    for row in penetration["models"]:
        mark = "*" if row["id"] == chosen else " "
        rmse = "".join(f"{plain(row[key], 4):>9}" for key in ("rmse_N", "rmse_dof_N", "rmse_free_N"))
        yield f"{mark} {row['id']:<32}{rmse}   {_law_coefficients(row)}".rstrip()
    yield f"* {penetration['selected']['reason']}"
    yield from (f"warning: {text}" for text in penetration["warnings"])


def _law_coefficients(row: Json) -> str:
    """Fitted coefficients of a law of the force, then its parameters at a bound."""
    terms = {"a": ("constant", "linear"), "b": ("constant", "linear")}
    fitted = [f"{name}0" for name, fits in terms.items() if row[name] in fits]
    fitted += [f"{name}1" for name in terms if row[name] == "linear" and row[f"{name}1"] is not None]
    text = ", ".join(f"{name} = {plain(row[name])}" for name in sorted(fitted))
    bounds = f"; at bound: {', '.join(row['at_bound'])}" if row["at_bound"] else ""
    return text + bounds


def _regression_line(row: Json) -> str:
    head = f"  {row['response']} on {row['terms'][1]}, {row['group']}, n = {row['n']}: "
    slope = plain(row["b"][1])
    if row["withheld"]:
        return f"{head}{slope}, not judged (values of the predictor: {row['predictor_values']})"
    by_site = row["interval_by_site"]
    clustered = f", by site {interval(by_site[1], style='plain')}" if by_site and by_site[1] else ""
    ends = interval(row["interval"][1], style="plain")
    return f"{head}{slope} {ends}{clustered}, {p_equals(row['p'], style='plain')}"


KINDS: Final = ("penetration", "shear")
_ENDS: Final = ("low", "high")


def analysis_figure(analysis: Analysis, what: str) -> Figure:
    """One figure of the report by its name; see `Analysis.plot`."""
    from ..figures.drawing import Drawing
    from ..figures.style import journal_style, site_styles
    from .data import ReportData
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
    """One row per experiment; see `Analysis.to_dataframe`."""
    pandas = import_extra("pandas", extra="pandas", what=Message("An analysis as a DataFrame"))
    if kind not in KINDS:
        raise ParameterError("No experiments {kind!r}. {names}").tag(
            "unknown_kind", kind=kind, names=suggest_and_list(kind, KINDS)
        )
    return pandas.DataFrame(_rows(analysis, kind))


def analysis_dataset(analysis: Analysis) -> Dataset:
    """All experiments; see `Analysis.to_xarray`."""
    xarray = import_extra("xarray", extra="xarray", what=Message("An analysis as a Dataset"))
    variables: dict[str, Any] = {}
    for kind in KINDS:
        rows = _rows(analysis, kind)
        for name in rows[0] if rows else ():
            column = np.array([math.nan if row[name] is None else row[name] for row in rows])
            unit = unit_of_name(name).symbol
            variables[f"{kind}_{name}"] = (
                f"{kind}_experiment",
                column,
                {"units": unit.replace("°", "degree")} if unit else {},
            )
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
