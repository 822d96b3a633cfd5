"""Sentences about a turn, with its numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np
from markupsafe import Markup

from ..._support.messages import Message, outcome_words, template
from ..._support.units import MM, N_PER_MM2, N_PER_MM3
from ...simulation.run import Run
from ..formatting import counted, html, interval, prose, significant
from . import chain as results
from .chain import BandShares, TurnChain

ALIKE: Final = 0.002  # relative difference below which two numbers are called the same
HELD: Final = 0.05  # share of the time with side-slip up to which a ski holds its grip
_INPUTS: Final = {
    "snow.H_V_N_per_mm3": (Message("the snow hardness H_V"), Message("further penetration tests at this site")),
    "snow.S_f_N_per_mm2": (Message("the failure shear stress S_f"), Message("further shear tests at this site")),
    "snow.unloading_ratio": ("k_u / H_V", Message("depths read while the discs are taken off one by one, for k_u")),
    "snow.shear_displacement_mm": (
        Message("the shear displacement u_y"),
        Message("the turning angle at each moment of the shear device, for u_y"),
    ),
    "friction.mu_0": (Message("the friction μ_0"), Message("a straight glide past photo cells, for μ_0")),
    "ski.stiffness_factor": (
        Message("the stiffness of the ski"),
        Message("the bending and torsion of the ski, measured"),
    ),
    "ski.camber_rounding_mm": (
        Message("the rounding of the camber"),
        Message("the height of the unloaded base along the ski, measured"),
    ),
}
"""Names of the band's inputs, and the measurement that would determine them better."""
_FURTHER: Final = {
    "snow.unloading_ratio": Message("further series with discs taken off one by one at this site, for k_u"),
    "snow.shear_displacement_mm": Message("further shear tests with turning angles at this site, for u_y"),
}
"""Measurement that would determine an already measured input better."""


def key_sentences(chain: TurnChain) -> list[Markup]:
    """Key sentences: snow, contacts, band, and warnings near the limit of grip."""
    contacts = [_contact_sentence(name, run) for name, run in chain.runs.items()]
    band = prose(
        "Over all that is not known, 90 % of {runs} end within {aside} m across and {ahead} m along the track.",
        **_band_fields(chain),
    )
    warnings = [prose("Warning: {text}.", text=text) for text in chain.warnings]
    spreads = [band, *_spreads(chain), *_largest_share(chain)]
    return [_snow_sentence(chain), *contacts, *contrast(chain), *spreads, *warnings]


def headline(chain: TurnChain) -> Markup:
    """Sentence with the turn radius and the precision of the end of the run."""
    radius = results.median_radius(chain.nominal)
    sentence = template(
        "Turn radius {value} (median); its end is known within {aside} m across and {ahead} m along the track (90 % of "
        "{runs})."
    )
    if radius is None:
        sentence = template(
            "The run is straight; its end is known within {aside} m across and {ahead} m along the track (90 % of "
            "{runs})."
        )
    return prose(sentence, value=Markup("<strong>{} m</strong>").format(significant(radius)), **_band_fields(chain))


def plain_sentences(chain: TurnChain) -> list[Markup]:
    """Differences between the contacts, and the inputs of the band."""
    return [*contrast(chain), *_spreads(chain)]


def _spreads(chain: TurnChain) -> Iterator[Markup]:
    """Sentence that lists the inputs with a measured spread and those with a prior; none without inputs."""
    lists, inputs = [], list(results.band_inputs(chain))
    for spread in ("measured", "prior"):
        *before, last = [_in_words(row.key) for row in inputs if row.spread == spread] or [prose("nothing")]
        joined = prose("{before} and {last}", before=Markup(", ").join(before), last=last)
        lists.append(joined if before else last)
    if inputs:
        yield prose(
            "The band draws {measured} from the intervals that the campaign measured, {assumed} from priors.",
            measured=lists[0],
            assumed=lists[1],
        )


def _largest_share(chain: TurnChain) -> Iterator[Markup]:
    """Sentence with the input of the largest share in the variance across the track; none without shares."""
    shares = _shares(chain)
    if shares is None:
        return
    first, *others = np.argsort(-shares.aside.share, kind="stable").tolist()
    sentence = template("Most of that across the track comes from {key}: {percent} % of the variance {interval}.")
    if others:
        sentence = template(
            "Most of that across the track comes from {key}: {percent} % of the variance {interval}; next is {second}."
        )
    yield prose(
        sentence,
        key=_in_words(shares.keys[first]),
        percent=significant(100.0 * float(shares.aside.share[first]), 2),
        interval=interval((100.0 * shares.aside.interval[first]).tolist(), 2),
        second=_in_words(shares.keys[others[0]]) if others else "",
    )


def _in_words(key: str) -> Markup:
    """Words for an input, or its key if it has none."""
    return html(_INPUTS[key][0] if key in _INPUTS else key)


def _shares(chain: TurnChain) -> BandShares | None:
    """Shares of the inputs in the variance at the band's end; None if there are none, or all are 0."""
    shares = results.band_shares(results.middle_track(chain.nominal), chain.ensemble)
    return shares if shares is not None and shares.aside.share.any() else None


def _snow_sentence(chain: TurnChain) -> Markup:
    """Sentence with the snow's quantities and intervals at the site; k_u/H_V and u_y only with intervals."""
    snow, ratio, displacement = chain.snow, Markup(""), Markup("")
    if snow.unloading_ratio is not None and snow.unloading_ratio_interval is not None:
        value, ends = significant(snow.unloading_ratio), interval(snow.unloading_ratio_interval)
        ratio = prose(", k_u / H_V {value} {ends}", value=value, ends=ends)
    if snow.shear_displacement is not None and snow.shear_displacement_interval is not None:
        value, ends = significant(snow.shear_displacement / MM), _interval_in(MM, snow.shear_displacement_interval)
        displacement = prose(", u_y {value} mm {ends}", value=value, ends=ends)
    return prose(
        "Snow of {site}: H_V {hardness} N/mm³ {of_hardness}, S_f {stress} N/mm² {of_stress}{ratio}{displacement}.",
        site=chain.site,
        ratio=ratio,
        displacement=displacement,
        hardness=significant(snow.snow_hardness / N_PER_MM3),
        of_hardness=_interval_in(N_PER_MM3, snow.snow_hardness_interval),
        stress=significant(None if snow.failure_shear_stress is None else snow.failure_shear_stress / N_PER_MM2),
        of_stress=_interval_in(N_PER_MM2, snow.failure_shear_stress_interval),
    )


def _interval_in(unit: float, ends: tuple[float, float] | None) -> str:
    """Text of an interval in a unit, given by its size in SI."""
    return interval(ends and [end / unit for end in ends])


def _contact_sentence(name: str, run: Run) -> Markup:
    """Sentence with a contact's outcome, edge-depth ratio, grip utilisation and side slip."""
    grip, slides = results.used_grip(run)
    return prose(
        "{name}: {outcome} after {length} m and {time} s. The afterbody/forebody edge-depth ratio is {ratio}; the more "
        "heavily loaded (outer) ski has a grip utilisation of {grip} and side-slips in {slides} % of the time.",
        name=html(str(name)[:1].upper() + str(name)[1:]),
        outcome=outcome_words(run.outcome),
        length=significant(run.run_length),
        time=significant(run.simulated_s),
        ratio=significant(results.afterbody_depth_ratio(run), 2),
        grip=significant(grip, 2),
        slides=significant(None if slides is None else 100.0 * slides, 2),
    )


def contrast(chain: TurnChain) -> list[Markup]:
    """Differences of the other contacts from the first: turn radius, grip utilisation, edge-depth ratio."""
    (first, reference), *others = chain.runs.items()
    return [sentence for name, run in others for sentence in _contrast(html(name), run, html(first), reference)]


def _contrast(name: Markup, run: Run, first: Markup, reference: Run) -> list[Markup]:
    """Sentences that compare a contact's radius, grip, edge depths and track with those of the first."""
    names = {"name": name, "first": first}
    radii = results.median_radius(run), results.median_radius(reference)
    (grip, slips), (other_grip, other_slips) = results.used_grip(run), results.used_grip(reference)
    slipping = [label for label, share in ((name, slips), (first, other_slips)) if (share or 0.0) > HELD]
    distance = significant(results.maximum_distance(run, reference))
    slip = prose("“{who}” side-slips.", who=slipping[0]) if slipping else prose("Grip holds in both.")
    slip = prose("Both side-slip.") if len(slipping) == 2 else slip
    return [
        prose("The turn with the contact “{name}” or that with “{first}” never turns.", **names)
        if None in radii
        else _compare(_RADII, *radii, **names),
        Markup(" ").join([_compare(_GRIPS, grip, other_grip), slip]),
        _compare(_DEPTH_RATIOS, results.afterbody_depth_ratio(run), results.afterbody_depth_ratio(reference)),
        prose("The tracks lie up to {distance} m apart.", distance=distance),
    ]


_GRIPS: Final = (
    template("Its grip utilisation is lower: {value} against {other}."),
    template("Its grip utilisation is the same: {value} against {other}."),
    template("Its grip utilisation is higher: {value} against {other}."),
)
_DEPTH_RATIOS: Final = (
    template("Its afterbody/forebody edge-depth ratio is smaller: {value} against {other}."),
    template("Its afterbody/forebody edge-depth ratio is the same: {value} against {other}."),
    template("Its afterbody/forebody edge-depth ratio is larger: {value} against {other}."),
)
_RADII: Final = (
    template(
        "The turn with the contact “{name}” is narrower than that with “{first}”, by {percent} %: median radius "
        "{value} against {other} m."
    ),
    template(
        "The turn with the contact “{name}” is as wide as that with “{first}”: median radius {value} against {other} m."
    ),
    template(
        "The turn with the contact “{name}” is wider than that with “{first}”, by {percent} %: median radius {value} "
        "against {other} m."
    ),
)
"""Sentences for a value that is smaller than, equal to and larger than the other."""


def _compare(sentences: Sequence[str], value: float | None, other: float | None, /, **fields: str) -> Markup:
    """One of three sentences: for a value that is smaller than the other, alike or unknown, or larger."""
    fields |= {"value": significant(value), "other": significant(other), "percent": ""}
    if value is None or other is None or abs(value - other) < ALIKE * abs(other):
        return prose(sentences[1], **fields)
    fields["percent"] = significant(100.0 * abs(value / other - 1.0), 2) if other else ""
    return prose(sentences[2 if value > other else 0], **fields)


def _band_fields(chain: TurnChain) -> dict[str, str]:
    """Fields of sentences, as texts: number of runs of the ensemble, and the widths of their band (m)."""
    aside, ahead = results.band_width(results.middle_track(chain.nominal), [run.track for run in chain.ensemble])
    runs = counted(len(chain.ensemble), "{count} run", "{count} runs")
    return {"runs": runs, "aside": significant(aside, 2), "ahead": significant(ahead, 2)}


def ensemble_sentence(chain: TurnChain) -> Markup:
    """Sentence with the numbers of runs that ended like the nominal one and that side-slipped."""
    alike = sum(run.outcome == chain.nominal.outcome for run in chain.ensemble)
    slipped = sum((run.slips or 0.0) > HELD for run in chain.ensemble)
    return prose(
        "{alike} of {all} runs ended like the nominal one ({outcome}); in {slipped} of them the more heavily loaded "
        "ski side-slips for more than {held} % of the time, beyond the limit of its grip.",
        slipped=slipped,
        held=significant(100.0 * HELD, 1),
        alike=alike,
        all=len(chain.ensemble),
        outcome=outcome_words(chain.nominal.outcome),
    )


def ensemble_accuracy(chain: TurnChain) -> list[Markup]:
    """Sentence with the error of the ensemble's longer time steps; empty if it is not known."""
    if chain.ensemble_error is None:
        return []
    return [
        prose(
            "The ensemble is computed in fewer time steps than the turns above: so computed, the nominal run ends "
            "{error} m from where it ends above.",
            error=significant(chain.ensemble_error, 2),
        )
    ]


def best_measurement(chain: TurnChain) -> list[Markup]:
    """Sentence with the measurement that would narrow the band most; empty without shares."""
    shares = _shares(chain)
    if shares is None:
        return []
    key = shares.keys[int(np.argmax(shares.aside.share))]
    test = _INPUTS[key][1] if key in _INPUTS else Message("a better value of {key}", key=key)
    if key in {measured.key for measured in chain.measured}:
        test = _FURTHER.get(key, test)
    return [prose("The band would narrow most by {test}.", test=html(test))]
