"""Findings of a campaign as sentences in HTML: caveats, models, seating, unloading."""

from __future__ import annotations

import numpy as np
from markupsafe import Markup

from ..._support.messages import Message
from ..formatting import html, prose, significant, whole
from .data import ReportData, numbers, pairs
from .series_tables import count_resolved_offsets


def caveats(data: ReportData) -> list[Markup]:
    """Warnings, missing uncertainties, remarks and missing data."""
    remarks = data.results["campaign"]["remarks"]
    warnings = data.results["penetration"]["warnings"]
    return [html(sentence) for sentence in (*warnings, *_missing_uncertainties(data), *remarks, *_missing_data(data))]


def _missing_uncertainties(data: ReportData) -> list[str]:
    campaign = data.results["campaign"]
    sentences: list[str] = []
    if campaign["gauge_resolution_mm"] is None and (data.penetration or data.shear):
        sentences.append(
            Message(
                "The gauge's resolution is not stated: no interval carries a depth uncertainty, and no experiment "
                "could be flagged as below the resolution. Where depths are small the intervals are then too narrow."
            )
        )
    uncertainties = (
        (
            "load_uncertainty_N",
            Message("The uncertainty of the loads is not stated; it counts as 0."),
            data.penetration,
        ),
        ("moment_uncertainty_Nm", Message("The uncertainty of the moments is not stated; it counts as 0."), data.shear),
        (
            "lever_arm_uncertainty_mm",
            Message("The uncertainty of the lever arms is not stated; it counts as 0."),
            data.shear,
        ),
    )
    sentences += [sentence for key, sentence, tests in uncertainties if tests and campaign[key] is None]
    if data.shear and all(row["S_f_interval_N_per_mm2"] is None for row in data.shear):
        sentences.append(
            Message("No uncertainty that bears on a shear test is stated, so S_f has no intervals for single tests.")
        )
    return sentences


def _missing_data(data: ReportData) -> list[str]:
    sentences: list[str] = []
    if not data.penetration:
        sentences.append(
            Message("The campaign has no penetration experiments: there is no H_V and no choice between laws.")
        )
    if not data.shear:
        sentences.append(Message("The campaign has no shear experiments: there is no S_f."))
    densities = np.concatenate((data.pressed.density, data.sheared.density))
    if not np.isfinite(densities).any():
        sentences.append(
            Message("No snow density is given at a used experiment: the regressions on density have no data.")
        )
    tests = data.campaign.penetration
    if data.campaign.drop_cone is None and (tests is None or not np.isfinite(tests.drop_cone_depth).any()):
        sentences.append(Message("No drop-cone test is given: the regression of H_V on drop-cone depth has no data."))
    if data.results["provenance"]["options"]["geometry"] == "paper":
        sentences.append(
            Message(
                "The paper's plain wedge was chosen: an edged tool counts as a wedge at every depth, also where its "
                "base is under the surface (flagged beyond_tool)."
            )
        )
    return sentences


def readings_used(data: ReportData) -> Markup:
    """Numbers of readings and series behind the nine candidate models."""
    row = data.results["penetration"]["models"][0]
    return prose(
        "All nine candidate models are fitted to the same {n} readings of {m} series. With b = 1 the last residual of "
        "a series is zero by definition, because its reading defines the hardness: the RMSE without the defining "
        "reading leaves these out and divides by n − m = {free}.",
        n=whole(row["n"]),
        m=whole(row["n_series"]),
        free=whole(row["n"] - row["n_series"]),
    )


def procedure_comparison(data: ReportData) -> Markup:
    """Ratio of H_V by the two procedures over the used series."""
    largest_load = numbers(data.penetration, "H_V_N_per_mm3")
    fitted = numbers(data.results["penetration"]["errors_in_depth"]["experiments"], "H_V_N_per_mm3")
    comparable = data.pressed.used & np.isfinite(largest_load) & np.isfinite(fitted)
    if not comparable.any():
        return html("")
    low, median, high = np.percentile(fitted[comparable] / largest_load[comparable], (5.0, 50.0, 95.0)).tolist()
    return prose(
        "H_V from all readings over H_V from the largest load: median {middle}, 90 % of the series between {low} and "
        "{high}. {file} lists both values of each experiment.",
        low=significant(low),
        middle=significant(median),
        high=significant(high),
        file=_table_file("hardness_by_procedure", data),
    )


def seating_findings(data: ReportData) -> list[Markup]:
    """Size of the depth offsets and number of those that differ from zero."""
    rows = data.seating
    without = int(data.pressed.used.sum()) - len(rows)
    if not rows:
        return [prose("No used series has the readings that an offset can be estimated from.")]
    half_widths = np.diff(pairs(rows, "interval_mm"), axis=1) / 2.0
    sentences = [
        prose(
            "{shown} of {all} used series have an offset whose 95 % interval excludes zero; the median half-width of "
            "the intervals is {half} mm. {file} lists every offset.",
            shown=whole(count_resolved_offsets(rows)),
            all=whole(len(rows)),
            half=significant(float(np.nanmedian(half_widths))),
            file=_table_file("seating", data),
        )
    ]
    if without:
        sentences.append(prose("For {n} used series no offset could be estimated.", n=whole(without)))
    return sentences


def unloading_findings(data: ReportData) -> list[Markup]:
    """Number of series whose k_u / H_V has an upper end."""
    used = [row for row in data.unloaded if row["used"]]
    if not used:
        return [prose("No used series was unloaded.")]
    resolved = [row for row in used if row["unloading_ratio_interval"] is not None]
    return [
        prose(
            "{resolved} of {all} used series with unloading give both ends of k_u / H_V; of the others only the lower "
            "end is known, the inverse of the upper end of H_V / k_u. {file} lists every series.",
            resolved=whole(len(resolved)),
            all=whole(len(used)),
            file=_table_file("unloading", data),
        )
    ]


def _table_file(name: str, data: ReportData) -> Markup:
    return Markup("<code>tables/{}{}.csv</code>").format(name, "_synthetic" if data.synthetic else "")
