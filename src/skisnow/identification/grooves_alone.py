"""Measured grooves without a track over time: whether the edge held or slid decides what they say of S_f."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.stats import chi2, norm

from .groove_residuals import STRENGTH, GrooveResiduals
from .parameter import Parameter
from .problem import problem_of
from .result import REASONS, Identification, Identified, Outcome
from .solution import identification_of, too_few
from .solving import Request, solution_of, solved, with_further_intervals

FloatArray = npt.NDArray[np.float64]

SLID: Final = 0.01
"""Probability below which grooves are not those of an edge that held (modelling assumption)."""
_ONE_SIDED: Final = 0.95


def grooves_alone(parameters: Sequence[Parameter], grooves: GrooveResiduals, plan: Request) -> Identification:
    """Identify from measured grooves.

    Notes
    -----
    Where S_f is looked for, the grooves are first compared with a ski whose edge holds, without S_f. If they go with
    it, S_f can be anything above what the turn needed: a bound from below, no value. If the path is wider than the ski
    carves by itself beyond chance (1 %), the edge slid: then S_f is what it gave.
    """
    strength = next((parameter for parameter in parameters if parameter.key == STRENGTH), None)
    if strength is None:
        return solved(problem_of(tuple(parameters), (grooves,)), plan)
    others = tuple(parameter for parameter in parameters if parameter is not strength)
    if _slid(others, grooves, plan):
        return _sliding(tuple(parameters), strength, grooves, plan)
    return _holding(others, tuple(parameters), strength, grooves, plan)


def _slid(others: tuple[Parameter, ...], grooves: GrooveResiduals, plan: Request) -> bool:
    """Whether the measured radius is larger than that of an edge that holds, beyond chance."""
    if not math.isfinite(grooves.mean_radius):
        return False
    if not others:
        residuals, values, dof = grooves.residuals([{}])[0], {}, grooves.points
    else:
        problem = problem_of(others, (grooves,))
        if problem.points <= len(others):
            return False
        solution = solution_of(problem, replace(plan, starts=1, progress=lambda _: None))
        values = problem.values(solution.found.place)
        residuals, dof = grooves.residuals([values])[0], problem.points - len(others)
    groove = grooves.groove(values)
    if residuals is None or groove is None:
        return False
    worse = float(chi2.sf(float(residuals @ residuals), dof)) < SLID
    return worse and grooves.mean_radius > groove.turn_radius


def _sliding(
    parameters: tuple[Parameter, ...], strength: Parameter, grooves: GrooveResiduals, plan: Request
) -> Identification:
    sliding = replace(grooves, slides=True)
    begin = sliding.strength_for({}, grooves.mean_radius)
    own = strength
    if begin is not None and strength.lower < begin < strength.upper:
        own = replace(strength, start=begin)
    chosen = tuple(own if parameter is strength else parameter for parameter in parameters)
    method = (
        "the radius is wider than this ski carves at this edge angle: the edge slid, and S_f follows from the side "
        "force that the turn needed; the width, swept sideways, was not used"
    )
    problem = problem_of(chosen, (sliding,))
    plan = replace(plan, methods=(*plan.methods, method))
    if problem.points < len(chosen):
        return too_few(problem, plan.title, plan.warnings)
    return solved(problem, plan)


def _holding(
    others: tuple[Parameter, ...],
    parameters: tuple[Parameter, ...],
    strength: Parameter,
    grooves: GrooveResiduals,
    plan: Request,
) -> Identification:
    """Identify the others; S_f is bounded from below by what the turn needed."""
    found = _others(others, grooves, plan) if others else _nothing_else(grooves, plan)
    values = {key: value for key, value in found.values.items() if value is not None}
    bound, low = _bound(grooves, values, found)
    needed = "says nothing" if bound is None or low is None else f"needed {bound:.3g} N/mm² (95 %: at least {low:.3g})"
    warning = (
        f"the grooves go with an edge that held, so S_f is bounded from below alone: the turn {needed}. A turn in "
        "which the edge slides, or a shear test, gives its value"
    )
    held = Identified(parameter=strength, interval=(low, None), identifiable=False)
    entries = {identified.parameter.key: identified for identified in found.parameters} | {STRENGTH: held}
    p = len(parameters)
    places = [i for i, parameter in enumerate(parameters) if parameter is not strength]
    correlation, covariance = (np.full((p, p), np.nan) for _ in range(2))
    correlation[np.ix_(places, places)] = found.correlation
    covariance[np.ix_(places, places)] = found.covariance
    outcome: Outcome = "interrupted" if found.outcome == "interrupted" else "not_identifiable"
    return replace(
        found,
        outcome=outcome,
        reason=REASONS[outcome],
        parameters=tuple(entries[parameter.key] for parameter in parameters),
        correlation=correlation,
        covariance=covariance,
        bootstrap=_with_gaps(found.bootstrap, places, p),
        posterior=_with_gaps(found.posterior, places, p),
        warnings=(warning, *found.warnings),
    )


def _others(others: tuple[Parameter, ...], grooves: GrooveResiduals, plan: Request) -> Identification:
    solution = solution_of(problem_of(others, (grooves,)), plan)
    found = identification_of(solution, plan.title, plan.warnings, plan.methods)
    return with_further_intervals(found, solution, plan)


def _nothing_else(grooves: GrooveResiduals, plan: Request) -> Identification:
    """The scenario's own ski and snow compared with the grooves; there is nothing to look for."""
    problem = problem_of((), (grooves,))
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
    """Samples of some parameters as samples of all, NaN if the value is missing."""
    if samples is None:
        return None
    found = np.full((len(samples), count), np.nan)
    found[:, places] = samples
    return found


def _bound(
    grooves: GrooveResiduals, values: dict[str, float], identification: Identification
) -> tuple[float | None, float | None]:
    """S_f that the turn needed (N/mm²), and the lower end of its one-sided 95 % interval."""
    radius = grooves.mean_radius
    bound = grooves.strength_for(values, radius) if math.isfinite(radius) else None
    if bound is None:
        return None, None
    keys = [identified.parameter.key for identified in identification.parameters]
    slopes = []
    for key in keys:
        step = 0.01 * values[key]
        moved = grooves.strength_for({**values, key: values[key] + step}, radius)
        slopes.append(0.0 if moved is None or step == 0.0 else (moved - bound) / step)
    slope = np.array(slopes)
    wider = grooves.strength_for(values, radius + grooves.mean_radius_sd)
    variance = (0.0 if wider is None else (wider - bound) ** 2) + float(
        slope @ np.nan_to_num(identification.covariance, posinf=0.0) @ slope if keys else 0.0
    )
    return bound, max(bound - float(norm.ppf(_ONE_SIDED)) * math.sqrt(variance), 0.0)
