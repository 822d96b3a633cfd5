"""``skisnow turn``: from a campaign to a turn on the snow of one of its sites."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .options import add_changes, add_language, add_workers, changes_of, number, scenario_of, seed_number, whole_number
from .output import prepare_output, print_json, print_warnings
from .progress import Progress, announced

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..scenario.contact import Contact

MOST_RUNS = 10_000


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the program's."""
    parser = commands.add_parser(
        "turn",
        help="from a campaign to a turn: analysis, the snow of a site, a simulated turn, a band over what is not known",
        description="Analyse a campaign and simulate a turn on the snow of a site, with hypoplastic and with "
        "elastic contact, and over what is not known of snow, friction and ski.",
    )
    parser.add_argument("campaign", type=Path, metavar="CAMPAIGN", help="folder of the campaign, or a workbook (.xlsx)")
    parser.add_argument("--site", metavar="SITE", help='whose snow it is, "C" or "site C"; default: all sites')
    parser.add_argument(
        "--scenario",
        default="carved-46m",
        metavar="NAME|FILE",
        help="the turn on that snow; default: carved-46m",
    )
    add_changes(
        parser, "; the campaign's H_V and S_f count, a given unloading_ratio or shear_displacement_mm comes before it"
    )
    _add_ensemble(parser)
    parser.add_argument("--json", action="store_true", help="print turn.json alone to standard output")
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="write report.html, turn.json and figures of the whole chain here"
    )
    add_language(parser)
    parser.set_defaults(run=run)


def _add_ensemble(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--unloading-ratio",
        type=number("", lowest=1.0, highest=1000.0, above=True),
        metavar="RATIO",
        help="k_u/H_V of the hypoplastic contact; default: the site's unloading, otherwise 10",
    )
    parser.add_argument(
        "--runs", type=whole_number(3, MOST_RUNS), metavar="N", help="runs of the ensemble, 3 or more; default: 64"
    )
    parser.add_argument(
        "--prior",
        action="append",
        default=[],
        dest="priors",
        metavar="key=low:high",
        help="range of a key of the scenario that the ensemble is drawn over, instead of a default one or in "
        "addition to the defaults, several times for several; equal ends: it is known",
    )
    parser.add_argument("--seed", type=seed_number, help="seed of the ensemble, a whole number of 0 or more")
    add_workers(parser)


def run(options: argparse.Namespace) -> int:
    """Compute from campaign to turn, print the differences between the contacts or the JSON, write the report."""
    with announced("loading"):
        from ..pipeline.turn import turn
        from ..scenario.identify_section import prior_of

        priors = [prior_of(word) for word in options.priors]
        scenario_input = scenario_of(options)
    print_warnings(scenario_input.warnings)
    if options.out is not None:
        prepare_output(options.out)
    names = ("unloading_ratio", "runs", "seed", "workers")
    numbers = _given(changes_of(options), scenario_input.scenario.contact)
    chosen = numbers | {name: getattr(options, name) for name in names if getattr(options, name) is not None}
    with Progress() as progress:
        chain = turn(
            options.campaign, options.site, scenario_input.scenario, priors=priors, progress=progress, **chosen
        )
        page = None if options.out is None else chain.report(options.out, language=options.language)
    if options.json:
        from ..report.turn.numbers import turn_dict

        print_json(turn_dict(chain))
    else:
        print(f"snow: {chain.snow.in_words}", *chain.sentences, sep="\n")
    print_warnings(chain.warnings)
    if page is not None:
        print(f"The whole chain: {page}", file=sys.stderr)
    return 0


def _given(changes: Mapping[str, object], contact: Contact) -> dict[str, Any]:
    """k_u/H_V and u_y among the changes, which override the values of the campaign."""
    values = {
        "snow.unloading_ratio": ("unloading_ratio", contact.unloading_ratio),
        "snow.shear_displacement_mm": ("shear_displacement", contact.shear_displacement),
    }
    return {name: value for key, (name, value) in values.items() if key in changes}
