"""Result of `skisnow.turn`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ..._support.display import Facts, Shown, amount
from ..._support.language import ENGLISH

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
        That was drawn for it.
    outcome
        How it ended.
    track
        Of the middle between the boots.
    values
        What was drawn, by the scenario's keys in their units.
    slips
        Share of the time in which the more heavily loaded ski side-slips; None where it is not known.
    """

    snow: SnowProperties
    outcome: str
    track: TimedTrack
    values: Mapping[str, float] = field(default_factory=dict)
    slips: float | None = None

    def _facts(self) -> Facts:
        return Facts(f"{self.outcome.replace('_', ' ')} on {self.snow.in_words}")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class TurnChain(Shown):
    """From a campaign to a turn.

    Attributes
    ----------
    campaign, site
        Names.
    synthetic
        Whether nobody measured the campaign.
    snow
        H_V and S_f of that site with their intervals.
    runs
        By the name of the contact, two or more; the first is the nominal run of the ensemble.
    ensemble
        Runs over the intervals, three or more.
    seed
        Of the ensemble's draws.
    ensemble_error
        Distance between the ends of the nominal run and of the same run computed like the ensemble (m); None where
        both are computed alike.
    measured
        What the ensemble was drawn from that the campaign measured: H_V, S_f, and as far as known k_u/H_V and u_y.
    priors
        What else it was drawn from.
    warnings
        Of the nominal run, where it is near the limit of grip.
    analysis
        Of the campaign, where it was made on the way.

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
        """The turn on the snow that was found, with the first contact."""
        return next(iter(self.runs.values()))

    @property
    def sentences(self) -> list[str]:
        """What the contacts do otherwise, and where the spread of each input of the band comes from, in plain text."""
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
