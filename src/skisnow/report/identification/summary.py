"""An identification as lines for a terminal."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ..formatting import significant

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...identification.result import Identification, Identified, Interval


def identify_summary(found: Identification) -> str:
    """Outcome, values with intervals, correlations, what it took."""
    lines = [f"{found.scenario}: {found.outcome.replace('_', ' ')}", found.reason, ""]
    lines += [f"{name}: {kind}" for name, kind in found.data] + [""] * bool(found.data)
    rows = [_row(each) for each in found.parameters]
    widths = [max(len(row[i]) for row in rows) for i in range(2)]
    lines += [f"{key.ljust(widths[0])}  {value.ljust(widths[1])}  {rest}".rstrip() for key, value, rest in rows]
    correlations = list(_correlations(found))
    if correlations:
        lines += ["", "correlations: " + ", ".join(correlations)]
    lines += ["", f"points {found.points}, degrees of freedom {found.degrees_of_freedom}", *found.methods]
    effort = found.effort
    kept = f", {effort.kept_simulations} kept from before" if effort.kept_simulations else ""
    lines.append(f"{effort.simulations} simulated runs{kept}, {_plain(effort.wall_s)} s")
    return "\n".join(lines)


def _row(each: Identified) -> tuple[str, str, str]:
    unit = f" {each.parameter.unit}" if each.parameter.unit else ""
    others = (
        ("profile", each.profile_interval),
        ("bootstrap", each.bootstrap_interval),
        ("posterior", each.posterior_interval),
    )
    error = each.standard_error
    more = [f"{name} {_text(interval, error)}" for name, interval in others if interval is not None]
    bound = ["on its bound"] if each.at_bound else []
    return (
        each.parameter.key,
        f"{_as_exact(each.value, error)}{unit}",
        "  ".join([_text(each.interval, error), *more, *bound]),
    )


def _text(interval: Interval | None, error: float | None) -> str:
    if interval is None:
        return "no interval"
    low, high = interval
    if high is None and low is not None:
        return f"at least {_as_exact(low, error)}"
    return f"[{_as_exact(low, error)}, {_as_exact(high, error)}]"


def _as_exact(value: float | None, error: float | None) -> str:
    """To two digits of its standard error."""
    if value is None or not error or not 1e-9 < error < 1e5:
        return _plain(value)
    return f"{value:.{max(1 - math.floor(math.log10(error)), 0)}f}"


def _correlations(found: Identification) -> Iterator[str]:
    names = [each.parameter.name for each in found.parameters]
    for i in range(len(names)):
        for j in range(i):
            r = float(found.correlation[i, j])
            if math.isfinite(r):
                yield f"{names[j]} and {names[i]} {r:.2f}"


def _plain(value: float | None, digits: int = 3) -> str:
    return significant(value, digits, style="plain")
