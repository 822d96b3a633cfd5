"""Tables of an identification."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..table import Column, Table

if TYPE_CHECKING:
    from ...identification.result import Identification, Interval


def parameters_table(found: Identification) -> Table:
    """Values, intervals, bounds, priors."""
    return Table(
        "identified",
        "What was identified, with 95 % intervals; a dash: not asked for, or open.",
        (
            Column("key", "Key", "text"),
            Column("value", "Value", digits=4),
            Column("unit", "Unit", "text"),
            Column("interval", "Interval by curvature", "interval"),
            Column("profile", "By profile", "interval"),
            Column("bootstrap", "By bootstrap", "interval"),
            Column("posterior", "Posterior", "interval"),
            Column("start", "Start"),
            Column("bounds", "Bounds", "range"),
            Column("prior_mean", "Prior mean"),
            Column("prior_sd", "Prior s.d."),
        ),
        [
            (
                each.parameter.key, each.value, each.parameter.unit, _pair(each.interval), _pair(each.profile_interval),
                _pair(each.bootstrap_interval), _pair(each.posterior_interval), each.parameter.start,
                [each.parameter.lower, each.parameter.upper], each.parameter.prior_mean, each.parameter.prior_sd,
            )
            for each in found.parameters
        ],
    )  # fmt: skip


def correlation_table(found: Identification) -> Table:
    """Correlations of the estimates."""
    names = [each.parameter.name for each in found.parameters]
    rows = [
        (names[i], *(float(r) if np.isfinite(r) else None for r in found.correlation[i])) for i in range(len(names))
    ]
    return Table(
        "correlation",
        "Correlations of the estimates. Beyond ±0.9 two parameters are hardly told apart.",
        (Column("parameter", "Parameter", "text"), *(Column(name, name.replace("_", " ")) for name in names)),
        rows,
    )


def _pair(interval: Interval | None) -> list[float] | None:
    if interval is None or interval[0] is None or interval[1] is None:
        return None
    return [interval[0], interval[1]]
