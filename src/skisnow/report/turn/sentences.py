"""Sentences about a turn, with its numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from markupsafe import Markup

from ..._support.messages import Message, outcome_words, template
from ..._support.units import MM, N_PER_MM2, N_PER_MM3
from ...simulation.run import Run
from ..formatting import counted, html, interval, prose, significant
from .chain import (
    BandShares,
    TurnChain,
    afterbody_depth_ratio,
    band_inputs,
    band_shares,
    band_width,
    maximum_distance,
    median_radius,
    middle_track,
    used_grip,
)

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
    spreads = [_band_sentence(chain), *_spreads(chain), *_largest_share(chain)]
    warnings = [prose("Warning: {text}.", text=text) for text in chain.warnings]
    return [_snow_sentence(chain), *contacts, *contrast(chain), *spreads, *warnings]


def headline(chain: TurnChain) -> Markup:
    """Sentence with the turn radius and the precision of the end of the run."""
    radius = median_radius(chain.nominal)
    aside, ahead = _band_widths(chain)
    fields = {
        "aside": significant(aside, 2),
        "ahead": significant(ahead, 2),
        "runs": counted(len(chain.ensemble), "{count} run", "{count} runs"),
    }
    if radius is None:
        return prose(
            "The run is straight; its end is known within {aside} m across and {ahead} m along the track (90 % of "
            "{runs}).",
            **fields,
        )
    return prose(
        "Turn radius {value} (median); its end is known within {aside} m across and {ahead} m along the track (90 % of "
        "{runs}).",
        value=Markup("<strong>{} m</strong>").format(significant(radius)),
        **fields,
    )


def plain_sentences(chain: TurnChain) -> list[Markup]:
    """Differences between the contacts, and the inputs of the band."""
    return [*contrast(chain), *_spreads(chain)]


def _spreads(chain: TurnChain) -> list[Markup]:
    """Sentence that lists the inputs with a measured spread and those with a prior; empty without inputs."""
    inputs = list(band_inputs(chain))
    if not inputs:
        return []
    measured, assumed = (
        _key_list([row.key for row in inputs if row.spread == spread]) for spread in ("measured", "prior")
    )
    return [
        prose(
            "The band draws {measured} from the intervals that the campaign measured, {assumed} from priors.",
            measured=measured,
            assumed=assumed,
        )
    ]


def _key_list(keys: Sequence[str]) -> Markup:
    *before, last = [_in_words(key) for key in keys] or [prose("nothing")]
    return prose("{before} and {last}", before=Markup(", ").join(before), last=last) if before else last


def _largest_share(chain: TurnChain) -> list[Markup]:
    """Sentence with the input of the largest share in the variance across the track; empty without shares."""
    shares = _shares(chain)
    if shares is None:
        return []
    first, *others = np.argsort(-shares.aside.share, kind="stable").tolist()
    fields = {
        "key": _in_words(shares.keys[first]),
        "percent": significant(100.0 * float(shares.aside.share[first]), 2),
        "interval": interval((100.0 * shares.aside.interval[first]).tolist(), 2),
    }
    if not others:
        return [
            prose("Most of that across the track comes from {key}: {percent} % of the variance {interval}.", **fields)
        ]
    return [
        prose(
            "Most of that across the track comes from {key}: {percent} % of the variance {interval}; next is {second}.",
            second=_in_words(shares.keys[others[0]]),
            **fields,
        )
    ]


def _in_words(key: str) -> Markup:
    return html(_INPUTS[key][0] if key in _INPUTS else key)


def _shares(chain: TurnChain) -> BandShares | None:
    """Shares of the band's inputs; None if no input changes its end."""
    shares = band_shares(middle_track(chain.nominal), chain.ensemble)
    return shares if shares is not None and shares.aside.share.any() else None


def _snow_sentence(chain: TurnChain) -> Markup:
    snow = chain.snow
    of_hardness, of_stress = snow.snow_hardness_interval, snow.failure_shear_stress_interval
    return prose(
        "Snow of {site}: H_V {hardness} N/mm³ {of_hardness}, S_f {stress} N/mm² {of_stress}{ratio}{displacement}.",
        site=chain.site,
        ratio=_ratio(snow.unloading_ratio, snow.unloading_ratio_interval),
        displacement=_displacement(snow.shear_displacement, snow.shear_displacement_interval),
        hardness=significant(snow.snow_hardness / N_PER_MM3),
        of_hardness=interval(of_hardness and [end / N_PER_MM3 for end in of_hardness]),
        stress=significant(None if snow.failure_shear_stress is None else snow.failure_shear_stress / N_PER_MM2),
        of_stress=interval(of_stress and [end / N_PER_MM2 for end in of_stress]),
    )


def _ratio(value: float | None, ends: tuple[float, float] | None) -> Markup:
    """k_u/H_V with its interval; empty if it was not measured."""
    is_measured = value is not None and ends is not None
    return (
        prose(", k_u / H_V {value} {ends}", value=significant(value), ends=interval(ends)) if is_measured else html("")
    )


def _displacement(value: float | None, ends: tuple[float, float] | None) -> Markup:
    """u_y with its interval; empty without one."""
    if value is None or ends is None:
        return html("")
    return prose(", u_y {value} mm {ends}", value=significant(value / MM), ends=interval([end / MM for end in ends]))


def _contact_sentence(name: str, run: Run) -> Markup:
    grip, slides = used_grip(run)
    return prose(
        "{name}: {outcome} after {length} m and {time} s. The afterbody/forebody edge-depth ratio is {ratio}; the more "
        "heavily loaded (outer) ski has a grip utilisation of {grip} and side-slips in {slides} % of the time.",
        name=html(str(name)[:1].upper() + str(name)[1:]),
        outcome=outcome_words(run.outcome),
        length=significant(run.run_length),
        time=significant(run.simulated_s),
        ratio=significant(afterbody_depth_ratio(run), 2),
        grip=significant(grip, 2),
        slides=significant(None if slides is None else 100.0 * slides, 2),
    )


def contrast(chain: TurnChain) -> list[Markup]:
    """Differences of the other contacts from the first: turn radius, grip utilisation, edge-depth ratio."""
    (first, reference), *others = chain.runs.items()
    return [sentence for name, run in others for sentence in _contrast(html(name), run, html(first), reference)]


def _contrast(name: Markup, run: Run, first: Markup, reference: Run) -> list[Markup]:
    grips = used_grip(run)[0], used_grip(reference)[0]
    ratios = afterbody_depth_ratio(run), afterbody_depth_ratio(reference)
    grip = prose(_GRIPS[_compared(*grips)], values=_value_against_other(*grips))
    return [
        _compare_radii(name, median_radius(run), first, reference),
        Markup(" ").join([grip, _compare_slip(name, run, first, reference)]),
        prose(_DEPTH_RATIOS[_compared(*ratios)], values=_value_against_other(*ratios)),
        prose("The tracks lie up to {distance} m apart.", distance=significant(maximum_distance(run, reference))),
    ]


_GRIPS: Final = (
    template("Its grip utilisation is lower: {values}."),
    template("Its grip utilisation is the same: {values}."),
    template("Its grip utilisation is higher: {values}."),
)
_DEPTH_RATIOS: Final = (
    template("Its afterbody/forebody edge-depth ratio is smaller: {values}."),
    template("Its afterbody/forebody edge-depth ratio is the same: {values}."),
    template("Its afterbody/forebody edge-depth ratio is larger: {values}."),
)
"""Sentences for a value that is smaller than, equal to and larger than the other."""


def _compare_radii(name: Markup, radius: float | None, first: Markup, reference: Run) -> Markup:
    other = median_radius(reference)
    if radius is None or other is None:
        return prose("The turn with the contact “{name}” or that with “{first}” never turns.", name=name, first=first)
    fields = {"name": name, "first": first, "percent": significant(100.0 * abs(radius / other - 1.0), 2),
              "radius": significant(radius), "other": significant(other)}  # fmt: skip
    if abs(radius / other - 1.0) < ALIKE:
        return prose(
            "The turn with the contact “{name}” is as wide as that with “{first}”: median radius {radius} against "
            "{other} m.",
            **fields,
        )
    if radius > other:
        return prose(
            "The turn with the contact “{name}” is wider than that with “{first}”, by {percent} %: median radius "
            "{radius} against {other} m.",
            **fields,
        )
    return prose(
        "The turn with the contact “{name}” is narrower than that with “{first}”, by {percent} %: median radius "
        "{radius} against {other} m.",
        **fields,
    )


def _compare_slip(name: Markup, run: Run, first: Markup, reference: Run) -> Markup:
    """Sentence about which of two runs side-slip."""
    sliding = [label for label, of in ((name, run), (first, reference)) if (used_grip(of)[1] or 0.0) > HELD]
    if not sliding:
        return prose("Grip holds in both.")
    return prose("Both side-slip.") if len(sliding) == 2 else prose("“{who}” side-slips.", who=sliding[0])


def _compared(value: float | None, other: float | None) -> int:
    """0 if the value is smaller than the other, 1 if they are alike or unknown, 2 if it is larger."""
    if value is None or other is None or abs(value - other) < ALIKE * abs(other):
        return 1
    return 2 if value > other else 0


def _value_against_other(value: float | None, other: float | None) -> str:
    return str(Message("{value} against {other}", value=significant(value), other=significant(other)))


def _band_sentence(chain: TurnChain) -> Markup:
    aside, ahead = _band_widths(chain)
    return prose(
        "Over all that is not known, 90 % of {runs} end within {aside} m across and {ahead} m along the track.",
        runs=counted(len(chain.ensemble), "{count} run", "{count} runs"),
        aside=significant(aside, 2),
        ahead=significant(ahead, 2),
    )


def _band_widths(chain: TurnChain) -> tuple[float, float]:
    return band_width(middle_track(chain.nominal), [run.track for run in chain.ensemble])


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


def meaning(chain: TurnChain) -> list[Markup]:
    """Effects of the contact and of the unknown inputs on the track, and the measurement that would help most."""
    reference, *others = chain.runs.values()
    aside, _ = _band_widths(chain)
    far = max(maximum_distance(run, reference) or 0.0 for run in others)  # a run without a step moved nowhere
    contacts = prose(
        "The choice of the contact moves the track by up to {far} m, the unknown inputs of the turn move it by "
        "{aside} m (width of the band with 90 % of the runs at the end).",
        far=significant(far, 2),
        aside=significant(aside, 2),
    )
    grip = prose("The grip holds while the side force stays below the shear capacity: S_f times depth times length.")
    if any((used_grip(run)[1] or 0.0) > HELD for run in (reference, *others)):
        grip += prose(
            " An edge enters hard snow only a little and has little to hold: here the skis side-slip. A slower "
            "start, a gentler slope or softer snow brings them back on their edges."
        )
    return [Markup(" ").join([contacts, *_best_measurement(chain)]), grip]


def _best_measurement(chain: TurnChain) -> list[Markup]:
    """Sentence with the measurement that would narrow the band most; empty without shares."""
    shares = _shares(chain)
    if shares is None:
        return []
    key = shares.keys[int(np.argmax(shares.aside.share))]
    tests = _FURTHER if key in {measured.key for measured in chain.measured} else {}
    test = tests.get(key) or (_INPUTS[key][1] if key in _INPUTS else Message("a better value of {key}", key=key))
    return [prose("The band would narrow most by {test}.", test=html(test))]
