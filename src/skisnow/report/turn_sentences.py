"""What the chain from a campaign to a turn says, in sentences with its own numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from ..units import N_PER_MM2, N_PER_MM3
from .numerals import counted, interval, significant
from .symbols import html, prose
from .turn_numbers import afterbody_depth_ratio, band_width, greatest_distance, middle_track, used_grip

if TYPE_CHECKING:
    from markupsafe import Markup

    from ..simulate.run import Run
    from .turn_report import TurnChain

_UNLOADING: Final = (
    "How the snow unloads matters more here than how exactly it was measured: a test that presses, lifts and presses "
    "again would tell more about this turn than further tests of the kinds that were made."
)
_MEASURING: Final = (
    "How exactly the snow was measured matters more here than how it unloads: further tests at this site would tell "
    "more about this turn than a better contact."
)


def key_sentences(chain: TurnChain) -> list[Markup]:
    """Snow, contacts, band."""
    return [_snow(chain), *(_contact(name, run) for name, run in chain.runs.items()), *_apart(chain), _band(chain)]


def _snow(chain: TurnChain) -> Markup:
    snow = chain.snow
    of_hardness, of_stress = snow.snow_hardness_interval, snow.failure_shear_stress_interval
    return prose(
        "Snow of {site}: H_V {hardness} N/mm³ {of_hardness}, S_f {stress} N/mm² {of_stress}.",
        site=chain.site,
        hardness=significant(snow.snow_hardness / N_PER_MM3),
        of_hardness=interval(of_hardness and [end / N_PER_MM3 for end in of_hardness]),
        stress=significant(None if snow.failure_shear_stress is None else snow.failure_shear_stress / N_PER_MM2),
        of_stress=interval(of_stress and [end / N_PER_MM2 for end in of_stress]),
    )


def _contact(name: str, run: Run) -> Markup:
    grip, slides = used_grip(run)
    return prose(
        "{name}: {outcome} after {length} m and {time} s. The afterbody stands at {ratio} of the forebody's depth; "
        "the ski that carries more uses {grip} of its grip and slides across in {slides} % of the time.",
        name=html(name[:1].upper() + name[1:]),
        outcome=run.outcome.replace("_", " "),
        length=significant(run.run_length),
        time=significant(run.simulated_s),
        ratio=significant(afterbody_depth_ratio(run), 2),
        grip=significant(grip, 2),
        slides=significant(None if slides is None else 100.0 * slides, 2),
    )


def _apart(chain: TurnChain) -> list[Markup]:
    (first, reference), *others = chain.runs.items()
    return [
        prose(
            "The tracks with the contacts “{name}” and “{first}” lie up to {distance} m apart.",
            name=html(name),
            first=html(first),
            distance=significant(greatest_distance(run, reference)),
        )
        for name, run in others
    ]


def _band(chain: TurnChain) -> Markup:
    aside, ahead = _widths(chain)
    return prose(
        "Over the uncertainty of the snow, 90 % of {runs} end within {aside} m across and {ahead} m along the track.",
        runs=counted(len(chain.ensemble), "run"),
        aside=significant(aside, 2),
        ahead=significant(ahead, 2),
    )


def _widths(chain: TurnChain) -> tuple[float, float]:
    nominal = next(iter(chain.runs.values()))
    return band_width(middle_track(nominal), [run.track for run in chain.ensemble])


def ensemble_sentence(chain: TurnChain) -> Markup:
    """How many of the runs ended like the nominal one."""
    nominal = next(iter(chain.runs.values()))
    alike = sum(run.outcome == nominal.outcome for run in chain.ensemble)
    return prose(
        "{alike} of {all} runs ended like the nominal one ({outcome}).",
        alike=alike,
        all=len(chain.ensemble),
        outcome=nominal.outcome.replace("_", " "),
    )


def ensemble_accuracy(chain: TurnChain) -> list[Markup]:
    """What it costs that the ensemble is computed in a quicker way, where it is."""
    if chain.ensemble_error is None:
        return []
    return [
        prose(
            "The ensemble is computed in fewer time steps than the turns above: so computed, the nominal run ends "
            "{error} m from where it ends with control of the error.",
            error=significant(chain.ensemble_error, 2),
        )
    ]


def meaning(chain: TurnChain) -> list[Markup]:
    """Model against measurement: which of the two moves the track more."""
    reference, *others = chain.runs.values()
    aside, _ = _widths(chain)
    far = max(greatest_distance(run, reference) or 0.0 for run in others)  # a run without a step moved nowhere
    contacts = (
        "The choice of the contact moves the track by up to {far} m, the uncertainty of the measured snow by {aside} m "
        "(width of the band that holds 90 % at the end). "
    )
    more = _UNLOADING if far > aside else _MEASURING
    grip = (
        "An edge holds while the side force stays below S_f times the edge's depth times its length. Hard snow lets "
        "an edge in little and so offers little to hold on to: by the measured S_f the skis slide across where the "
        "share of grip is 1, and a smaller edge angle, a slower start or softer snow brings them back on their edges."
    )
    return [prose(contacts + more, far=significant(far, 2), aside=significant(aside, 2)), html(grip)]
