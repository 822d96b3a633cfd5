"""The parameters of one identification, from ``--free``, the scenario's values, and its section ``[identify]``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from .._support.errors import ParameterError
from ..scenario.keys import SCENARIO_KEYS, short_name
from .parameter import Parameter
from .usual_sizes import usual


def parameter_table(
    keys: Sequence[str], values: Mapping[str, Any], given: Mapping[str, Mapping[str, float]]
) -> tuple[Parameter, ...]:
    """The free parameters in the order of their keys.

    Parameters
    ----------
    keys
        Full names; with ``@run`` behind where each run has its own.
    values
        Where the search begins unless `given` says otherwise, by the same names or by those without ``@run``.
    given
        What `given_parameters` gives.

    Raises
    ------
    ParameterError
        A key has no value to begin at, or what `Parameter` refuses.
    """
    return tuple(_parameter(key, values, given) for key in keys)


def _parameter(key: str, values: Mapping[str, Any], given: Mapping[str, Mapping[str, float]]) -> Parameter:
    own = key.partition("@")[0]
    said = {**given.get(own, {}), **given.get(key, {})}
    start = said.get("start", values.get(key, values.get(own)))
    if start is None:
        raise ParameterError(f'{own} has no value in the scenario; give it one, or [identify."{own}"] start = …')
    start = float(start)
    about = usual(own, start)
    scenario_key = SCENARIO_KEYS[own]
    for name in ("start", "lower", "upper"):
        if name in said:
            scenario_key.in_range(said[name])
    return Parameter(
        key=key,
        name=short_name(key),
        unit=scenario_key.unit,
        start=start,
        lower=said.get("lower", about.lower),
        upper=said.get("upper", about.upper),
        size=about.size,
        logarithmic=about.logarithmic,
        prior_mean=said.get("prior_mean"),
        prior_sd=said.get("prior_sd"),
    )


def fixed_by_given(free: Sequence[str], given: Mapping[str, Any]) -> tuple[str, ...]:
    """Keys with a table ``[identify."KEY"]`` that are not free: they keep the scenario's value."""
    own = {key.partition("@")[0] for key in free}
    return tuple(key for key in given if key.partition("@")[0] not in own)
