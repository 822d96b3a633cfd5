"""Time difference of another ski, snow or dimension on one line, paired over the same snows."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final, get_args

import numpy as np
from scipy.special import stdtrit
from scipy.stats import qmc

from .._support.arrays import FloatArray, content_hash
from .._support.errors import ParameterError, require_choice, require_range
from .._support.processes.batch import ExecutorLike, run_batch
from .._support.processes.kept_rows import KeptRows
from .._support.units import Facts, Shown, amount
from ..scenario import Scenario
from ..ski import Ski
from ..snow import SnowProperties
from ..snow.mean_snow import drawn_snows
from ..track.course.gates_table import GateGap, compare_gates
from .line import RacingLine, skier_of
from .point import LinePoint, Racer, RacerModel, score_in
from .score import Score

AS_IT_IS: Final = "as it is"
"""The name of the scenario itself."""
START: Final = "line where the search began"
WIDER: Final = 1e-3
"""What is added to the waist (m)."""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False, eq=False)
class Worth(Shown):
    """Times of one variant and of the scenario itself on the same snows.

    name: Name of the variant.
    scores, base: Scores of the variant, and of the scenario itself, one for each snow, the scenario's own first.
    """

    name: str
    scores: tuple[Score, ...]
    base: tuple[Score, ...]

    @property
    def differences(self) -> FloatArray:
        """Time of the variant minus that of the scenario (s), for each snow on which both pass all gates."""
        pairs = zip(self.scores, self.base, strict=True)
        return np.array([a.time - b.time for a, b in pairs if a.time is not None and b.time is not None])

    @property
    def on_own_snow(self) -> float | None:
        """Time of the variant minus that of the scenario on the scenario's own snow (s); None if one of them fails."""
        first, base = self.scores[0].time, self.base[0].time
        return None if first is None or base is None else first - base

    @property
    def mean(self) -> float | None:
        """Mean of the differences over the snows (s); None without one."""
        differences = self.differences
        return float(differences.mean()) if len(differences) else None

    @property
    def deviation(self) -> float | None:
        """Standard deviation of the differences over the snows (s); None of fewer than two."""
        differences = self.differences
        return float(differences.std(ddof=1)) if len(differences) > 1 else None

    @property
    def interval(self) -> tuple[float, float] | None:
        """95 % interval (s) of the difference on one more snow, if normal (Student); None of fewer than two."""
        if self.mean is None or self.deviation is None:
            return None
        count = len(self.differences)
        half = float(stdtrit(count - 1, 0.975)) * self.deviation * math.sqrt(1.0 + 1.0 / count)
        return self.mean - half, self.mean + half

    @property
    def verdict(self) -> str:
        """Word `faster` or `slower` if the whole interval is on one side of 0, otherwise `undecided`."""
        low, high = self.interval or (-math.inf, math.inf)
        return "faster" if high < 0.0 else "slower" if low > 0.0 else "undecided"

    @property
    def faster(self) -> int:
        """Number of snows on which the variant is faster."""
        return int(np.sum(self.differences < 0.0))

    def gaps(self, names: Sequence[str]) -> tuple[GateGap, ...]:
        """Time gap of the variant to the scenario at each gate, on the scenario's own snow; `names` of the gates."""
        own, base = (
            [
                {"gate": name, "outcome": outcome, "time_s": time}
                for name, (outcome, time) in zip(names, gates, strict=True)
            ]
            for gates in (self.scores[0].gates, self.base[0].gates)
        )
        return compare_gates(own, base)

    def _repr_facts(self) -> Facts:
        """Name and time difference on its own snow as title, and rows with mean, faster snows and verdict."""
        rows = (
            ("over the snows", f"{amount(self.mean, 's')} ± {amount(self.deviation, 's')}"),
            ("faster on", f"{self.faster} of {len(self.differences)} snows"),
            ("verdict", self.verdict),
        )
        return Facts(f"{self.name}: {amount(self.on_own_snow, 's')}", rows)


def compare_variants(
    scenario: Scenario,
    others: Mapping[str, Scenario],
    line: RacingLine,
    snows: Sequence[SnowProperties],
    *,
    start: RacingLine | None = None,
    model: RacerModel = "skier",
    workers: int | None = None,
    executor: ExecutorLike | None = None,
    checkpoint: Path | None = None,
    progress: Callable[[str], None] | None = None,
) -> tuple[Worth, ...]:
    """Race a scenario and variants of it on one line, on the same snows.

    scenario: Scenario that each variant is compared with.
    others: Variants by name; a change of the snow applies to each snow.
    line: Line on which all of them are raced.
    snows: Snows, the scenario's own first, as from `drawn_for_race`. In skidded turns the skier assumes the scenario's
        own.
    start: Another line for the unchanged scenario, compared as the first of the results (default: none).
    model, workers, executor, checkpoint, progress: As in `quickest_line`.
    Raises ParameterError: there is no snow or no variant, or the checkpoint belongs to another comparison.
    """
    require_choice("model", model, get_args(RacerModel))
    if AS_IT_IS in others:
        raise ParameterError(
            "others has the name {as_it_is!r}, which the scenario itself has. Rename the variant."
        ).tag("repeated", as_it_is=AS_IT_IS)
    if not snows or not (others or start):
        raise ParameterError("a comparison needs one snow or more, and one variant or more").tag("missing")
    raced = {AS_IT_IS: (scenario, line)}
    if start is not None:
        raced[START] = scenario, start
    raced |= {name: (variant, line) for name, variant in others.items()}
    points = [(_variant_on_snow(variant, scenario, snow), along) for variant, along in raced.values() for snow in snows]
    finished_rows = None
    if checkpoint is not None:
        finished_rows = KeptRows.opened(checkpoint, _fingerprint(points, model))
    tell = progress or (lambda _: None)
    try:
        rows = run_batch(
            points, partial(_race, model=model), kept=finished_rows, workers=workers, executor=executor,
            progress=lambda done, total: tell(f"race {done} of {total}"),
        )  # fmt: skip
    finally:
        if finished_rows is not None:
            finished_rows.close()
    scores = [tuple(map(score_in, rows[i : i + len(snows)])) for i in range(0, len(rows), len(snows))]
    base = scores[0]
    return tuple(
        Worth(name=name, scores=variant_scores, base=base)
        for name, variant_scores in zip(list(raced)[1:], scores[1:], strict=True)
    )


def _race(point: tuple[Scenario, RacingLine], model: RacerModel) -> dict[str, Any]:
    """Race a scenario on a line; returns the row of its `Racer`."""
    scenario, line = point
    return Racer(scenario, model)(LinePoint(line, ()))


def drawn_for_race(snow: SnowProperties, count: int, *, spread: float | None, seed: int) -> list[SnowProperties]:
    """A snow, and `count` snows drawn from the uncertainty of its values: a Latin hypercube over H_V and S_f.

    snow: Snow with or without intervals of H_V and S_f.
    count: Number of drawn snows; 0: none.
    spread: Instead of the snow's intervals: 95 % of the values are from value/(1 + spread) to value·(1 + spread).
    seed: Seed of the random numbers, 0 or more.
    Raises ParameterError: an interval is not known and no spread is given.
    """
    if count == 0:
        return [snow]
    if spread is not None:
        require_range("spread", spread, 0.0, 10.0, above=True)
        snow = replace(
            snow,
            snow_hardness_interval=_spread_interval(snow.snow_hardness, spread),
            failure_shear_stress_interval=_spread_interval(snow.failure_shear_stress or 0.0, spread),
        )
    shares = qmc.LatinHypercube(2, rng=np.random.default_rng(seed)).random(count)
    return [snow, *drawn_snows(snow, shares)]


def worth_changes(scenario: Scenario) -> dict[str, Scenario]:
    """Variants of a scenario by name, each with one change: harder or stronger snow, wider or stiffer ski, friction."""
    snow, contact = scenario.contact.snow, scenario.contact
    strength = snow.failure_shear_stress
    harder = replace(snow, snow_hardness=1.1 * snow.snow_hardness, snow_hardness_interval=None)
    stronger = replace(
        snow, failure_shear_stress=None if strength is None else 1.1 * strength, failure_shear_stress_interval=None
    )
    return {
        "H_V 10 % more": scenario.with_(snow=harder),
        "S_f 10 % more": scenario.with_(snow=stronger),
        "waist 1 mm more": scenario.with_(ski=wider(scenario.ski, WIDER)),
        "stiffness 5 % more": replace(scenario, stiffness_factor=1.05 * scenario.stiffness_factor),
        "friction 10 % less": replace(scenario, contact=replace(contact, friction=0.9 * contact.friction)),
    }


def wider(ski: Ski, more: float) -> Ski:
    """Copy of a ski whose waist is wider by `more` (m); the change falls to 0 at the ends of the sidecut."""
    along = np.clip((ski.station - ski.sidecut_middle) / (0.5 * ski.sidecut_length), -1.0, 1.0)
    return replace(ski, name=f"{ski.name}, waist {more * 1e3:+g} mm", width=ski.width + more * (1.0 - along**2))


def _variant_on_snow(variant: Scenario, base: Scenario, snow: SnowProperties) -> Scenario:
    """Variant on another snow, multiplied by the variant's ratios of H_V and S_f to those of the base scenario."""
    own, its = base.contact.snow, variant.contact.snow
    share = its.snow_hardness / own.snow_hardness
    stress = None
    if its.failure_shear_stress and own.failure_shear_stress and snow.failure_shear_stress:
        stress = snow.failure_shear_stress * its.failure_shear_stress / own.failure_shear_stress
    changed = replace(
        snow, snow_hardness=snow.snow_hardness * share, failure_shear_stress=stress, snow_hardness_interval=None,
        failure_shear_stress_interval=None,
    )  # fmt: skip
    skier = skier_of(variant)
    skier = replace(
        skier,
        assumed_hardness=skier.assumed_hardness or own.snow_hardness,
        assumed_strength=skier.assumed_strength or own.failure_shear_stress or 0.0,
    )
    return replace(variant, contact=replace(variant.contact, snow=changed), skier=skier)


def _spread_interval(value: float, spread: float) -> tuple[float, float]:
    """Interval from value / (1 + spread) to value (1 + spread)."""
    return value / (1.0 + spread), value * (1.0 + spread)


def _fingerprint(points: Sequence[tuple[Scenario, RacingLine]], model: RacerModel) -> str:
    """Hash of the scenarios, lines, racer's model and version, which marks the same evaluations."""
    lines = tuple((along.apexes, along.turns) for _, along in points)
    return content_hash(f"with gates {version('skisnow')} {model}", tuple(scenario for scenario, _ in points), lines)
