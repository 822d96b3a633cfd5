"""The section ``[identify]`` of a scenario file: parameters to identify. A run reads it without using it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import MM, N_PER_MM2, N_PER_MM3
from ..parameters import Allowed, Quantity, checked_table, quantities, suggest_and_list
from ..snow import SnowProperties
from ..snow.mean_snow import log_normal
from .keys import SCENARIO_KEYS, free_key


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchEntry:
    """Entries of ``[identify."KEY"]``, in the unit of that key."""

    start: Annotated[float | None, Quantity("start", "where the search begins; default: the scenario's value")] = None
    lower: Annotated[float | None, Quantity("lower", "bound")] = None
    upper: Annotated[float | None, Quantity("upper", "bound")] = None
    prior_mean: Annotated[float | None, Quantity("prior_mean", "mean of a prior normal distribution")] = None
    prior_sd: Annotated[float | None, Quantity("prior_sd", "its standard deviation"), Allowed(0.0, above=True)] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Site:
    """Entries of ``[identify.site]``, in the units of their names."""

    fall_line_azimuth_deg: Annotated[
        float, Quantity("fall_line_azimuth_deg", "compass direction in which the slope falls")
    ]
    latitude_deg: Annotated[float | None, Quantity("latitude_deg", "where x = y = 0 is")] = None
    longitude_deg: Annotated[float | None, Quantity("longitude_deg", "where x = y = 0 is")] = None
    height_m: Annotated[float | None, Quantity("height_m", "of that place above the ellipsoid")] = None


GIVEN: Final = tuple(quantity.name for quantity in quantities(SearchEntry))
NO_KEYS: Final = ("runs", "site", "clock")
"""Entries of ``[identify]`` other than parameters."""
SITE: Final = tuple(quantity.name for quantity in quantities(Site))
CLOCKS: Final = ("start", "free")


def require_known(section: Mapping[str, Any]) -> None:
    """Reject unknown keys of [identify], keys that cannot be identified, and impossible clocks or tables."""
    given_parameters(section)
    clock = section.get("clock", "start")
    if clock not in CLOCKS:
        raise ParameterError('[identify] clock is {clock!r}; it must be "start" or "free"').tag(
            "out_of_range", clock=clock
        )
    for name in _read_table(section, "site"):
        if name not in SITE:
            raise ParameterError("[identify.site]: unknown name {name!r}. {allowed}").tag(
                "unknown_name", name=name, allowed=suggest_and_list(name, SITE)
            )
    for run, entries in _read_table(section, "runs").items():
        if not isinstance(entries, dict):
            raise ParameterError('identify.runs."{run}" is {entries!r}; it must be a table of keys').tag(
                "wrong_kind", run=run, entries=entries
            )
        for word in entries:
            try:
                free_key(word)
            except ParameterError as error:
                raise error.at(f'[identify.runs."{run}"]') from None


def given_parameters(section: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Tables ``[identify."KEY"]`` of the section, by full key and, if given, ``@`` and the run's name."""
    parameters: dict[str, dict[str, float]] = {}
    for word, table in section.items():
        if word in NO_KEYS:
            continue
        own, at, run = word.partition("@")
        try:
            key = free_key(own) + at + run
        except ParameterError as error:
            raise ParameterError('[identify."{word}"]: {problem} Other entries are {others}.').tag(
                error.code, word=word, problem=error, others=list(NO_KEYS)
            ) from None
        if not isinstance(table, dict):
            raise ParameterError(
                'identify."{word}" is {table!r}; it must be a table with {given}, begun by the line '
                '[identify."{key}"]. A value of the scenario belongs to its own section, [{section}]'
            ).tag("wrong_kind", word=word, table=table, given=list(GIVEN), key=key, section=key.partition(".")[0])
        parameters[key] = checked_table(SearchEntry, table, f'[identify."{key}"]')
    return parameters


def _read_table(section: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    """Table `name` of the section [identify], empty if it is missing; rejects another value."""
    table = section.get(name, {})
    if not isinstance(table, dict):
        what = f"[identify.{name}]" if name == "site" else f'[identify.{name}."NAME"]'
        raise ParameterError("identify.{name} is {table!r}; it must be a table, begun by the line {line}").tag(
            "wrong_kind", name=name, table=table, line=what
        )
    return table


@dataclass(frozen=True, slots=True, kw_only=True)
class Prior:
    """A log-uniform prior: a range of values of a scenario's key, evenly likely in the logarithm.

    low, high: ends in the key's unit, 0 < low ≤ high; equal ends: a known value.
    about: True if the ends are factors of the scenario's own value.
    origin: source of the range.
    """

    key: str
    low: float
    high: float
    origin: str
    about: bool = False

    def __post_init__(self) -> None:
        if not 0.0 < self.low <= self.high:
            raise ParameterError(
                "the prior of {key} is {low:g} to {high:g}; its ends must be above 0, the first one not above the other"
            ).tag("out_of_range", key=self.key, low=self.low, high=self.high)
        if not self.about:
            for end in (self.low, self.high):
                SCENARIO_KEYS[self.key].in_range(end)

    def ends(self, own: float) -> tuple[float, float]:
        """Both ends of the range, in the key's unit, for a scenario whose own value is `own`."""
        return (self.low * own, self.high * own) if self.about else (self.low, self.high)

    def at(self, shares: FloatArray, own: float) -> FloatArray:
        """Values (n,) at shares (quantiles from 0 to 1) of the prior, clipped to the allowed range of the key."""
        low, high = self.ends(own)
        key = SCENARIO_KEYS[self.key]
        return np.clip(low * (self.high / self.low) ** shares, key.lowest, key.highest) if high > 0.0 else 0.0 * shares


def prior_of(word: str) -> Prior:
    """A prior as the command line takes it.

    >>> prior_of("unloading_ratio=5:20")
    Prior(key='snow.unloading_ratio', low=5.0, high=20.0, origin='given', about=False)
    """
    name, _, ends = word.partition("=")
    try:
        low, high = (float(end) for end in ends.split(":"))
    except ValueError:
        raise ParameterError(
            "{word!r} is not a prior; write KEY=LOW:HIGH, such as snow.unloading_ratio=5:20, with equal ends where "
            "it is known"
        ).tag("wrong_kind", word=word) from None
    return Prior(key=free_key(name), low=low, high=high, origin="given")


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """A key of a scenario with a measured value, log-normal with its 95 % interval.

    value: median of the distribution, in the key's unit.
    low, high: ends of the 95 % interval in the key's unit, 0 < low ≤ value ≤ high.
    """

    key: str
    value: float
    low: float
    high: float

    def at(self, shares: FloatArray, own: float) -> FloatArray:  # noqa: ARG002
        """Values at shares (n,) from 0 to 1, within the range of the key; independent of the scenario's own value."""
        key = SCENARIO_KEYS[self.key]
        return np.clip(log_normal(self.value, (self.low, self.high), shares), key.lowest, key.highest)


def measured_of(snow: SnowProperties) -> tuple[Measured, ...]:
    """Quantities of a snow with a value and an interval above 0: H_V, S_f, k_u/H_V, u_y, as far as they are known.

    >>> snow = SnowProperties(2e8, None, "somewhere", unloading_ratio=9.0, unloading_ratio_interval=(6.0, 16.0))
    >>> measured_of(snow)
    (Measured(key='snow.unloading_ratio', value=9.0, low=6.0, high=16.0),)
    """
    measured = (
        ("snow.H_V_N_per_mm3", snow.snow_hardness, snow.snow_hardness_interval, N_PER_MM3),
        ("snow.S_f_N_per_mm2", snow.failure_shear_stress, snow.failure_shear_stress_interval, N_PER_MM2),
        ("snow.unloading_ratio", snow.unloading_ratio, snow.unloading_ratio_interval, 1.0),
        ("snow.shear_displacement_mm", snow.shear_displacement, snow.shear_displacement_interval, MM),
    )
    return tuple(
        Measured(key=key, value=value / unit, low=interval[0] / unit, high=interval[1] / unit)
        for key, value, interval, unit in measured
        if value is not None and interval is not None and interval[0] > 0.0
    )
