"""Uncertainty of identified parameters from the curvature of the sum of squares, and warnings about it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Final

import numpy as np
from scipy.stats import norm, t

from .._support.arrays import BoolArray, FloatArray
from .._support.messages import Message
from .._support.units import CONFIDENCE
from .parameter import Parameter

SINGULAR: Final = 1e-6
"""A singular value of the scaled Jacobian below this share of the largest counts as 0."""
WIDEST_HALF_INTERVAL: Final = 1.5
"""Half-width of an interval, in sizes of its parameter, above which the parameter counts as undetermined."""
LEAST_SHARE: Final = 0.2
"""Smallest component of an undetermined direction for which a parameter belongs to its group."""
REPORTED_PAIR_CORRELATION: Final = 0.9
"""Correlation above which two parameters get a warning."""
_HELPS: Final = {
    frozenset({"friction.mu_0", "drag.drag_area_m2"}): Message(
        "both brake; only drag grows with the speed. Runs on slopes of different inclination, slow and fast parts, "
        "and a known start speed distinguish them"
    ),
    frozenset({"friction.mu_0", "friction.mu_1_s_per_m"}): Message(
        "they differ only where the speed does. A wider range of speeds distinguishes them, or fix mu_1"
    ),
    frozenset({"friction.mu_1_s_per_m", "drag.drag_area_m2"}): Message(
        "both grow with the speed, one with its square. A wider range of speeds on different inclinations "
        "distinguishes them, or a drag area from a wind tunnel as a prior"
    ),
    frozenset({"friction.mu_0", "slope.angle_deg"}): Message(
        "a steeper slope drives as less friction does. Measure the slope's inclination and fix it"
    ),
    frozenset({"friction.mu_0", "start.speed_m_per_s"}): Message(
        "early and late parts of the run must differ for it. Measure the speed at the start, or the path for longer"
    ),
    frozenset({"drag.drag_area_m2", "sledge.mass_kg"}): Message(
        "drag acts as C_dA over mass. Weigh the skier and fix the mass"
    ),
    frozenset({"drag.drag_area_m2", "drag.air_density_kg_per_m3"}): Message(
        "only their product acts. Fix the air's density"
    ),
    frozenset({"snow.S_f_N_per_mm2", "snow.H_V_N_per_mm3"}): Message(
        "grip is S_f times the depth, and H_V sets the depth. A penetration test gives H_V"
    ),
    frozenset({"snow.S_f_N_per_mm2", "snow.shear_displacement_mm"}): Message(
        "an edge that holds yields in proportion to u_y over S_f. A run that slips, or a shear test with its turning "
        "angle, distinguishes them"
    ),
    frozenset({"snow.H_V_N_per_mm3", "sledge.edge_angle_deg"}): Message(
        "a ski that cuts deeper bends more and turns tighter, as one on a larger edge angle does. Measure the edge "
        "angle"
    ),
    frozenset({"start.heading_deg", "sledge.edge_angle_deg"}): Message(
        "a turn that begins later looks like a tighter one. A longer track distinguishes them"
    ),
}
_ALONE: Final = {
    "snow.S_f_N_per_mm2": Message(
        "S_f has an effect only where the edge side-slips; an edge with grip bounds it from below. A run that skids, "
        "a tighter turn or a shear test determines it"
    ),
    "snow.H_V_N_per_mm3": Message(
        "The path hardly depends on the depth of the groove. A penetration test determines it"
    ),
    "drag.drag_area_m2": Message("At these speeds drag is too small. A faster run determines it"),
    "snow.shear_displacement_mm": Message(
        "An edge that hardly yields shows no u_y. A tighter turn determines it, or a shear test with its turning angle"
    ),
    "snow.unloading_ratio": Message("The path hardly depends on how the groove springs back. Fix it"),
}
_FIX_IT: Final = Message("Fix it, or give it a prior from elsewhere")
_COMMON: Final = Message("fix one of them, give it a prior from elsewhere, or add a run in which they act differently")


@dataclass(frozen=True, slots=True, eq=False)
class Uncertainty:
    """Uncertainty of p parameters, in their sizes.

    covariance: (p, p); infinite on the diagonal for undetermined parameters.
    correlation: (p, p); NaN for undetermined parameters.
    factor: Half-width of a 95 % interval over the standard error.
    unknown: (p,) True if the data do not determine the parameter.
    groups: numbers of the parameters of which only a combination is determined; a single one has no effect on the data.
    alone: (p,) standard errors if all other parameters were known; infinite without effect.
    """

    covariance: FloatArray
    correlation: FloatArray
    factor: float
    unknown: BoolArray
    groups: tuple[tuple[int, ...], ...]
    alone: FloatArray

    @property
    def standard_errors(self) -> FloatArray:
        """Standard errors (p,), in the sizes of the parameters."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))


def linear_uncertainty(jacobian: FloatArray, *, degrees_of_freedom: float | None) -> Uncertainty:
    """Uncertainty by linearisation, from the derivatives of residuals divided by their standard deviations.

    jacobian: (n, p), with respect to parameters in their sizes.
    degrees_of_freedom: degrees of freedom of the estimate of the noise, for Student's t; None if the noise is stated.

    Two readings of one number, each with standard deviation 1: its standard error is 1/√2.

    >>> estimate = linear_uncertainty(np.ones((2, 1)), degrees_of_freedom=None)
    >>> round(float(estimate.standard_errors[0]) ** 2, 9), round(estimate.factor, 3)
    (0.5, 1.96)
    """
    p = jacobian.shape[1]
    length = np.linalg.norm(jacobian, axis=0)
    unit = np.where(length > 0.0, length, 1.0)
    _, singular, directions = np.linalg.svd(jacobian / unit, full_matrices=False)
    determined = singular > SINGULAR * max(float(singular.max(initial=0.0)), 1e-300)
    inverse = (directions[determined].T / singular[determined] ** 2) @ directions[determined]
    covariance = inverse / unit[:, None] / unit[None, :]
    covariance = 0.5 * (covariance + covariance.T)  # the same above and below the diagonal, to the last digit
    open_directions = np.vstack([directions[~determined], np.zeros((0, p))])
    lost = (np.abs(open_directions) > LEAST_SHARE).any(axis=0) | (length == 0.0)
    error = np.sqrt(np.where(lost, 1.0, np.diag(covariance)))
    correlation = covariance / np.outer(error, error)
    correlation[lost, :] = np.nan
    correlation[:, lost] = np.nan
    np.fill_diagonal(correlation, 1.0)
    covariance[lost, lost] = np.inf
    tail = 0.5 * (1.0 + CONFIDENCE)
    factor = float(norm.ppf(tail) if degrees_of_freedom is None else t.ppf(tail, max(degrees_of_freedom, 1.0)))
    single_errors = np.where(length > 0.0, 1.0 / unit, np.inf)
    with np.errstate(invalid="ignore"):
        unknown = lost | (factor * np.sqrt(np.diag(covariance)) > WIDEST_HALF_INTERVAL)
    alone = [(int(j),) for j in np.flatnonzero(length == 0.0)]
    together = (np.flatnonzero((np.abs(direction) > LEAST_SHARE) & (length > 0.0)) for direction in open_directions)
    groups = tuple(dict.fromkeys([*alone, *(tuple(group.tolist()) for group in together if group.size)]))
    return Uncertainty(covariance, correlation, factor, unknown, groups, single_errors)


def correlation_warnings(parameters: Sequence[Parameter], correlation: FloatArray) -> Iterator[Message]:
    """Warning of each pair of parameters that the data hardly distinguish."""
    for i, one in enumerate(parameters):
        for j in range(i):
            r = float(correlation[i, j])
            if abs(r) > REPORTED_PAIR_CORRELATION:
                helps = _pair_help(parameters[j], one)
                yield Message(
                    "{name} and {name_2} are hardly told apart (correlation {r:.3f}): {pair_help}",
                    name=parameters[j].name, name_2=one.name, r=r, pair_help=helps,
                )  # fmt: skip


def unknown_warnings(parameters: Sequence[Parameter], spread: Uncertainty) -> Iterator[Message]:
    """Warning of each parameter or group of parameters that the data do not determine."""
    named: set[int] = set()
    for group in spread.groups:
        named.update(group)
        if len(group) == 1:
            alone = parameters[group[0]]
            yield Message(
                "{name} cannot be identified: it has no effect on these data. {single_help}",
                name=alone.name,
                single_help=_single_help(alone),
            )
        else:
            names = _enumeration([parameters[j].name for j in group])
            helps = _pair_help(parameters[group[0]], parameters[group[1]]) if len(group) == 2 else _COMMON
            yield Message("{names} cannot be distinguished by these data: {helps}", names=names, helps=helps)
    for j in np.flatnonzero(spread.unknown).tolist():
        if j in named:
            continue
        close = [i for i, r in enumerate(spread.correlation[j]) if i != j and abs(r) > REPORTED_PAIR_CORRELATION]
        reason = Message("It would be known if the others were: fix some of them, or give them priors from elsewhere")
        if spread.factor * spread.alone[j] > WIDEST_HALF_INTERVAL:  # not even with all others known
            reason = _single_help(parameters[j])
        elif close:
            names = _enumeration([parameters[i].name for i in close])
            reason = Message("It would be known if {names} were: what one does the other can do", names=names)
        yield Message(
            "{name} is left open by these data: its interval is as wide as all values it could have. {reason}",
            name=parameters[j].name,
            reason=reason,
        )


def _enumeration(names: Sequence[str]) -> str:
    """Names with "and" between them."""
    return reduce(lambda before, name: Message("{before} and {name}", before=before, name=name), names)


def _pair_help(one: Parameter, other: Parameter) -> Message:
    """Advice for two parameters that the data cannot separate."""
    keys = frozenset(parameter.key.partition("@")[0] for parameter in (one, other))
    return _HELPS.get(keys, _COMMON)


def _single_help(one: Parameter) -> Message:
    """Advice for a parameter that the data cannot determine."""
    return _ALONE.get(one.key.partition("@")[0], _FIX_IT)
