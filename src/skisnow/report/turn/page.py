"""Page of the chain from a campaign to a turn: snow with intervals, a turn with each contact, an ensemble."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure

from ..._support.errors import ParameterError, require_language
from ..._support.messages import ENGLISH, Message, in_language, outcome_words, template
from ..._support.staging import prepare_folder, staged, write_file
from ..._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from ...scenario.keys import in_sections, scenario_values
from ...simulation.run import Run
from ...snow import SnowProperties
from ..figures.drawing import Drawing, Picture, write_pictures
from ..formatting import counted, html, json_text, prose, significant
from ..run.tables import scenario_table
from ..run.time_figures import run_along_ski, run_grip
from ..sheet import Header, Section, sheet
from ..table import Column, Table
from . import chain as results
from .chain import BandShares, TurnChain
from .figures import FEWEST, draw_runs, track_band
from .sentences import best_measurement, ensemble_accuracy, ensemble_sentence, headline, key_sentences


def write_turn_report(chain: TurnChain, folder: str | Path, *, language: str = ENGLISH) -> Path:
    """Write report.html, turn.json and figures/; the language applies to page and figures.

    Returns: Path of report.html, which is written last.
    Raises ParameterError: there are fewer than two contacts or too few runs for a band, or the language is unknown.
    Raises OutputError: a file cannot be written.
    """
    if len(chain.runs) < 2 or len(chain.ensemble) < FEWEST:
        raise ParameterError(
            "there are {contacts} contacts and {runs} runs of the ensemble; the report needs 2 and {fewest} at least"
        ).tag("too_few_runs", contacts=len(chain.runs), runs=len(chain.ensemble), fewest=FEWEST)
    require_language(language)
    folder = Path(folder)
    prepare_folder(folder)
    with staged(folder, last="report.html") as stage:
        write_file(stage.path / "turn.json", f"{json_text(results.turn_dict(chain))}\n")
        with in_language(language):
            pictures = write_pictures(_make_drawings(chain), stage.path / "figures")
            write_file(stage.path / "report.html", turn_page(chain, pictures))
    return folder / "report.html"


_DRAWINGS: Final[dict[str, tuple[Callable[[TurnChain], Figure], str, Message]]] = {
    "contacts": (
        lambda chain: draw_runs(chain.runs),
        template(
            "The turn with each contact: from above, distance from the first track, and depth along the more heavily "
            "loaded ski. Squares: ends."
        ),
        Message("Tracks from above, distances and depth along the ski, one line for each contact."),
    ),
    "along_ski": (
        lambda chain: run_along_ski(chain.nominal),
        template("Edge depth and normal force per length along both skis, {name}. White: no contact, or no force."),
        Message("Maps of edge depth and normal force per length over position along the ski and time."),
    ),
    "grip": (
        lambda chain: run_grip(chain.nominal),
        template("Grip utilisation of each ski: side force over the shear capacity S_f e, {name}."),
        Message("Grip utilisation of each ski over time."),
    ),
    "band": (
        lambda chain: track_band(results.middle_track(chain.nominal), [run.track for run in chain.ensemble]),
        template(
            "The turn ({name}) with the unknown inputs of snow, friction and ski varied: tracks from above, and "
            "below the distance of each run beside and ahead of the nominal one at the same time."
        ),
        Message("Band of tracks from above, and offsets over time."),
    ),
}
"""Function, caption and alternative text of each figure of such a report, in figures/ by name."""
FIGURES: Final = tuple(_DRAWINGS)


def _make_drawings(chain: TurnChain) -> Iterator[Drawing]:
    """All figures in order; each is drawn when it is requested, so that it gets the style in force."""
    name = html(next(iter(chain.runs)))
    for figure, (draw, caption, alt) in _DRAWINGS.items():
        yield Drawing(figure, prose(caption, name=name), alt, draw(chain), wide=True)


def _make_header(chain: TurnChain) -> Header:
    """Header of the page: campaign, site, skis, version, and the key results."""
    facts = [
        (Message("Campaign"), chain.campaign),
        (Message("Site"), chain.site),
        (Message("Skis"), chain.nominal.scenario.ski.name),
        (Message("Computed"), f"skisnow {version('skisnow')}"),
    ]
    said = Message(
        "This snow was not measured: the campaign, and with it every parameter, turn and band below, comes from a "
        "random number generator."
    )
    kind, title = Message("From a field campaign to a turn"), Message("A turn on the snow of {site}", site=chain.site)
    return Header(kind, title, facts, said if chain.synthetic else "", headline(chain))


def turn_page(chain: TurnChain, pictures: Sequence[Picture]) -> str:
    """HTML of the report of a chain from campaign to turn in the current language."""
    by_name = {picture.name: picture for picture in pictures}
    contacts = prose(
        "The hypoplastic contact depends on the history of loading: the forebody leaves a permanent groove, and the "
        "afterbody runs in it. The elastic contact has no history: the groove closes under the afterbody as the load "
        "passes. What that changes in this turn is listed under the key results: most where the turn needs a little "
        "more side force than elastic snow can give. {ratio}",
        ratio=html(
            Message("k_u / H_V was not measured here, nor is it published; it is a parameter.")
            if chain.snow.unloading_ratio_interval is None
            else Message("k_u / H_V is that of the site's unloading.")
        ),
    )
    means = prose(
        "H_V is the geometric mean over the used penetration experiments of the site, S_f the mean over its used shear "
        "experiments, each with its 95 % interval by Student's t. Where they were measured, k_u / H_V is the harmonic "
        "mean over the series with unloading, u_y the geometric mean over the shear tests with turning angles."
    )
    drawn = prose(
        "{count} runs with all inputs of the table below drawn at random (Latin hypercube, seed {seed}). The "
        "measured intervals are those of the site's means: the variation of the snow from place to place would widen "
        "the band. All other inputs count as known.",
        count=len(chain.ensemble),
        seed=chain.seed,
    )
    scenario = in_sections(scenario_values(chain.nominal.scenario))
    sections = [
        Section("key-results", Message("Key results"), key=key_sentences(chain)),
        Section("snow", Message("The snow that was found"), words=[means], tables=[parameters_table(chain.snow)]),
        Section(
            "contacts",
            Message("The turn with each contact"),
            words=[contacts],
            pictures=[by_name["contacts"]],
            tables=[contacts_table(chain.runs)],
        ),
        Section(
            "along-skis",
            Message("Along the skis, with the first contact"),
            pictures=[by_name["along_ski"], by_name["grip"]],
        ),
        Section(
            "ensemble",
            Message("With the unknown inputs varied"),
            words=[drawn, *ensemble_accuracy(chain)],
            pictures=[by_name["band"]],
            tables=[shares_table(chain)],
            after=[ensemble_sentence(chain), *best_measurement(chain)],
        ),
        Section("scenario", Message("Scenario"), tables=[scenario_table(scenario)]),
        Section("provenance", Message("Provenance"), words=[_provenance(chain)]),
    ]
    return sheet(_make_header(chain), sections)


def _provenance(chain: TurnChain) -> Markup:
    """Sentences with the snow's source, version, number of runs and time (s)."""
    return prose(
        "Snow from {source}. Computed with skisnow {version}; {runs} in {seconds} s, without the ensemble. Unrounded "
        "numbers: {file}.",
        file=Markup("<code>turn.json</code>"),
        source=chain.snow.source,
        version=version("skisnow"),
        runs=counted(len(chain.runs), "{count} run", "{count} runs"),
        seconds=significant(sum(run.wall_s for run in chain.runs.values())),
    )


def parameters_table(snow: SnowProperties) -> Table:
    """Table of H_V and S_f with their intervals, and of k_u/H_V and u_y if they have one."""
    values = (
        (Message("snow hardness H_V"), "N/mm³", N_PER_MM3, snow.snow_hardness, snow.snow_hardness_interval),
        (Message("failure shear stress S_f"), "N/mm²", N_PER_MM2, snow.failure_shear_stress,
         snow.failure_shear_stress_interval),
        ("k_u / H_V", "", 1.0, snow.unloading_ratio, snow.unloading_ratio_interval),
        (Message("shear displacement u_y"), "mm", MM, snow.shear_displacement, snow.shear_displacement_interval),
    )  # fmt: skip
    return Table(
        "parameters",
        Message("The snow of the site, with 95 % intervals of the means."),
        (
            Column("parameter", Message("Parameter"), "words"),
            Column("unit", Message("Unit"), "text"),
            Column("value", Message("Value")),
            Column("interval", Message("95 % interval"), "interval"),
        ),
        [
            (name, unit, value and value / size, ends and [end / size for end in ends])
            for i, (name, unit, size, value, ends) in enumerate(values)
            if i < 2 or ends is not None
        ],
    )


def contacts_table(runs: Mapping[str, Run]) -> Table:
    """Table with one row for each contact model, the keys of `runs`."""
    return Table(
        "contacts",
        Message("The turn with each contact."),
        (
            Column("contact", Message("Contact"), "words"),
            Column("outcome", Message("Outcome"), "text"),
            Column("run_length_m", Message("Distance travelled"), unit="m"),
            Column("end_speed_m_per_s", Message("Speed at the end"), unit="m/s"),
            Column("turned_deg", Message("Change of heading"), unit="°"),
            Column("turn_radius_m", Message("Median radius"), unit="m"),
            Column("depth_mm", Message("Maximum edge depth"), unit="mm"),
            Column("afterbody_depth_ratio", Message("Afterbody / forebody")),
            Column("grip", Message("Grip utilisation")),
            Column("slides", Message("Share of time side-slipping")),
        ),
        [_contact_row(name, run) for name, run in runs.items()],
        note=Message(
            "Afterbody / forebody: edge-depth ratio, the mean edge depth of the contact behind the boot over that "
            "before it, of the more heavily loaded (outer) ski, median over the second half. Grip utilisation: side "
            "force over the shear capacity S_f ∫ e ds of that ski, median over the run; it side-slips where that is "
            "above 0.95."
        ),
    )


def _contact_row(name: str, run: Run) -> tuple[Any, ...]:
    """Cells of a contact: outcome, length, last speed, turned angle (°), radius, depth (mm), ratio and grip."""
    heading = np.unwrap(run.heading)
    turned, deepest = float(heading[-1] - heading[0]) / DEGREE, float(np.nanmax(run.skis.edge_depth)) / MM
    motion = (run.run_length, float(run.speed[-1]), turned, results.median_radius(run))
    on_snow = (deepest, results.afterbody_depth_ratio(run), *results.used_grip(run))
    return (name, outcome_words(run.outcome), *motion, *on_snow)


def shares_table(chain: TurnChain) -> Table:
    """Table of the inputs of the band with their shares in the variance at its end."""
    shares = results.band_shares(results.middle_track(chain.nominal), chain.ensemble)
    rows: list[tuple[Any, ...]] = [
        (row.key, (row.low, row.high), row.in_words, *_shares_of(row.key, shares)) for row in results.band_inputs(chain)
    ]
    if shares is not None:
        rest = ((100.0 * direction.left, None) for direction in (shares.aside, shares.ahead))
        rows.append((Message("left over"), None, "", *rest))
    return Table(
        "band_inputs",
        Message("Inputs of the band, and how much each adds to the variance of the places at its end."),
        (
            Column("key", Message("Input"), "text"),
            Column("range", Message("Range"), "range"),
            Column("origin", Message("Measured or prior, distribution and origin"), "words"),
            Column("aside_percent", Message("Share of the offset across"), "estimate", unit="%", digits=2),
            Column("ahead_percent", Message("Share of the offset along"), "estimate", unit="%", digits=2),
        ),
        rows,
        note=Message(
            "Shares: first-order Sobol indices by linear regression on the logarithms of the inputs, with 95 % "
            "intervals. The rest is proportional to no input: curvature, thresholds such as an edge that loses its "
            "grip, and the interaction of inputs."
        ),
    )


def _shares_of(key: str, shares: BandShares | None) -> tuple[Any, Any]:
    """Cells with an input's shares (%) of the variance across and along the track, with intervals; None if unknown."""
    if shares is None or key not in shares.keys:
        return (None, None), (None, None)
    place = shares.keys.index(key)
    across, along = (
        (100.0 * float(direction.share[place]), tuple((100.0 * direction.interval[place]).tolist()))
        for direction in (shares.aside, shares.ahead)
    )
    return across, along
