"""Figures of the shear experiments: the paper's Figs 7 to 11, with regression lines and machining theory."""

from __future__ import annotations

import math
from collections.abc import Sequence
from operator import itemgetter
from typing import Final

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ..._support.arrays import FloatArray
from ..._support.messages import Message
from ..._support.units import CONFIDENCE, DEGREE, MM
from ...estimation.regressions import HARDNESS_KEY, STRESS_KEY
from ...forces.shear import cutting_stress
from ...statistics.combined_uncertainty import expanded_factor
from ..figures.drawing import Drawing, LeftOut
from ..figures.style import BLACK, SitePlot, SiteStyle, logarithmic, masks, spans_a_decade
from ..formatting import counted, interval, p_equals, prose, significant
from .data import Json, ReportData, numbers

SIGNIFICANT: Final = 0.05
MOST_SENTENCES: Final = 6
FRICTION: Final = 0.2  # transverse friction of the thin machining curve, as in the paper's figure
_CURVES: Final = (
    (0.0, 1.6, Message("machining, β = 0")),
    (FRICTION, 0.7, Message("β = arctan {friction}", friction=FRICTION)),
)
_HEADROOM: Final = 2.5
_ANGLE: Final = Message("edge angle $\\vartheta$ (°)")
_STRESS: Final = Message("failure shear stress $S_\\mathrm{{f}}$ (N/mm²)")


def regression_line(row: Json, predictor: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """x, y = b₀ + b₁ x, and the ends of y ± t rmse_dof √(1/n + (x − x̄)²/Σ(x − x̄)²), at 61 places.

    row: the regression in the results. The band is NaN if it has fewer than three values.
    predictor: the values of its predictor, shape (n,), in its unit.
    """
    x = np.linspace(float(predictor.min()), float(predictor.max()), 61)
    y = row["b"][0] + row["b"][1] * x
    mean, n = float(predictor.mean()), len(predictor)
    spread = float(np.sum((predictor - mean) ** 2))
    if n < 3 or row["rmse_dof"] is None:
        return x, y, np.full_like(x, np.nan), np.full_like(x, np.nan)
    factor = float(expanded_factor(n - 2.0, CONFIDENCE))
    half_width = factor * row["rmse_dof"] * np.sqrt(1.0 / n + (x - mean) ** 2 / spread)
    return x, y, y - half_width, y + half_width


def _draw_line(
    axes: Axes, row: Json, predictor: FloatArray, *, colour: str, x_unit: float = 1.0, dashed: bool = False
) -> None:
    """Draw a regression line over its band; `x_unit` is the unit of the axis in that of the predictor."""
    x, y, low, high = regression_line(row, predictor)
    axes.fill_between(x / x_unit, low, high, color=colour, alpha=0.15, linewidth=0.0, zorder=1)
    axes.plot(x / x_unit, y, color=colour, linewidth=1.1, linestyle="--" if dashed else "-", zorder=2)


def shear_force_depth(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """Figure of failure shear force (N) against depth (mm), the paper's Fig 7, or why it is left out."""
    name = "fig07_shear_force_depth"
    if not len(data.sheared):
        return LeftOut(name, Message("Failure shear force against depth"), Message("no shear experiment is used"))
    tests, used = data.campaign.shear, data.sheared.used
    assert tests is not None  # some are used
    force, depth = numbers(data.shear, "F_t_N")[used], tests.penetration_depth[used] / MM
    labels = Message("penetration depth $e$ (mm)"), Message("failure shear force $F_\\mathrm{{t}}$ (N)")
    plot = SitePlot(data, styles, *labels, height_mm=76.0)
    plot.draw(depth, force, data.sheared.site)
    plot.start_at_zero("x", depth, 1.06)
    plot.start_at_zero("y", force, 1.08)
    caption = prose(
        "Failure shear force F_t against penetration depth of the plate (the paper's Fig. 7), by site. With one plate, "
        "points of equal S_f lie on a straight line through the origin."
    )
    alt = Message("Failure shear force in newtons against depth in millimetres, by site.")
    return Drawing(name, caption, alt, plot.finish(), points=len(force))


def varied_sites(data: ReportData) -> list[Json]:
    """Regressions of S_f on edge angle at single sites."""
    return [
        row
        for row in data.results["regressions"]
        if row["terms"][1] == "edge_angle_rad" and row["group"] != "all" and row["b"] is not None
    ]


def stress_angle(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """Failure shear stress against edge angle, with lines of significant slope (Fig 8)."""
    name, rows = "fig08_stress_angle", varied_sites(data)
    if not rows:
        reason = Message("no site has five used shear experiments at three edge angles")
        return LeftOut(name, Message("Failure shear stress against edge angle"), reason)
    chosen = np.isin(data.sheared.site, [row["group"] for row in rows])
    theta, stress, site = _edge_angles(data)[chosen], data.sheared.value[chosen], data.sheared.site[chosen]
    plot = SitePlot(data, styles, _ANGLE, _STRESS, height_mm=70.0)
    plot.draw(theta / DEGREE, stress, site, ends=data.sheared.interval[chosen])
    for style, mask in masks(styles, site):
        for row in rows:
            if row["group"] in style.sites and _is_significant(row):
                _draw_line(plot.axes, row, theta[mask & (site == row["group"])], colour=style.colour, x_unit=DEGREE)
    _scale_angle_axis(plot.axes)
    plot.start_at_zero("y", stress, 1.08)
    judgements = (
        str(Message("{site}: n = {n}, too few different angles to judge", site=row["group"], n=row["n"]))
        if row["withheld"]
        else f"{row['group']}: n = {row['n']}, {p_equals(row['p'])}"
        for row in rows[:MOST_SENTENCES]
    )
    caption = prose(
        "Failure shear stress S_f against edge angle at the sites where the angle was varied (the paper's Fig. 8), "
        "with the 95 % interval that the instruments allow. A regression line with the 95 % band of its mean is drawn "
        "only where p < 0.05. {judgements}.",
        judgements="; ".join(judgements),
    )
    alt = Message("Failure shear stress against edge angle in degrees, by site.")
    return Drawing(name, caption, alt, plot.finish(), points=len(stress))


def _edge_angles(data: ReportData) -> FloatArray:
    """Edge angle of each used shear experiment (rad)."""
    tests = data.campaign.shear
    return np.zeros(0) if tests is None else tests.edge_angle[data.sheared.used]


def _scale_angle_axis(axes: Axes) -> None:
    """Set the x axis to edge angles from 0 to 95°, with a tick every 15° up to 90°."""
    axes.set_xlim(0.0, 95.0)
    axes.set_xticks(range(0, 91, 15))


def _is_significant(row: Json) -> bool:
    """True if a regression has a p value below the level of significance."""
    return row["p"] is not None and row["p"] < SIGNIFICANT


def softest_varied(data: ReportData) -> tuple[Json, float] | None:
    """Regression of the site with varied angle whose stress at 90° is lowest, and that stress (N/mm²)."""
    upright = ((row, row["b"][0] + row["b"][1] * math.pi / 2.0) for row in varied_sites(data))
    return min((pair for pair in upright if pair[1] > 0), key=itemgetter(1), default=None)


def machining(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """Stress of the softest site against edge angle, with machining theory for two frictions (Eqn 10, Fig 9)."""
    name, softest = "fig09_machining", softest_varied(data)
    if softest is None:
        reason = Message("no site has five used shear experiments at three edge angles with a positive stress at 90°")
        return LeftOut(name, Message("Shear stress against machining theory"), reason)
    row, upright = softest
    at_site = data.sheared.site == row["group"]
    stress = data.sheared.value[at_site]
    plot = SitePlot(data, styles, _ANGLE, r"$F_\mathrm{t}/(L\,e)$ (N/mm²)", height_mm=70.0)
    plot.draw(_edge_angles(data)[at_site] / DEGREE, stress, data.sheared.site[at_site])
    theta = np.linspace(2.0, 90.0, 400)
    for friction, width, label in _CURVES:
        curve = cutting_stress(upright / 2.0, theta * DEGREE, transverse_friction=friction)
        plot.axes.plot(theta, curve, color=BLACK, linewidth=width, zorder=2)
        plot.handles.append(Line2D([], [], color=BLACK, linewidth=width, label=label))
    _scale_angle_axis(plot.axes)
    plot.axes.set_ylim(0.0, _HEADROOM * max(float(stress.max()), upright))
    caption = prose(
        "Tangential stress F_t/(L e) at {site}, the softest site of varied edge angle, against machining theory (Eqn "
        "10; the paper's Fig. 9). S = {S} N/mm² is half of the regression's {upright} N/mm² at 90° (S_f = 2 S there "
        "without friction): a choice that makes the thick curve, β = 0, meet the data at 90°; thin: β = arctan 0.2.",
        site=row["group"],
        S=significant(upright / 2.0),
        upright=significant(upright),
    )
    alt = Message("Shear stress of one site against edge angle, with two curves of machining.")
    return Drawing(name, caption, alt, plot.finish())


def stress_density(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """Failure shear stress against density with the regression line over all sites (Fig 10)."""
    name, title = "fig10_stress_density", Message("Failure shear stress against density")
    if not len(data.sheared):
        return LeftOut(name, title, Message("no shear experiment is used"))
    tests, finite = data.sheared, np.isfinite(data.sheared.density)
    if not finite.any():
        return LeftOut(name, title, Message("the campaign gives no snow density at its shear experiments"))
    density, stress = tests.density[finite], tests.value[finite]
    plot = SitePlot(data, styles, Message("snow density $\\rho$ (kg/m³)"), _STRESS, height_mm=76.0)
    plot.draw(density, stress, tests.site[finite])
    row = data.regression("S_f_N_per_mm2", "snow_density_kg_per_m3")
    if row is not None:
        _draw_line(plot.axes, row, density, colour=BLACK, dashed=not _is_significant(row))
    plot.start_at_zero("y", stress, 1.08)
    caption = prose("Failure shear stress S_f against density (the paper's Fig. 10), by site.")
    caption += _line_in_words(row) if row else ""
    alt = Message("Failure shear stress against snow density with a regression line, by site.")
    return Drawing(name, caption, alt, plot.finish(), points=len(stress))


def _line_in_words(row: Json) -> Markup:
    """Sentences with a regression line on density ρ, its judgement and, by sites, its interval."""
    if row["withheld"]:
        judgement: str = Message("dashed because too few different densities allow no judgement")
    elif _is_significant(row):
        judgement = p_equals(row["p"])
    else:
        judgement = Message("{p}, dashed because not significant", p=p_equals(row["p"]))
    sentence = prose(
        " Line: {intercept} {sign} {slope} ρ, n = {n}, {judgement}; band: 95 % interval of its mean, as if all "
        "experiments were independent.",
        intercept=significant(row["b"][0]),
        sign="−" if row["b"][1] < 0 else "+",
        slope=significant(abs(row["b"][1])),
        n=row["n"],
        judgement=judgement,
    )
    if row["interval_by_site"] and row["interval_by_site"][1]:
        ends = interval(row["interval_by_site"][1])
        sentence += prose(" With sites as clusters the slope's interval is {ends}.", ends=ends)
    return sentence


def stress_hardness(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """Failure shear stress against snow hardness, one point for each spot with both (Fig 11)."""
    name, spots = "fig11_stress_hardness", data.analysis.observations["spots"]
    if not spots.site:
        reason = Message("no spot has both a used penetration and a used shear experiment")
        return LeftOut(name, Message("Failure shear stress against snow hardness"), reason)
    hardness, stress = spots.columns[HARDNESS_KEY], spots.columns[STRESS_KEY]
    xlabel = Message("snow hardness $H_\\mathrm{{V}}$ (N/mm³)")
    plot = SitePlot(data, styles, xlabel, _STRESS, height_mm=70.0)
    plot.draw(hardness, stress, np.array(spots.site))
    if spans_a_decade(hardness):
        logarithmic(plot.axes, "x", hardness)
    plot.start_at_zero("y", stress, 1.08)
    row = data.regression("S_f_N_per_mm2", "H_V_N_per_mm3")
    caption = prose(
        "Failure shear stress S_f against snow hardness H_V at {spots} (the paper's Fig. 11): geometric mean of H_V "
        "and mean of S_f over the used experiments of a spot.",
        spots=counted(len(spots.site), "{count} spot", "{count} spots"),
    )
    if row and row["p"] is not None:
        caption += prose(" Linear regression: {p}.", p=p_equals(row["p"]))
    alt = Message("Failure shear stress against snow hardness, one point for each spot.")
    return Drawing(name, caption, alt, plot.finish(), points=len(stress))
