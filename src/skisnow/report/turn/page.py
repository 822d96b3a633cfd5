"""One page for the whole chain: a campaign, its snow with intervals, a turn with each contact, an ensemble."""

from __future__ import annotations

import json
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Final

from markupsafe import Markup

from ..._support.errors import ParameterError
from ..._support.language import ENGLISH, require_language
from ..._support.staging import require_writable, write_file
from ...scenario.keys import scenario_values
from ..figures.drawing import Drawing
from ..figures.figure_files import write_pictures
from ..formatting import significant
from ..run.page import CHOICES
from ..run.tables import scenario_table
from ..run.time_figures import run_along_ski, run_grip
from ..sheet import Header, Section, sheet
from ..symbols import figure_text, html, prose
from .figures import FEWEST, runs_compared, track_band
from .numbers import middle_track, turn_dict
from .sentences import ensemble_accuracy, ensemble_sentence, headline, key_sentences, meaning
from .tables import contacts_table, ensemble_table, parameters_table, shares_table

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..figures.drawing import Picture
    from .chain import TurnChain

FIGURES: Final = ("contacts", "along_ski", "grip", "band")
"""Names of the figures of such a report, in figures/ as .png and .svg."""


def write_turn_report(chain: TurnChain, folder: str | Path, *, language: str = ENGLISH) -> Path:
    """Write report.html, turn.json and figures/ of the chain from a campaign to a turn; page and figures in a language.

    Returns
    -------
    Path
        Of report.html, which is written last.

    Raises
    ------
    ParameterError
        There are fewer than two contacts, or too few runs for a band, or there are no texts of the language.
    OutputError
        A file cannot be written.
    """
    if len(chain.runs) < 2 or len(chain.ensemble) < FEWEST:
        raise ParameterError(
            f"there are {len(chain.runs)} contacts and {len(chain.ensemble)} runs of the ensemble; the report needs 2 "
            f"and {FEWEST} at least"
        )
    require_language(language)
    folder = Path(folder)
    require_writable(folder)
    names = names_in(chain)
    pictures = write_pictures(
        _drawings(chain), folder / "figures", every=FIGURES, language=language, names=frozenset(map(figure_text, names))
    )
    text = json.dumps(turn_dict(chain), ensure_ascii=False, allow_nan=False, indent=1)
    write_file(folder / "turn.json", f"{text}\n")
    write_file(folder / "report.html", turn_page(chain, pictures, language=language))
    return folder / "report.html"


def turn_page(chain: TurnChain, pictures: Sequence[Picture], *, language: str = ENGLISH) -> str:
    """The HTML of the report."""
    return sheet(_header(chain), _sections(chain, pictures), language=language, names=names_in(chain))


def names_in(chain: TurnChain) -> frozenset[str]:
    """What users wrote, and words of a scenario's file: the same in every language."""
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
        runs_compared(chain.runs),
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
            "each run lies beside and ahead of the nominal one at the same time.",
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
        "Nobody measured this snow: the campaign, and with it every parameter, turn and band below, comes from a "
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
        "passes. What that changes in this turn stands under the key results: most where the turn needs a little more "
        "side force than elastic snow can give. " + _ratio_in_words(chain)
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
