"""Page of the chain from a campaign to a turn: snow with intervals, a turn with each contact, an ensemble."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from markupsafe import Markup

from ..._support.errors import ParameterError
from ..._support.language import ENGLISH, require_language
from ..._support.messages import Message
from ..._support.staging import require_writable, write_file
from ..._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from ...scenario.keys import scenario_values
from ..figures.drawing import Drawing
from ..figures.figure_files import write_pictures
from ..formatting import json_text, significant
from ..run.page import CHOICES
from ..run.tables import scenario_table
from ..run.time_figures import run_along_ski, run_grip
from ..sheet import Header, Section, sheet
from ..symbols import figure_text, html, prose
from ..table import Column, Table
from .figures import FEWEST, draw_runs, track_band
from .numbers import (
    BandShares,
    afterbody_depth_ratio,
    band_inputs,
    band_shares,
    median_radius,
    middle_track,
    turn_dict,
    used_grip,
)
from .sentences import ensemble_accuracy, ensemble_sentence, headline, key_sentences, meaning

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...simulation.run import Run
    from ...snow import SnowProperties
    from ..figures.drawing import Picture
    from .chain import EnsembleRun, TurnChain

FIGURES: Final = ("contacts", "along_ski", "grip", "band")
"""Names of the figures of such a report, in figures/ as .png and .svg."""


def write_turn_report(chain: TurnChain, folder: str | Path, *, language: str = ENGLISH) -> Path:
    """Write report.html, turn.json and figures/; the language applies to page and figures.

    Returns
    -------
    Path
        Path of report.html, which is written last.

    Raises
    ------
    ParameterError
        There are fewer than two contacts or too few runs for a band, or the language is unknown.
    OutputError
        A file cannot be written.
    """
    if len(chain.runs) < 2 or len(chain.ensemble) < FEWEST:
        raise ParameterError(
            Message(
                "there are {contacts} contacts and {runs} runs of the ensemble; the report needs 2 "
                "and {fewest} at least",
                contacts=len(chain.runs),
                runs=len(chain.ensemble),
                fewest=FEWEST,
            ),
            code="too_few_runs",
        )
    require_language(language)
    folder = Path(folder)
    require_writable(folder)
    names = names_in(chain)
    pictures = write_pictures(
        _drawings(chain), folder / "figures", every=FIGURES, language=language, names=frozenset(map(figure_text, names))
    )
    write_file(folder / "turn.json", f"{json_text(turn_dict(chain))}\n")
    write_file(folder / "report.html", turn_page(chain, pictures, language=language))
    return folder / "report.html"


def turn_page(chain: TurnChain, pictures: Sequence[Picture], *, language: str = ENGLISH) -> str:
    """HTML of the report."""
    return sheet(_header(chain), _sections(chain, pictures), language=language, names=names_in(chain))


def names_in(chain: TurnChain) -> frozenset[str]:
    """Names from users and words of scenario files, which are not translated."""
    skis = {run.scenario.ski.name for run in chain.runs.values()}
    return CHOICES | skis | {chain.campaign, chain.site, chain.snow.source}


def _drawings(chain: TurnChain) -> Iterator[Drawing]:
    name, nominal = next(iter(chain.runs.items()))
    yield Drawing(
        "contacts",
        html(
            "The turn with each contact: from above, distance from the first track, and depth along the more heavily "
            "loaded ski. Squares: ends."
        ),
        "Tracks from above, distances and depth along the ski, one line for each contact.",
        draw_runs(chain.runs),
        wide=True,
    )
    yield Drawing(
        "along_ski",
        prose(
            "Edge depth and normal force per length along both skis, {name}. White: no contact, or no force.",
            name=html(name),
        ),
        "Maps of edge depth and normal force per length over position along the ski and time.",
        run_along_ski(nominal),
        wide=True,
    )
    yield Drawing(
        "grip",
        prose("Grip utilisation of each ski: side force over the shear capacity S_f e, {name}.", name=html(name)),
        "Grip utilisation of each ski over time.",
        run_grip(nominal),
        wide=True,
    )
    yield Drawing(
        "band",
        prose(
            "The turn ({name}) over what is not known of snow, friction and ski: tracks from above, and below how far "
            "each run is beside and ahead of the nominal one at the same time.",
            name=html(name),
        ),
        "Band of tracks from above, and offsets over time.",
        track_band(middle_track(nominal), [run.track for run in chain.ensemble]),
        wide=True,
    )


def _header(chain: TurnChain) -> Header:
    nominal = next(iter(chain.runs.values()))
    facts = [
        ("Campaign", chain.campaign),
        ("Site", chain.site),
        ("Skis", nominal.scenario.ski.name),
        ("Computed", f"skisnow {version('skisnow')}"),
    ]
    said = (
        "This snow was not measured: the campaign, and with it every parameter, turn and band below, comes from a "
        "random number generator."
    )
    return Header(
        "From a field campaign to a turn",
        f"A turn on the snow of {chain.site}",
        facts,
        said if chain.synthetic else "",
        headline(chain),
    )


def _sections(chain: TurnChain, pictures: Sequence[Picture]) -> list[Section]:
    by_name = {picture.name: picture for picture in pictures}
    nominal = next(iter(chain.runs.values()))
    contacts = html(
        "The hypoplastic contact depends on the history of loading: the forebody leaves a permanent groove, and the "
        "afterbody runs in it. The elastic contact has no history: the groove closes under the afterbody as the load "
        "passes. What that changes in this turn is listed under the key results: most where the turn needs a little "
        "more side force than elastic snow can give. " + _ratio_in_words(chain)
    )
    drawn = prose(
        "{count} runs with all that the table below names drawn at random (Latin hypercube, seed {seed}). The "
        "measured intervals are those of the site's means: the snow's change from place to place would widen the "
        "band. What the table does not name is taken as known.",
        count=len(chain.ensemble),
        seed=chain.seed,
    )
    return [
        Section("key-results", "Key results", key=key_sentences(chain)),
        Section("snow", "The snow that was found", words=[_snow()], tables=[parameters_table(chain.snow)]),
        Section(
            "contacts",
            "The turn with each contact",
            words=[contacts],
            pictures=[by_name["contacts"]],
            tables=[contacts_table(chain.runs)],
        ),
        Section(
            "along-skis", "Along the skis, with the first contact", pictures=[by_name["along_ski"], by_name["grip"]]
        ),
        Section(
            "ensemble",
            "Over what is not known",
            words=[drawn, *ensemble_accuracy(chain)],
            pictures=[by_name["band"]],
            tables=[shares_table(chain), ensemble_table(chain.ensemble)],
            after=[ensemble_sentence(chain)],
        ),
        Section("meaning", "What it means", words=meaning(chain)),
        Section("scenario", "Scenario", tables=[scenario_table(scenario_values(nominal.scenario))]),
        Section("provenance", "Provenance", words=[_provenance(chain)]),
    ]


def _snow() -> Markup:
    return html(
        "H_V is the geometric mean over the used penetration experiments of the site, S_f the mean over its used shear "
        "experiments, each with its 95 % interval by Student's t. Where they were measured, k_u / H_V is the harmonic "
        "mean over the series with unloading, u_y the geometric mean over the shear tests with turning angles."
    )


def _ratio_in_words(chain: TurnChain) -> str:
    if chain.snow.unloading_ratio_interval is not None:
        return "k_u / H_V is that of the site's unloading."
    return "k_u / H_V was not measured here, nor is it published; it is a parameter."


def _provenance(chain: TurnChain) -> Markup:
    return prose(
        "Snow from {source}. Computed with skisnow {version}; {runs} in {seconds} s, without the ensemble. Unrounded "
        "numbers: {file}.",
        file=Markup("<code>turn.json</code>"),
        source=chain.snow.source,
        version=version("skisnow"),
        runs=f"{len(chain.runs)} runs",
        seconds=significant(sum(run.wall_s for run in chain.runs.values())),
    )


def parameters_table(snow: SnowProperties) -> Table:
    """Table of H_V and S_f with their intervals, and of k_u/H_V and u_y if they have one."""
    rows = [
        ("snow hardness H_V", "N/mm³", _scaled(snow.snow_hardness, N_PER_MM3),
         _both(snow.snow_hardness_interval, N_PER_MM3)),
        ("failure shear stress S_f", "N/mm²", _scaled(snow.failure_shear_stress, N_PER_MM2),
         _both(snow.failure_shear_stress_interval, N_PER_MM2)),
    ]  # fmt: skip
    if snow.unloading_ratio_interval is not None:
        rows.append(("k_u / H_V", "", snow.unloading_ratio, snow.unloading_ratio_interval))
    if snow.shear_displacement_interval is not None:
        way = _scaled(snow.shear_displacement, MM), _both(snow.shear_displacement_interval, MM)
        rows.append(("shear displacement u_y", "mm", *way))
    return Table(
        "parameters",
        "The snow of the site, with 95 % intervals of the means.",
        (
            Column("parameter", "Parameter", "words"),
            Column("unit", "Unit", "text"),
            Column("value", "Value"),
            Column("interval", "95 % interval", "interval"),
        ),
        rows,
    )


def _scaled(value: float | None, unit: float) -> float | None:
    return None if value is None else value / unit


def _both(interval: tuple[float, float] | None, unit: float) -> tuple[float, float] | None:
    return None if interval is None else (interval[0] / unit, interval[1] / unit)


def contacts_table(runs: Mapping[str, Run]) -> Table:
    """Table with one row for each contact."""
    return Table(
        "contacts",
        "The turn with each contact.",
        (
            Column("contact", "Contact", "words"),
            Column("outcome", "Outcome", "text"),
            Column("run_length_m", "Distance travelled", unit="m"),
            Column("end_speed_m_per_s", "Speed at the end", unit="m/s"),
            Column("turned_deg", "Change of heading", unit="°"),
            Column("turn_radius_m", "Median radius", unit="m"),
            Column("depth_mm", "Maximum edge depth", unit="mm"),
            Column("afterbody_depth_ratio", "Afterbody / forebody"),
            Column("grip", "Grip utilisation"),
            Column("slides", "Share of time side-slipping"),
        ),
        [_contact(name, run) for name, run in runs.items()],
        note="Afterbody / forebody: edge-depth ratio, the mean edge depth of the contact behind the boot over that "
        "before it, of the more heavily loaded (outer) ski, median over the second half. Grip utilisation: side force "
        "over the shear capacity S_f ∫ e ds of that ski, median over the run; it side-slips where that is above 0.95.",
    )


def _contact(name: str, run: Run) -> tuple[Any, ...]:
    heading = np.unwrap(run.heading)
    return (
        name,
        run.outcome.replace("_", " "),
        run.run_length,
        float(run.speed[-1]),
        float(heading[-1] - heading[0]) / DEGREE,
        median_radius(run),
        float(np.nanmax(run.skis.edge_depth)) / MM,
        afterbody_depth_ratio(run),
        *used_grip(run),
    )


def ensemble_table(ensemble: Sequence[EnsembleRun]) -> Table:
    """Table of the outcomes of the ensemble with the ranges of the sampled snow."""
    counts = Counter(run.outcome for run in ensemble)
    rows = []
    for outcome, count in counts.most_common():
        those = [run for run in ensemble if run.outcome == outcome]
        hardness = [run.snow.snow_hardness / N_PER_MM3 for run in those]
        stress = [(run.snow.failure_shear_stress or 0.0) / N_PER_MM2 for run in those]
        rows.append((outcome.replace("_", " "), count, (min(hardness), max(hardness)), (min(stress), max(stress))))
    return Table(
        "ensemble",
        "How the runs of the ensemble ended, and the snow that was drawn for them.",
        (
            Column("outcome", "Outcome", "text"),
            Column("runs", "Runs", "count"),
            Column("H_V_N_per_mm3", "H_V", "range", unit="N/mm³"),
            Column("S_f_N_per_mm2", "S_f", "range", unit="N/mm²"),
        ),
        rows,
    )


def shares_table(chain: TurnChain) -> Table:
    """Table of the inputs of the band with their shares in the variance at its end."""
    shares = band_shares(middle_track(chain.nominal), chain.ensemble)
    return Table(
        "band_inputs",
        "Inputs of the band, and how much each adds to the variance of the places at its end.",
        (
            Column("key", "Input", "text"),
            Column("range", "Range", "range"),
            Column("origin", "Measured or prior, distribution and origin", "words"),
            Column("aside_percent", "Share of the offset across", "estimate", unit="%", digits=2),
            Column("ahead_percent", "Share of the offset along", "estimate", unit="%", digits=2),
        ),
        [*_inputs(chain, shares), *_unexplained(shares)],
        note="Shares: first-order Sobol indices by linear regression on the logarithms of the inputs, with 95 % "
        "intervals. What is left over does not follow any input in proportion: curvature, thresholds such as an edge "
        "that loses its grip, and the interplay of inputs.",
    )


def _inputs(chain: TurnChain, shares: BandShares | None) -> Iterator[tuple[Any, ...]]:
    for band_input in band_inputs(chain):
        yield (
            band_input.key,
            (band_input.low, band_input.high),
            band_input.in_words,
            *_shares_of(band_input.key, shares),
        )


def _shares_of(key: str, shares: BandShares | None) -> tuple[Any, Any]:
    """Shares of an input in the variance across and along (%) with intervals; (None, None) if it does not vary."""
    if shares is None or key not in shares.keys:
        return (None, None), (None, None)
    place = shares.keys.index(key)
    across, along = (
        (100.0 * float(direction.share[place]), tuple((100.0 * direction.interval[place]).tolist()))
        for direction in (shares.aside, shares.ahead)
    )
    return across, along


def _unexplained(shares: BandShares | None) -> list[tuple[Any, ...]]:
    if shares is None:
        return []
    across, along = ((100.0 * direction.left, None) for direction in (shares.aside, shares.ahead))
    return [("left over", None, "", across, along)]
