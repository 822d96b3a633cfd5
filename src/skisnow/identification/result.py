"""Result of an identification."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.messages import Message
from .._support.units import Facts, Shown, amount, ends
from .._support.user_files.json_text import json_number
from .parameter import Parameter
from .problem import Fit

Interval: TypeAlias = tuple[float | None, float | None]
Outcome: TypeAlias = Literal["converged", "not_converged", "not_identifiable", "too_few_points", "interrupted"]

REASONS: dict[Outcome, Message] = {
    "converged": Message(
        "The search ended: no step brings the computed nearer to the measured by more than its noise."
    ),
    "not_converged": Message(
        "The search did not come to an end; the values are the best that were seen. Start nearer, or free fewer "
        "parameters."
    ),
    "not_identifiable": Message(
        "The data do not determine every parameter; the warnings name them, and the data that would help."
    ),
    "too_few_points": Message("There are too few points for these parameters; nothing was identified."),
    "interrupted": Message("The search was stopped; the values are the best that were seen until then."),
}


def _ends_text(interval: Interval) -> str:
    """Both ends of an interval as a text, "open" for None."""
    return " to ".join("open" if end is None else f"{end:.4g}" for end in interval)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Identified(Shown):
    """Estimate of one parameter, in the unit that its key names; None if a number does not exist.

    parameter: The free parameter.
    value, standard_error, interval: Best value; standard error and 95 % interval from the curvature of the sum of
        squares; None for an open end.
    profile_interval, bootstrap_interval, posterior_interval: 95 % intervals by other methods, if requested.
    at_bound: True if the best value is on a bound.
    identifiable: True if the data determine the parameter.
    """

    parameter: Parameter
    value: float | None = None
    standard_error: float | None = None
    interval: Interval | None = None
    profile_interval: Interval | None = None
    bootstrap_interval: Interval | None = None
    posterior_interval: Interval | None = None
    at_bound: bool = False
    identifiable: bool = True

    def _repr_facts(self) -> Facts:
        """Title with the parameter's key and its estimate."""
        return Facts(f"{self.parameter.key} = {self.in_words}")

    @property
    def in_words(self) -> str:
        """The value with its interval in the key's unit, and whether the data determine it."""
        text = amount(self.value, self.parameter.unit)
        if self.interval is not None:
            text += f" ({_ends_text(self.interval)})"
        for name in ("profile", "bootstrap", "posterior"):
            if (further := getattr(self, f"{name}_interval")) is not None:
                text += f", {name} {_ends_text(further)}"
        return f"{text}{'' if self.identifiable else ', not determined'}{', at a bound' if self.at_bound else ''}"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Profile(Shown):
    """The sum of squares along one parameter with all others refitted.

    key: key of the parameter.
    value: (m,) values of the parameter, rising.
    rise: (m,) rise of the sum of squares above its minimum, in squared standard deviations of the data.
    limit: rise at the ends of the 95 % interval.
    """

    key: str
    value: FloatArray
    rise: FloatArray
    limit: float

    def _repr_facts(self) -> Facts:
        """Title with the parameter's key, the number of values and their range."""
        return Facts(f"of {self.key} at {len(self.value)} values, {ends(self.value)}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """Effort of a search: runs simulated, runs restored from an earlier search, Jacobians, time (s)."""

    simulations: int = 0
    kept_simulations: int = 0
    rounds: int = 0
    wall_s: float = 0.0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class Identification(Shown):
    """Result of an identification.

    Attributes
    ----------
    outcome, reason
        Outcome, and a sentence that explains it.
    scenario
        Title of the scenario.
    parameters
        Estimates of the free parameters, in the order of the request.
    correlation
        (p, p); NaN for undetermined parameters.
    covariance
        (p, p) in the keys' units, linearised; infinite or NaN for undetermined parameters.
    noise
        Standard deviation of the residuals of each kind of data, relative to the stated one (ideally 1).
    accuracy_is_stated
        True if the data state their accuracy.
    points, degrees_of_freedom
        Number of measured points; number of residuals and priors minus fitted values.
    warnings, methods
        Warnings, and sentences on how the result was computed.
    fits
        Measured and fitted values of each run.
    starts
        Places (p,) of the starts and the sums of squares of their searches; None for a start without a simulation.
    profiles, bootstrap, posterior
        If requested; samples are (N, p) in the keys' units.
    effort
        Effort of the search.
    data
        Name of each file and the kind of data recognised in it.

    See Also
    --------
    skisnow.identify
    """

    outcome: Outcome
    reason: Message
    scenario: str
    parameters: tuple[Identified, ...]
    correlation: FloatArray
    covariance: FloatArray
    noise: tuple[float, ...] = ()
    accuracy_is_stated: bool = True
    points: int = 0
    degrees_of_freedom: int = 0
    warnings: tuple[Message, ...] = ()
    methods: tuple[Message, ...] = ()
    fits: tuple[Fit, ...] = ()
    starts: tuple[tuple[FloatArray, float | None], ...] = ()
    profiles: tuple[Profile, ...] = ()
    bootstrap: FloatArray | None = None
    posterior: FloatArray | None = None
    effort: Effort = field(default_factory=Effort)
    data: tuple[tuple[str, Message], ...] = ()

    def _repr_facts(self) -> Facts:
        """Title with outcome, scenario and number of points, and a row for each parameter."""
        rows = tuple((identified.parameter.key, identified.in_words) for identified in self.parameters)
        fields = {"outcome": self.outcome.replace("_", " "), "scenario": self.scenario, "points": self.points}
        return Facts(Message("{outcome}: {scenario}, {points} points", **fields), rows)

    @property
    def values(self) -> dict[str, float | None]:
        """The best values by key."""
        return {identified.parameter.key: identified.value for identified in self.parameters}

    def __getitem__(self, key: str) -> Identified:
        """One parameter by its full key or its short name."""
        for identified in self.parameters:
            if key in (identified.parameter.key, identified.parameter.name):
                return identified
        raise KeyError(key)


def identification_dict(identification: Identification, *, files: Iterable[Path] = ()) -> dict[str, Any]:
    """The contents of identification.json, and of ``skisnow identify --json``; nothing is rounded, nothing is NaN.

    Its JSON Schema is that of ``skisnow schema identification``.

    identification: The result.
    files: Input files, listed with their SHA-256.
    """
    keys = [identified.parameter.key for identified in identification.parameters]
    return {
        "schema_version": 1,
        "outcome": identification.outcome,
        "reason": identification.reason,
        "parameters": dict(zip(keys, map(_parameter_dict, identification.parameters), strict=True)),
        "correlation": {
            key: {other: json_number(identification.correlation[i, j]) for j, other in enumerate(keys)}
            for i, key in enumerate(keys)
        },
        "warnings": list(identification.warnings),
        "methods": list(identification.methods),
        "data": [{"name": name, "taken_for": kind} for name, kind in identification.data],
        "scenario": identification.scenario,
        "points": identification.points,
        "degrees_of_freedom": identification.degrees_of_freedom,
        "accuracy_is_stated": identification.accuracy_is_stated,
        "noise": [json_number(noise) for noise in identification.noise],
        "runs": [{"name": fit.name, "kind": fit.kind, "rms": _rms(fit)} for fit in identification.fits],
        "effort": asdict(identification.effort),
        "provenance": {
            "files": {str(path): hashlib.sha256(path.read_bytes()).hexdigest() for path in files},
            "skisnow": version("skisnow"),
            "time": datetime.now(UTC).isoformat(timespec="seconds"),
        },
    }


def _parameter_dict(identified: Identified) -> dict[str, Any]:
    """JSON of an estimated parameter: value, intervals, bounds, prior, and if it is identifiable."""
    estimates = ("value", "interval", "standard_error", "profile_interval", "bootstrap_interval", "posterior_interval")
    given = ("unit", "start", "lower", "upper", "prior_mean", "prior_sd")
    entries = (
        {name: getattr(identified, name) for name in estimates}
        | {name: getattr(identified.parameter, name) for name in given}
        | {"at_bound": identified.at_bound, "identifiable": identified.identifiable}
    )
    return {name: list(value) if isinstance(value, tuple) else value for name, value in entries.items()}


def _rms(fit: Fit) -> dict[str, float | None]:
    """Root mean square residual of each labelled column; None without a finite one."""
    rms: dict[str, float | None] = {}
    for i, label in enumerate(fit.labels):
        residuals = fit.residual[np.isfinite(fit.residual[:, i]), i]
        rms[label] = float(np.sqrt(np.mean(residuals**2))) if residuals.size else None
    return rms
