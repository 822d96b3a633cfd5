"""The quality flags of single experiments: codes, sentences, limits, and which exclude by default."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Mapping

FEWEST_LOADS: Final = 3
"""Fewer load steps do not show whether the law holds (modelling assumption)."""
RESOLUTIONS: Final = 5.0
"""A depth of fewer gauge resolutions is read with more than some 6 % of standard uncertainty: 1/(5 √12) (modelling
assumption)."""
CREEP_STEPS: Final = 2.0
"""Growth under a constant load that a gauge distinguishes from its own rounding (modelling assumption)."""
CREEP_SHARE: Final = 0.01
"""The same as a share of the depth: of an edged tool it moves H_V by 2 %, as much as its readings scatter (modelling
assumption). The paper cancelled a series whose depth "constantly and slowly increased", without a number."""


ALWAYS_EXCLUDE: Final = frozenset({"cancelled", "zero_depth"})
"""A campaign may choose which flags exclude, but not these: the observers took the test back, or there is no value."""


@dataclass(frozen=True, slots=True)
class QualityFlag:
    """A quality flag: its code, the sentence that explains it in a report, and whether it excludes by default."""

    code: str
    sentence: str
    excludes_by_default: bool


_ALL: Final = (
    QualityFlag("cancelled", "The experiment was cancelled by an entry in the column status.", True),
    QualityFlag("too_few_loads", f"The series has fewer than {FEWEST_LOADS} load steps.", True),
    QualityFlag("loads_not_rising", "A load of the series is not above the one before it.", True),
    QualityFlag(
        "depth_shrinks", "A depth of the series is below the one before it, although the load was raised.", True
    ),
    QualityFlag(
        "zero_depth", "The depth is zero (of a series: at its largest load), so that no parameter follows.", True
    ),
    QualityFlag(
        "beyond_tool", "The tool went deeper than the geometry that its area and volume are computed with.", False
    ),
    QualityFlag(
        "below_resolution",
        f"The depth (of a series: at its largest load) is below {RESOLUTIONS:g} steps of the gauge.",
        False,
    ),
    QualityFlag(
        "layered",
        "The hardness of the snow changes with depth, or the depth zero is off by several tenths of a millimetre.",
        False,
    ),
    QualityFlag(
        "creeps",
        f"Under one load the depth grew by more than {CREEP_STEPS:g} steps of the gauge and {CREEP_SHARE:.0%} of it.",
        False,
    ),
    QualityFlag(
        "unloading_not_falling",
        "A load of the unloading is not below the one before it, so that no unloading ratio follows.",
        False,
    ),
    QualityFlag(
        "unloading_sinks", "The tool went deeper while the discs were taken off: the snow was still giving way.", False
    ),
    QualityFlag(
        "rebound_unresolved",
        "The tool came back by too little to tell how steep the unloading is: the ratio is only known from below.",
        False,
    ),
    QualityFlag(
        "hardness_outlier",
        "The logarithm of the hardness is further than 3.5 scaled median absolute deviations from its site's median.",
        False,
    ),
)
QUALITY_FLAGS: Final[Mapping[str, QualityFlag]] = MappingProxyType({flag.code: flag for flag in _ALL})
"""Every flag by its code, in the order in which they are listed."""

NEED_HARDNESS: Final = frozenset({"layered", "rebound_unresolved", "hardness_outlier"})
"""Flags that are set where hardness is estimated."""
