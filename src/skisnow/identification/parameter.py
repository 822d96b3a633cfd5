"""Free parameters: name, unit, bounds, start, prior, and the scale of the search."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import template
from ..parameters import Search
from ..scenario.keys import SCENARIO_KEYS, short_name

_TIMES_START: Final = 5.0
_NOT_FINITE: Final = template("{key}: {name} is {value}; it must be a finite number")
_SWAPPED: Final = template("{key}: lower is {lower:g} and upper {upper:g}{unit}; lower must be below upper")
_EXCLUDED: Final = template(
    "{key}: the bounds, {lower:g} to {upper:g}{unit}, exclude the start, {start:g}. Widen them, or start inside"
)
_LOWER_BELOW_ZERO: Final = template("{key}: lower is {lower:g}{unit}; it must be above 0")
_HALF_PRIOR: Final = template("{key}: {missing} is missing; a prior has a mean and a standard deviation")
_PRIOR_SD: Final = template("{key}: prior_sd is {prior_sd:g}{unit}; it must be above 0")
_PRIOR_MEAN: Final = template("{key}: prior_mean is {prior_mean}; it must be a finite number")


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter:
    """One parameter, in the unit that its key names.

    key: Full name of the scenario's key; ``KEY@RUN`` if each run has a separate value.
    name, unit: Short name, and symbol of the unit.
    start, lower, upper: Start of the search, and its bounds.
    size: Typical size of the parameter or of its logarithm, the unit of length of the search; finite differences take 1
        to 5 % of it.
    logarithmic: True if the search uses its logarithm, for a positive quantity that spans decades; its interval is a
        factor.
    prior_mean, prior_sd: Normal prior distribution; None without a prior.
    Raises ParameterError: a number is not finite, bounds are swapped or exclude the start, half a prior is given, a
        standard deviation is not above 0, or a logarithmic parameter may reach 0.

    Examples
    --------
    >>> friction = Parameter(key="friction.mu_0", name="mu_0", start=0.04, lower=0.0, upper=0.5, size=0.05)
    >>> round(friction.scaled(0.09), 9), round(friction.value(1.0), 9)
    (1.0, 0.09)
    """

    key: str
    name: str
    start: float
    lower: float
    upper: float
    size: float
    unit: str = ""
    logarithmic: bool = False
    prior_mean: float | None = None
    prior_sd: float | None = None

    def __post_init__(self) -> None:
        stated = {"prior_mean": self.prior_mean, "prior_sd": self.prior_sd}
        numbers = {name: getattr(self, name) for name in ("start", "lower", "upper", "size")}
        missing = [name for name, value in stated.items() if value is None]
        bad = next((name for name, number in numbers.items() if not math.isfinite(number)), "")
        mean, sd = self.prior_mean, self.prior_sd
        for is_wrong, problem, code in (
            (bad, _NOT_FINITE, "not_a_number"),
            (not self.lower < self.upper, _SWAPPED, "swapped_bounds"),
            (not self.lower <= self.start <= self.upper, _EXCLUDED, "start_outside_bounds"),
            (self.logarithmic and self.lower <= 0.0, _LOWER_BELOW_ZERO, "out_of_range"),
            (len(missing) == 1, _HALF_PRIOR, "half_prior"),
            (sd is not None and not 0.0 < sd < math.inf, _PRIOR_SD, "out_of_range"),
            (mean is not None and not math.isfinite(mean), _PRIOR_MEAN, "not_a_number"),
        ):
            if is_wrong:
                own = {"key": self.key, "unit": f" {self.unit}".rstrip(), "name": bad, "value": numbers.get(bad)}
                raise ParameterError(problem).tag(code, **own, missing="".join(missing), **numbers, **stated)

    def scaled(self, value: float) -> float:
        """The value on the scale of the search: 0 at the start, 1 at one `size` from it."""
        away = math.log(value / self.start) if self.logarithmic else value - self.start
        return away / self.size

    def value(self, scaled: float) -> float:
        """The value at a place on the scale of the search, clipped to the bounds."""
        away = scaled * self.size
        value = self.start * math.exp(away) if self.logarithmic else self.start + away
        return min(max(value, self.lower), self.upper)

    def slope(self, value: float) -> float:
        """Derivative of the value with respect to the place on the scale of the search."""
        return value * self.size if self.logarithmic else self.size

    def prior_residual(self, value: float) -> float | None:
        """Distance of the value from the prior's mean, in its standard deviations; None without a prior."""
        if self.prior_mean is None or self.prior_sd is None:
            return None
        return (value - self.prior_mean) / self.prior_sd


def bounds_of(parameters: tuple[Parameter, ...]) -> tuple[FloatArray, FloatArray]:
    """Bounds on the scale of the search, (p,) each."""
    lower = np.array([parameter.scaled(parameter.lower) for parameter in parameters])
    upper = np.array([parameter.scaled(parameter.upper) for parameter in parameters])
    return lower, upper


def default_search(key: str, start: float) -> Search:
    """Size and bounds of a key for a search that begins at `start`, inside the key's allowed range."""
    own = SCENARIO_KEYS[key.partition("@")[0]]
    search = own.search
    if search is None:
        size = abs(start) or 1.0
        search = Search(size, -_TIMES_START * size, _TIMES_START * size, about=True)
    low, high = (search.lower + start, search.upper + start) if search.about else (search.lower, search.upper)
    least = own.lowest + (1e-6 * search.size if own.above else 0.0)
    return Search(
        search.size, min(max(low, least), start), max(min(high, own.highest), start), search.about, search.logarithmic
    )


def parameter_table(
    keys: Sequence[str], values: Mapping[str, Any], tables: Mapping[str, Mapping[str, float]]
) -> tuple[Parameter, ...]:
    """The free parameters in the order of their keys.

    keys: full names, or ``KEY@RUN`` for a separate value of a run.
    values: start values by the same names or by those without ``@RUN``; `tables` override them.
    tables: entries of the tables ``[identify."KEY"]``, from `given_parameters`.
    """
    return tuple(_make_parameter(key, values, tables) for key in keys)


def _make_parameter(key: str, values: Mapping[str, Any], tables: Mapping[str, Mapping[str, float]]) -> Parameter:
    """Parameter of a key from its tables, the scenario's value and default bounds; rejects one without a start."""
    own = key.partition("@")[0]
    entries = {**tables.get(own, {}), **tables.get(key, {})}
    start = entries.get("start", values.get(key, values.get(own)))
    if start is None:
        raise ParameterError('{key} has no value in the scenario; give it one, or [identify."{key}"] start = …').tag(
            "no_start", key=own
        )
    start = float(start)
    defaults = default_search(own, start)
    scenario_key = SCENARIO_KEYS[own]
    for name in ("start", "lower", "upper"):
        if name in entries:
            scenario_key.in_range(entries[name])
    return Parameter(
        key=key,
        name=short_name(key),
        unit=scenario_key.unit,
        start=start,
        lower=entries.get("lower", defaults.lower),
        upper=entries.get("upper", defaults.upper),
        size=defaults.size,
        logarithmic=defaults.logarithmic,
        prior_mean=entries.get("prior_mean"),
        prior_sd=entries.get("prior_sd"),
    )
