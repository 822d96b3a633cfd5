"""Snow as the force laws need it, with the source of its numbers; S_f given by the user."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Final, TypeAlias

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import MM, N_PER_MM2, N_PER_MM3, Facts, Shown, amount, span
from ..parameters import Allowed, Label, Quantity, Search, Word, require_declared

Interval: TypeAlias = tuple[float, float]

GREATEST_LIKELY_HARDNESS: Final = 1e4
"""H_V (N/mm³) above which the number looks like N/m³: a hundred times the hardest that was measured (assumption)."""


@dataclass(frozen=True, slots=True, repr=False)
class SnowProperties(Shown):
    """Contact parameters of one snow, in SI. Neither hardness nor strength has a default.

    Attributes
    ----------
    snow_hardness
        H_V (N/m³); 0.04-90 N/mm³ on ski slopes (Mössner and others 2013).
    failure_shear_stress
        S_f (N/m²), or None where it was not measured; 0.04-0.40 N/mm² on ski slopes (ibid.).
    source
        Where the numbers come from, in words: "given as numbers", a file and site, a publication.
    snow_hardness_interval, failure_shear_stress_interval
        95 % intervals (low, high) of the two values where they are means over experiments: of the geometric mean of
        H_V and of the mean of S_f, not of a single place on the snow. None where there are fewer than two
        experiments or the source gives none.
    unloading_ratio
        k_u/H_V ≥ 1 where it is known, which `Scenario.with_` then takes over; 1 is elastic snow, which springs back.
    unloading_ratio_interval
        95 % interval of it where it was measured.
    shear_displacement, shear_displacement_interval
        u_y (m), the sideways displacement of an edge at which the snow reaches S_f, and its 95 % interval, if measured;
        `Scenario.with_` then uses u_y.

    See Also
    --------
    skisnow.load_snow
    skisnow.read_snow

    Examples
    --------
    A snow with numbers of one's own: 0.2 N/mm³ and 0.35 N/mm².

    >>> from skisnow._support.units import N_PER_MM2, N_PER_MM3
    >>> snow = SnowProperties(0.2 * N_PER_MM3, 0.35 * N_PER_MM2, source="given as numbers")
    >>> snow.snow_hardness
    200000000.0
    >>> snow
    <SnowProperties H_V 0.2 N/mm³, S_f 0.35 N/mm²: given as numbers>
    """

    snow_hardness: Annotated[
        float,
        Quantity("H_V_N_per_mm3", "snow hardness H_V"),
        Label(Message("snow hardness"), symbol="$H_V$"),
        Allowed(0.0, above=True, origin="measured 0.022 to 90; a warning beyond"),
        Search(3.0, 0.002, 1000.0, logarithmic=True),  # ten times beyond what was measured
    ]
    failure_shear_stress: Annotated[
        float | None,
        Quantity("S_f_N_per_mm2", "failure shear stress S_f"),
        Label(Message("failure shear stress"), symbol="$S_f$"),
        Allowed(0.0, above=True, origin="measured 0.04 to 0.52; a warning beyond"),
        Search(3.0, 0.004, 5.0, logarithmic=True),
    ]
    source: Annotated[
        str,
        Word("results", "results.json of an analysed campaign, instead of H_V and S_f", names_file=True),
        Word("site", "one site of those results; default: all of them"),
        Word("published", "name of a published snow, instead of H_V and S_f"),
    ]
    snow_hardness_interval: Interval | None = None
    failure_shear_stress_interval: Interval | None = None
    unloading_ratio: float | None = None
    unloading_ratio_interval: Interval | None = None
    shear_displacement: float | None = None
    shear_displacement_interval: Interval | None = None

    def __post_init__(self) -> None:
        require_declared(self)
        if self.unloading_ratio is not None and not self.unloading_ratio >= 1.0:
            raise ParameterError("unloading_ratio is {unloading_ratio}; k_u/H_V must be 1 (elastic) or more").tag(
                "out_of_range", unloading_ratio=self.unloading_ratio
            )

    @property
    def in_words(self) -> str:
        """Both values with their intervals, the unloading ratio where it is known, and the source."""
        known = {"H_V": True, "S_f": True}
        known |= {"k_u/H_V": self.unloading_ratio is not None, "u_y": self.shear_displacement is not None}
        return f"{', '.join(f'{name} {text}' for name, text in self._rows() if known[name])}: {self.source}"

    def without_measured(self, *, unloading: bool = False, displacement: bool = False) -> SnowProperties:
        """The snow without its measured k_u/H_V or u_y, which a scenario's number replaces."""
        changes: dict[str, None] = {}
        if unloading and self.unloading_ratio_interval is not None:
            changes |= {"unloading_ratio": None, "unloading_ratio_interval": None}
        if displacement and self.shear_displacement is not None:
            changes |= {"shear_displacement": None, "shear_displacement_interval": None}
        return replace(self, **changes) if changes else self  # type: ignore[arg-type]

    def _repr_facts(self) -> Facts:
        """Title with all values in words."""
        return Facts(self.in_words)

    def _notebook_facts(self) -> Facts:
        """Title with the source, and a row for each value."""
        return Facts(self.source, self._rows())

    def _rows(self) -> tuple[tuple[str, str], ...]:
        """Symbol and text with interval and unit of each quantity, for notebooks."""
        return (
            ("H_V", _with_interval(self.snow_hardness, self.snow_hardness_interval, N_PER_MM3, "N/mm³")),
            ("S_f", _with_interval(self.failure_shear_stress, self.failure_shear_stress_interval, N_PER_MM2, "N/mm²")),
            ("k_u/H_V", _with_interval(self.unloading_ratio, self.unloading_ratio_interval, 1.0, "")),
            ("u_y", _with_interval(self.shear_displacement, self.shear_displacement_interval, MM, "mm")),
        )


def _with_interval(value: float | None, interval: Interval | None, size: float, unit: str) -> str:
    """Value divided by `size`, with unit and with its interval in brackets, if there is one."""
    text = amount(None if value is None else value / size, unit)
    return text if interval is None else f"{text} ({span(interval[0] / size, interval[1] / size)})"


def require_stress(snow: SnowProperties, S_f_N_per_mm2: float | None, *, carves: bool) -> SnowProperties:
    """A named snow, with a given S_f if it lacks one.

    Raises ParameterError: S_f comes from both sides, or from none although the ski carves.
    """
    if S_f_N_per_mm2 is not None and snow.failure_shear_stress is not None:
        raise ParameterError(
            "S_f_N_per_mm2 conflicts with this snow ({source}), which has an S_f. Remove one, or give H_V_N_per_mm3 "
            "and S_f_N_per_mm2 as numbers"
        ).tag("contradiction", source=snow.source)
    if carves and S_f_N_per_mm2 is None and snow.failure_shear_stress is None:
        raise ParameterError(
            "this snow ({source}) has no failure shear stress S_f, which a carved turn needs. Add S_f_N_per_mm2 "
            "(--S-f-N-per-mm2), or compute the ski at rest (--at-rest)"
        ).tag("no_data", source=snow.source)
    if S_f_N_per_mm2 is None:
        return snow
    stress = S_f_N_per_mm2 * N_PER_MM2
    return replace(snow, failure_shear_stress=stress, source=f"{snow.source}; S_f given as a number")
