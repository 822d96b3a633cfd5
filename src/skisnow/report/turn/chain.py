"""Result of `skisnow.turn`: comparisons of its runs, inputs of its band, and all of it as JSON values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.messages import ENGLISH, Message, outcome_words
from ..._support.units import MM, N_PER_MM2, N_PER_MM3, Facts, Shown, amount
from ..._support.user_files.json_text import json_number
from ...comparison.nearest_place import distance_from_path
from ...estimation import Analysis
from ...parameters import values_of
from ...scenario.identify_section import Measured, Prior
from ...scenario.plausibility import implausible_values
from ...simulation.run import Run
from ...simulation.run_summary import summary_dict
from ...snow import SnowProperties
from ...snow.from_results import snow_dict
from ...statistics import VarianceShares, variance_shares
from ..run.time_figures import grip_utilisation
from .figures import FEWEST, TimedTrack, band_of, loaded_skis, offsets


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class EnsembleRun(Shown):
    """One run of an ensemble.

    track: track of the middle between the boots.
    values: sampled values by the scenario's keys, in their units.
    slips: share of the time in which the more heavily loaded ski side-slips; None if unknown.
    """

    snow: SnowProperties
    outcome: str
    track: TimedTrack
    values: Mapping[str, float] = field(default_factory=dict)
    slips: float | None = None

    def _repr_facts(self) -> Facts:
        """Outcome and snow as title, for the representation."""
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
        """Write report.html, turn.json and figures/ of the whole chain into a folder; returns the page's path."""
        from .page import write_turn_report

        return write_turn_report(self, folder, language=language)

    def _repr_facts(self) -> Facts:
        """Campaign and site as title, and rows with snow, runs and ensemble, for the representation."""
        runs = [(name, f"{run.outcome}, {amount(run.run_length, 'm')}") for name, run in self.runs.items()]
        rows = (("snow", self.snow.in_words), *runs, ("ensemble", f"{len(self.ensemble)} runs"))
        return Facts(f"from {self.campaign!r}, {self.site}", rows)


MORE_THAN_INPUTS: Final = 3  # minimum number of runs above the number of inputs for shares with an interval
YIELDS: Final = 0.95  # grip utilisation above which a ski side-slips; short parts at its ends can still have grip


def afterbody_depth_ratio(run: Run) -> float | None:
    """Ratio of the loaded ski's mean edge depth behind the boot to that before it, median over the second half.

    None if the ski never has contact on both sides of the boot in that time.
    """
    late = np.flatnonzero(run.time >= run.time[-1] / 2.0)
    depth = run.skis.edge_depth[late, loaded_skis(run)[late]]
    depth = np.ma.masked_array(depth, mask=~(depth > 0.0))
    behind, before = (depth[:, part].mean(axis=1) for part in (run.skis.station < 0.0, run.skis.station > 0.0))
    ratio = np.ma.compressed(behind / before)
    return float(np.median(ratio)) if ratio.size else None


def used_grip(run: Run) -> tuple[float | None, float | None]:
    """Median grip utilisation of the loaded ski, and the share of time in which it side-slips."""
    share = np.take_along_axis(grip_utilisation(run), loaded_skis(run)[:, None], axis=1)[:, 0]
    finite = share[np.isfinite(share)]
    return (float(np.median(finite)), float(np.mean(finite >= YIELDS))) if finite.size else (None, None)


def median_radius(run: Run) -> float | None:
    """Median turn radius (m) of the curved parts of a run; None without one."""
    radius = np.abs(run.turn_radius[np.isfinite(run.turn_radius)])
    return float(np.median(radius)) if radius.size else None


def maximum_distance(run: Run, reference: Run) -> float | None:
    """Maximum distance of a run's path from that of another run (m); None if they do not overlap."""
    distance = distance_from_path(run.place, reference.place)
    return float(np.nanmax(distance)) if np.isfinite(distance).any() else None


def middle_track(run: Run) -> TimedTrack:
    """Time (s), x and y (m) of the middle between the boots over a run."""
    return TimedTrack(run.time, run.place[:, 0], run.place[:, 1])


def band_width(nominal: TimedTrack, tracks: Sequence[TimedTrack]) -> tuple[float, float]:
    """Widths (m), across and along the track, of the band with 90 % of the runs, at the last time that three reach."""
    aside, ahead = (band_of(values[:, None])[:, 0] for values in end_offsets(nominal, tracks))
    return float(aside[4] - aside[0]), float(ahead[4] - ahead[0])


def end_offsets(nominal: TimedTrack, tracks: Sequence[TimedTrack]) -> tuple[FloatArray, FloatArray]:
    """Offsets of the tracks to the left and ahead (m), shape (tracks,), at the last time that three runs reach.

    NaN for a run that ended before.
    """
    aside, ahead = offsets(nominal, tracks)
    last = int(np.flatnonzero(np.isfinite(aside).sum(axis=0) >= FEWEST)[-1])
    return aside[:, last], ahead[:, last]


@dataclass(frozen=True, slots=True, eq=False)
class BandShares:
    """Share of each input of an ensemble in the variance at the end of the band, aside and ahead."""

    keys: tuple[str, ...]
    aside: VarianceShares
    ahead: VarianceShares


def band_shares(nominal: TimedTrack, ensemble: Sequence[EnsembleRun]) -> BandShares | None:
    """First-order Sobol shares of the inputs in the variance at the band's end; None with too few runs."""
    keys = [key for key in (ensemble[0].values if ensemble else ()) if len({run.values[key] for run in ensemble}) > 1]
    if not keys:
        return None
    aside, ahead = end_offsets(nominal, [run.track for run in ensemble])
    reached = np.isfinite(aside)
    if reached.sum() < len(keys) + MORE_THAN_INPUTS:
        return None
    inputs = np.log([[run.values[key] for key in keys] for run in ensemble])[reached]
    return BandShares(tuple(keys), *(variance_shares(offset[reached], inputs) for offset in (aside, ahead)))


@dataclass(frozen=True, slots=True)
class BandInput:
    """One uncertain input of the ensemble of runs.

    key: key of the scenario.

    spread: origin of the spread: ``measured`` by the campaign, or ``prior``.
    value: median in the key's unit; None for a prior.
    low, high: ends in the key's unit: of the 95 % interval of a measured input, of the whole range of a prior.
    """

    key: str
    spread: str
    distribution: str
    value: float | None
    low: float
    high: float
    origin: str

    @property
    def in_words(self) -> str:
        """Message about the distribution of an ensemble's input: measured interval or prior, with its origin."""
        if self.spread == "measured":
            return Message("measured: log-normal with the 95 % interval of {origin}", origin=self.origin)
        return Message("prior: even in its logarithm; {origin}", origin=self.origin)


def band_inputs(chain: TurnChain) -> Iterator[BandInput]:
    """Uncertain inputs of the ensemble: first the measured ones, then the priors."""
    for of in chain.measured:
        yield BandInput(of.key, "measured", "log-normal", of.value, of.low, of.high, chain.site)
    own = values_of(chain.nominal.scenario)
    for prior in chain.priors:
        yield BandInput(prior.key, "prior", "log-uniform", None, *prior.ends(own[prior.key]), prior.origin)


SCHEMA_VERSION: Final = 1


def turn_dict(chain: TurnChain) -> dict[str, Any]:
    """The JSON of `skisnow turn`, and the contents of turn.json; its JSON Schema is that of ``skisnow schema turn``."""
    across, along = band_width(middle_track(chain.nominal), [run.track for run in chain.ensemble])
    return {
        "schema_version": SCHEMA_VERSION,
        "campaign": chain.campaign,
        "site": chain.site,
        "synthetic": chain.synthetic,
        "snow": {
            **_numbers_dict(chain.snow),
            "unloading_ratio": json_number(chain.snow.unloading_ratio),
            "shear_displacement_mm": json_number(chain.nominal.scenario.contact.shear_displacement / MM),
            **snow_dict(chain.snow),
        },
        "runs": [_run_dict(name, run, chain.nominal) for name, run in chain.runs.items()],
        "ensemble": {
            "seed": chain.seed,
            "band_across_m": json_number(across),
            "band_along_m": json_number(along),
            "nominal_end_moves_m": json_number(chain.ensemble_error),
            "inputs": [asdict(row) for row in band_inputs(chain)],
            "priors": [
                {"key": row.key, "low": row.low, "high": row.high, "times_own": row.about, "origin": row.origin}
                for row in chain.priors
            ],
            "runs": [_ensemble_dict(row) for row in chain.ensemble],
        },
        "sentences": chain.sentences,
        "warnings": list(chain.warnings),
    }


def _run_dict(contact: str, run: Run, nominal: Run) -> dict[str, Any]:
    """JSON of a run: key results, summary, and its distance (m) from the nominal run, None for that itself."""
    grip, slips = used_grip(run)
    return {
        "contact": contact,
        "afterbody_depth_ratio": json_number(afterbody_depth_ratio(run)),
        "grip_utilisation": json_number(grip),
        "side_slip_share": json_number(slips),
        "distance_from_first_m": None if run is nominal else json_number(maximum_distance(run, nominal)),
        "summary": summary_dict(run, warnings=implausible_values(run.scenario)),
    }


def _ensemble_dict(run: EnsembleRun) -> dict[str, Any]:
    """JSON of a run of the ensemble: snow, drawn values, outcome and its end."""
    track = run.track
    ends = {"end_time_s": track.time, "end_x_m": track.x, "end_y_m": track.y}
    return {
        **_numbers_dict(run.snow),
        "values": {key: json_number(value) for key, value in run.values.items()},
        "outcome": run.outcome,
        "side_slip_share": json_number(run.slips),
        **{name: json_number(column[-1]) for name, column in ends.items()},
    }


def _numbers_dict(snow: SnowProperties) -> dict[str, float | None]:
    """H_V (N/mm³) and S_f (N/mm², None if unknown) of a snow for JSON."""
    stress = snow.failure_shear_stress
    return {
        "H_V_N_per_mm3": snow.snow_hardness / N_PER_MM3,
        "S_f_N_per_mm2": None if stress is None else stress / N_PER_MM2,
    }
