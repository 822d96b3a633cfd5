"""H_V and S_f site by site, and over all."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...estimate.comparisons import OwnValue, own_mean
from ..table import Column, Table

if TYPE_CHECKING:
    from ..report_data import FloatArray, ReportData, TextArray

COLUMNS = (
    Column("site", "Site", "text"),
    Column("penetration_n", "penetration tests", "count"),
    Column("penetration_used", "used", "count"),
    Column("H_V_N_per_mm3", "H_V, geometric mean", "estimate", "N/mm³"),
    Column("H_V_range_N_per_mm3", "H_V, range", "range", "N/mm³"),
    Column("shear_n", "shear tests", "count"),
    Column("shear_used", "used", "count"),
    Column("S_f_N_per_mm2", "S_f, mean", "estimate", "N/mm²"),
    Column("S_f_range_N_per_mm2", "S_f, range", "range", "N/mm²"),
)


def sites_table(data: ReportData) -> Table:
    """A row for each site; with several sites a last row for all."""
    pressed, sheared = _all_sites(data.penetration), _all_sites(data.shear)
    hardness = _by_site(data.hardness, data.penetration_site)
    stress = _by_site(data.stress, data.shear_site)
    rows = [
        _row(site, pressed.get(site, 0), hardness.get(site), sheared.get(site, 0), stress.get(site))
        for site in data.sites
    ]
    if len(data.sites) > 1:
        rows.append(
            _row(
                "all sites",
                len(data.penetration),
                (data.hardness, data.penetration_site),
                len(data.shear),
                (data.stress, data.shear_site),
            )
        )
    return Table(
        "sites",
        "Snow hardness and failure shear stress by site, with 95 % intervals of the means.",
        COLUMNS,
        rows,
        note="The interval of a site comes from the scatter between its experiments; that of all sites from the "
        "scatter between sites, and is withheld for fewer than four. H_V spans decades, so its mean is the geometric "
        "one. All intervals are computed on "
        "logarithms: no bound is negative.",
    )


def _all_sites(rows: list[dict[str, Any]]) -> dict[str, int]:
    counts: dict[str, int] = {}
    for row in rows:
        counts[row["site"]] = counts.get(row["site"], 0) + 1
    return counts


def _by_site(values: FloatArray, site: TextArray) -> dict[str, tuple[FloatArray, TextArray]]:
    order = np.argsort(site, kind="stable")
    names, starts = np.unique(site[order], return_index=True)
    parts = np.split(order, starts[1:])
    return (
        {str(name): (values[part], site[part]) for name, part in zip(names, parts, strict=True)} if len(names) else {}
    )


def _row(
    site: str,
    n_pressed: int,
    hardness: tuple[FloatArray, TextArray] | None,
    n_sheared: int,
    stress: tuple[FloatArray, TextArray] | None,
) -> tuple[Any, ...]:
    return (site, n_pressed, *_summary(hardness, geometric=True), n_sheared, *_summary(stress, geometric=False))


def _summary(values_by_site: tuple[FloatArray, TextArray] | None, *, geometric: bool) -> tuple[Any, ...]:
    if values_by_site is None or len(values_by_site[0]) == 0:
        return 0, (None, None), None
    values, site = values_by_site
    own: OwnValue = own_mean(values, site.tolist(), geometric=geometric)
    known = bool(np.isfinite(own.low) and np.isfinite(own.high))
    value = own.value if np.isfinite(own.value) else None
    spread = (own.minimum, own.maximum) if np.isfinite(own.minimum) else None
    return len(values), (value, (own.low, own.high) if known else None), spread
