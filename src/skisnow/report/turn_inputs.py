"""What the band of a turn was drawn from: each input with its spread, and whether that was measured or is a prior."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..parameters import values_of

if TYPE_CHECKING:
    from .turn_chain import TurnChain


@dataclass(frozen=True, slots=True, kw_only=True)
class BandInput:
    """One input of a band.

    Attributes
    ----------
    key
        Of the scenario.
    measured
        Whether the campaign tells its spread; else a prior does.
    value
        The median, in the key's unit; None of a prior, which has no favourite.
    low, high
        Ends in the key's unit: of the 95 % interval of what was measured, of the whole range of a prior.
    origin
        Where the range comes from.
    """

    key: str
    measured: bool
    value: float | None
    low: float
    high: float
    origin: str

    @property
    def distribution(self) -> str:
        """Its name."""
        return "log-normal" if self.measured else "log-uniform"

    @property
    def spread(self) -> str:
        """Where the spread comes from, in a word."""
        return "measured" if self.measured else "prior"

    @property
    def in_words(self) -> str:
        """Spread, distribution and origin."""
        if self.measured:
            return f"measured: log-normal with the 95 % interval of {self.origin}"
        return f"prior: even in its logarithm; {self.origin}"


def band_inputs(chain: TurnChain) -> Iterator[BandInput]:
    """What was measured, then the priors."""
    for of in chain.measured:
        yield BandInput(key=of.key, measured=True, value=of.value, low=of.low, high=of.high, origin=chain.site)
    own = values_of(chain.nominal.scenario)
    for prior in chain.priors:
        low, high = prior.ends(own[prior.key])
        yield BandInput(key=prior.key, measured=False, value=None, low=low, high=high, origin=prior.origin)
