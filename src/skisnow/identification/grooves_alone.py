"""Identification from measured grooves only: whether the edge held or slid decides what can be estimated."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from scipy.stats import chi2, norm

from .._support.arrays import FloatArray
from .groove_residuals import STRENGTH_KEY, GrooveResiduals
from .parameter import Parameter
from .problem import unweighted_problem
from .result import REASONS, Identification, Identified, Outcome
from .solution import SearchRequest, too_few_points
from .solving import Solver, solve

SLIDING_PROBABILITY: Final = 0.01
"""Probability of the grooves, given an edge that holds, below which the edge is assumed to have slid."""
_ONE_SIDED: Final = 0.95


def identify_from_grooves(
    parameters: Sequence[Parameter], grooves: GrooveResiduals, plan: SearchRequest
) -> Identification:
    """Identify from measured grooves.

    If S_f is free, the grooves are first compared with those of a ski whose edge holds, which do not depend on S_f. If
    they agree, the turn gives only a lower bound of S_f. If the measured radius is significantly larger (1 %) than the
    radius of the carving ski, the edge slid, and S_f follows from the side force.
    """
    strength = next((parameter for parameter in parameters if parameter.key == STRENGTH_KEY), None)
    if strength is None:
        return solve(unweighted_problem(tuple(parameters), (grooves,)), plan)
    others = tuple(parameter for parameter in parameters if parameter is not strength)
    if _edge_slid(others, grooves, plan):
        return _identify_sliding(tuple(parameters), strength, grooves, plan)
    return _identify_holding(others, tuple(parameters), strength, grooves, plan)


def _edge_slid(others: tuple[Parameter, ...], grooves: GrooveResiduals, plan: SearchRequest) -> bool:
    """True if the measured radius is significantly larger than that of an edge that holds."""
    mean_radius, _ = grooves.mean_radius
    if not math.isfinite(mean_radius):
        return False
    if not others:
        residuals, values, dof = grooves.residuals([{}])[0], {}, grooves.points
    else:
        problem = unweighted_problem(others, (grooves,))
        if problem.points <= len(others):
            return False
        solution = Solver(problem, replace(plan, starts=1, progress=lambda _: None)).solution()
        values = problem.values(solution.optimum.place)
        residuals, dof = grooves.residuals([values])[0], problem.points - len(others)
    groove = grooves.groove(values)
    if residuals is None or groove is None:
        return False
    worse = float(chi2.sf(float(residuals @ residuals), dof)) < SLIDING_PROBABILITY
    return worse and mean_radius > groove.turn_radius


def _identify_sliding(
    parameters: tuple[Parameter, ...], strength: Parameter, grooves: GrooveResiduals, plan: SearchRequest
) -> Identification:
    sliding = replace(grooves, slides=True)
    begin = sliding.required_strength({}, grooves.mean_radius[0])
    own = strength
    if begin is not None and strength.lower < begin < strength.upper:
        own = replace(strength, start=begin)
    chosen = tuple(own if parameter is strength else parameter for parameter in parameters)
    method = (
        "the radius is wider than this ski carves at this edge angle: the edge slid, and S_f follows from the side "
        "force that the turn needed; the width, swept sideways, was not used"
    )
    problem = unweighted_problem(chosen, (sliding,))
    plan = replace(plan, methods=(*plan.methods, method))
    if problem.points < len(chosen):
        return too_few_points(problem, plan)
    return solve(problem, plan)


def _identify_holding(
    others: tuple[Parameter, ...],
    parameters: tuple[Parameter, ...],
    strength: Parameter,
    grooves: GrooveResiduals,
    plan: SearchRequest,
) -> Identification:
    """Identify the other parameters; the turn gives a lower bound of S_f."""
    identification = solve(unweighted_problem(others, (grooves,)), plan) if others else _compare_only(grooves, plan)
    values = {key: value for key, value in identification.values.items() if value is not None}
    bound, low = _strength_bound(grooves, values, identification)
    needed = "says nothing" if bound is None or low is None else f"needed {bound:.3g} N/mm² (95 %: at least {low:.3g})"
    warning = (
        f"the grooves go with an edge that held, so S_f is bounded from below alone: the turn {needed}. A turn in "
        "which the edge slides, or a shear test, gives its value"
    )
    held = Identified(parameter=strength, interval=(low, None), identifiable=False)
    entries = {identified.parameter.key: identified for identified in identification.parameters} | {STRENGTH_KEY: held}
    p = len(parameters)
    places = [i for i, parameter in enumerate(parameters) if parameter is not strength]
    correlation, covariance = (np.full((p, p), np.nan) for _ in range(2))
    correlation[np.ix_(places, places)] = identification.correlation
    covariance[np.ix_(places, places)] = identification.covariance
    outcome: Outcome = "interrupted" if identification.outcome == "interrupted" else "not_identifiable"
    return replace(
        identification,
        outcome=outcome,
        reason=REASONS[outcome],
        parameters=tuple(entries[parameter.key] for parameter in parameters),
        correlation=correlation,
        covariance=covariance,
        bootstrap=_with_gaps(identification.bootstrap, places, p),
        posterior=_with_gaps(identification.posterior, places, p),
        warnings=(warning, *identification.warnings),
    )


def _compare_only(grooves: GrooveResiduals, plan: SearchRequest) -> Identification:
    """Comparison of the scenario's ski and snow with the grooves, without free parameters."""
    problem = unweighted_problem((), (grooves,))
    residuals = grooves.residuals([{}])[0]
    if residuals is not None:
        problem = problem.with_noise_of(residuals)
    return Identification(
        outcome="not_identifiable",
        reason=REASONS["not_identifiable"],
        scenario=plan.title,
        parameters=(),
        correlation=np.zeros((0, 0)),
        covariance=np.zeros((0, 0)),
        noise=problem.noise,
        accuracy_is_stated=problem.accuracy_is_stated,
        points=problem.points,
        degrees_of_freedom=problem.points,
        warnings=(*plan.warnings, *grooves.warnings({})),
        methods=(*plan.methods, "every other value is the scenario's own: nothing was searched for"),
        fits=grooves.fits({}),
    )


def _with_gaps(samples: FloatArray | None, places: Sequence[int], count: int) -> FloatArray | None:
    """Samples of some parameters as samples of all `count` parameters; NaN for the missing ones."""
    if samples is None:
        return None
    extended = np.full((len(samples), count), np.nan)
    extended[:, places] = samples
    return extended


def _strength_bound(
    grooves: GrooveResiduals, values: dict[str, float], identification: Identification
) -> tuple[float | None, float | None]:
    """S_f that the turn needed (N/mm²), and the lower end of its one-sided 95 % interval."""
    radius, radius_sd = grooves.mean_radius
    bound = grooves.required_strength(values, radius) if math.isfinite(radius) else None
    if bound is None:
        return None, None
    keys = [identified.parameter.key for identified in identification.parameters]
    slopes = []
    for key in keys:
        step = 0.01 * values[key]
        moved = grooves.required_strength({**values, key: values[key] + step}, radius)
        slopes.append(0.0 if moved is None or step == 0.0 else (moved - bound) / step)
    slope = np.array(slopes)
    wider = grooves.required_strength(values, radius + radius_sd)
    variance = (0.0 if wider is None else (wider - bound) ** 2) + float(
        slope @ np.nan_to_num(identification.covariance, posinf=0.0) @ slope if keys else 0.0
    )
    return bound, max(bound - float(norm.ppf(_ONE_SIDED)) * math.sqrt(variance), 0.0)
