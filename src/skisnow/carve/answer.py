"""The answer to a question about a ski in snow: ski and snow are read, the equilibrium found, warnings collected."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from ..errors import RangeWarning
from ..forces.measured_ranges import FAILURE_SHEAR_STRESS, PENETRATION_EDGE_ANGLE, SNOW_HARDNESS
from ..given import is_file
from ..ski import Ski, read_ski, ski_names
from ..snow import SnowProperties, published_snow, snow_from_results
from .equilibrium import Equilibrium, carve, rest
from .keys import CARVE_KEYS, CarveQuestion
from .limits import require_clamp, require_stress, suspicions, with_stress

T = TypeVar("T")


@dataclass(frozen=True, slots=True, eq=False)
class CarveAnswer:
    """A question, what was read for it, the equilibrium, and every warning in words."""

    question: CarveQuestion
    ski: Ski
    snow: SnowProperties
    equilibrium: Equilibrium
    warnings: tuple[str, ...]


@dataclass(slots=True)
class Sources:
    """Skis and snows by the words that name them, each read once.

    Attributes
    ----------
    folder
        Where relative paths start; None: the current folder.
    """

    folder: Path | None = None
    _skis: dict[str, tuple[Ski, tuple[str, ...]]] = field(default_factory=dict)
    _snows: dict[tuple[str | None, str | None, str | None], SnowProperties] = field(default_factory=dict)

    def ski(self, word: str) -> tuple[Ski, tuple[str, ...]]:
        """The ski of a name or path, and what its reader warned of."""
        if word not in self._skis:
            self._skis[word] = _warned(lambda: read_ski(self._ski_place(word)))
        return self._skis[word]

    def snow(self, question: CarveQuestion) -> SnowProperties:
        """The snow of a question."""
        if question.H_V_N_per_mm3 is not None:
            stress = question.S_f_N_per_mm2
            return SnowProperties(
                question.H_V_N_per_mm3 * CARVE_KEYS["H_V_N_per_mm3"].factor,
                None if stress is None else stress * CARVE_KEYS["S_f_N_per_mm2"].factor,
                source="given as numbers",
            )
        snow = self.named_snow(question.as_dict())
        require_stress(snow, question.S_f_N_per_mm2, carves=not question.at_rest)
        return with_stress(snow, question.S_f_N_per_mm2)

    def named_snow(self, words: Mapping[str, Any]) -> SnowProperties:
        """The snow of the words `published`, or `results` and `site`."""
        named = (words.get("published"), words.get("results"), words.get("site"))
        if named not in self._snows:
            self._snows[named] = self._read_snow(*named)
        return self._snows[named]

    def take_snow(self, snow: SnowProperties, *, results: str, site: str | None) -> None:
        """Take a snow that is at hand for that of the words `results` and `site`, whose file is then not read."""
        self._snows[None, results, site] = snow

    def path(self, word: str) -> Path:
        """The place of a file."""
        return (self.folder or Path()) / word

    def ski_file(self, word: str) -> Path | None:
        """The file that a ski's word names, None for a name of the catalogue."""
        if word in ski_names():
            return None
        place = self.path(word)
        looks_like_one = Path(word).suffix.lower() in (".toml", ".json") or Path(word).name != word
        return place if looks_like_one or is_file(place) else None

    def _ski_place(self, word: str) -> str | Path:
        return self.ski_file(word) or word

    def _read_snow(self, published: str | None, results: str | None, site: str | None) -> SnowProperties:
        if results is not None:
            return snow_from_results(self.path(results), site=site)
        return published_snow(published or "")


def answered(question: CarveQuestion, *, sources: Sources | None = None) -> CarveAnswer:
    """Read ski and snow and find the equilibrium.

    Parameters
    ----------
    question
        Checked inputs.
    sources
        Keeps what was read, for many questions.

    Raises
    ------
    ParameterError
        Ski or snow cannot be read, or an input does not go with the ski.
    """
    sources = sources or Sources()
    ski, told = sources.ski(question.ski)
    snow = sources.snow(question)
    require_clamp(ski, question.clamp_length_m)
    edge_angle = question.edge_angle_deg * CARVE_KEYS["edge_angle_deg"].factor
    equilibrium = _equilibrium(question, ski, snow, edge_angle)
    _, outside = _warned(lambda: _warn_outside_ranges(snow, edge_angle, at_rest=question.at_rest))
    return CarveAnswer(
        question, ski, snow, equilibrium, (*told, *suspicions(question), *outside, *equilibrium.warnings)
    )


def _equilibrium(question: CarveQuestion, ski: Ski, snow: SnowProperties, edge_angle: float) -> Equilibrium:
    shared = {"edge_angle": edge_angle, "load": question.load_N, "moment": question.moment_Nm}
    if question.at_rest or question.unloading_ratio is None:
        return rest(
            ski,
            snow,
            **shared,
            clamp_length=question.clamp_length_m,
            twist=question.twist,
            elements=question.elements,
        )
    return carve(
        ski,
        snow,
        **shared,
        unloading_ratio=question.unloading_ratio,
        clamp_length=question.clamp_length_m,
        side_force_bending=question.side_force_bending,
        groove=question.groove,
        moment_balance=question.moment_balance,
        twist=question.twist,
        elements=question.elements,
    )


def _warn_outside_ranges(snow: SnowProperties, edge_angle: float, *, at_rest: bool) -> None:
    SNOW_HARDNESS.warn_outside(snow.snow_hardness, "penetration")
    PENETRATION_EDGE_ANGLE.warn_outside(edge_angle, "penetration")
    if snow.failure_shear_stress is not None and not at_rest:
        FAILURE_SHEAR_STRESS.warn_outside(snow.failure_shear_stress, "shear")


def _warned(act: Callable[[], T]) -> tuple[T, tuple[str, ...]]:
    """What an act gives and its range warnings; any other warning is passed on."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        value = act()
    for other in caught:
        if not issubclass(other.category, RangeWarning):
            warnings.warn_explicit(other.message, other.category, other.filename, other.lineno)
    return value, tuple(str(each.message) for each in caught if issubclass(each.category, RangeWarning))
