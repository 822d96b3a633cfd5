"""Result of `skisnow.turn`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ..._support.display import Facts, Shown, amount
from ..._support.messages import ENGLISH, outcome_words

if TYPE_CHECKING:
    from ...estimation import Analysis
    from ...scenario.identify_section import Measured, Prior
    from ...simulation.run import Run
    from ...snow import SnowProperties
    from .figures import TimedTrack


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class EnsembleRun(Shown):
    """One run of an ensemble.

    Attributes
    ----------
    snow
        Sampled snow.
    outcome
        Outcome of the run.
    track
        Track of the middle between the boots.
    values
        Sampled values by the scenario's keys, in their units.
    slips
        Share of the time in which the more heavily loaded ski side-slips; None if unknown.
    """

    snow: SnowProperties
    outcome: str
    track: TimedTrack
    values: Mapping[str, float] = field(default_factory=dict)
    slips: float | None = None

    def _facts(self) -> Facts:
        return Facts(f"{outcome_words(self.outcome)} on {self.snow.in_words}")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class TurnChain(Shown):
    """Result of `skisnow.turn`: from a campaign to a turn.

    Attributes
    ----------
    campaign, site
        Names of campaign and site.
    synthetic
        True if the campaign is synthetic.
    snow
        H_V and S_f of that site with their intervals.
    runs
        Runs by the name of the contact, at least two; the first is the nominal run of the ensemble.
    ensemble
        Runs with sampled inputs, at least three.
    seed
        Seed of the samples.
    ensemble_error
        Distance between the ends of the nominal run and of the same run computed like the ensemble (m); None if both
        are computed in the same way.
    measured
        Measured inputs of the ensemble: H_V, S_f, and k_u/H_V and u_y if the campaign has them.
    priors
        The other inputs of the ensemble.
    warnings
        Warnings of a nominal run near the limit of grip.
    analysis
        Analysis of the campaign, if `skisnow.turn` computed one.

    See Also
    --------
    skisnow.turn
    """

    campaign: str
    site: str
    synthetic: bool
    snow: SnowProperties
    runs: Mapping[str, Run]
    ensemble: Sequence[EnsembleRun]
    seed: int
    ensemble_error: float | None = None
    measured: Sequence[Measured] = ()
    priors: Sequence[Prior] = ()
    warnings: tuple[str, ...] = ()
    analysis: Analysis | None = None

    @property
    def nominal(self) -> Run:
        """Run on the snow of the site with the first contact."""
        return next(iter(self.runs.values()))

    @property
    def sentences(self) -> list[str]:
        """Differences between the contacts, and the origin of each input's spread, as plain text."""
        from .sentences import plain_sentences

        return [sentence.replace("<sub>", "_").striptags() for sentence in plain_sentences(self)]

    def report(self, folder: str | Path, *, language: str = ENGLISH) -> Path:
        """Write report.html, turn.json and figures/ of the whole chain; see `report.turn.page.write_turn_report`."""
        from .page import write_turn_report

        return write_turn_report(self, folder, language=language)

    def _facts(self) -> Facts:
        runs = [(name, f"{run.outcome}, {amount(run.run_length, 'm')}") for name, run in self.runs.items()]
        rows = (("snow", self.snow.in_words), *runs, ("ensemble", f"{len(self.ensemble)} runs"))
        return Facts(f"from {self.campaign!r}, {self.site}", rows)
