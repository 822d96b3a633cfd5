"""What the campaign did not state or does not have, and what that does to the numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..symbols import html

if TYPE_CHECKING:
    from markupsafe import Markup

    from ..report_data import ReportData


def caveats(data: ReportData) -> list[Markup]:
    """Sentences, most weighty first."""
    notes = data.results["campaign"]["remarks"]
    fits = data.results["penetration"]["warnings"]
    return [html(sentence) for sentence in (*fits, *_not_stated(data), *notes, *_not_there(data))]


def _not_stated(data: ReportData) -> list[str]:
    campaign = data.results["campaign"]
    found = []
    if campaign["gauge_resolution_mm"] is None:
        found.append(
            "The gauge's resolution is not stated: no interval carries a depth uncertainty, and no experiment could be "
            "flagged as below the resolution. Where depths are small the intervals are then too narrow."
        )
    stated = (
        ("load_uncertainty_N", "uncertainty of the loads", bool(data.penetration)),
        ("moment_uncertainty_Nm", "uncertainty of the moments", bool(data.shear)),
        ("lever_arm_uncertainty_mm", "uncertainty of the lever arms", bool(data.shear)),
    )
    missing = [name for key, name, matters in stated if matters and campaign[key] is None]
    found += [f"The {name} is not stated; it counts as 0." for name in missing]
    if data.shear and all(row["S_f_interval_N_per_mm2"] is None for row in data.shear):
        found.append("No uncertainty that bears on a shear test is stated, so S_f has no intervals for single tests.")
    return found


def _not_there(data: ReportData) -> list[str]:
    campaign, found = data.campaign, []
    if not data.penetration:
        found.append("The campaign has no penetration experiments: there is no H_V and no choice between laws.")
    if not data.shear:
        found.append("The campaign has no shear experiments: there is no S_f.")
    densities = np.concatenate((data.penetration_density, data.shear_density))
    if not np.isfinite(densities).any():
        found.append("No snow density is given at a used experiment: the regressions on density have no data.")
    if campaign.drop_cone is None and not _has_drop_cone(data):
        found.append("No drop-cone test is given: the regression of H_V on drop-cone depth has no data.")
    if data.results["provenance"]["options"]["geometry"] == "paper":
        found.append(
            "The paper's plain wedge was chosen: an edged tool counts as a wedge at every depth, also where its base "
            "is under the surface (flagged beyond_tool)."
        )
    return found


def _has_drop_cone(data: ReportData) -> bool:
    tests = data.campaign.penetration
    return tests is not None and bool(np.isfinite(tests.drop_cone_depth).any())
