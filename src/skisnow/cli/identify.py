"""``skisnow identify``: parameters from tracks and photo-cell times."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from .options import (
    MOST_RESAMPLES,
    add_changes,
    add_fall_line_azimuth,
    add_language,
    add_workers,
    changes_of,
    scenario_of,
    seed_number,
    whole_number,
)
from .output import Progress, ending_is_an_interrupt, prepare_output, print_json, print_warnings

MOST_SAMPLES, MOST_STARTS = 1_000_000, 1_000

if TYPE_CHECKING:
    from ..identification import Identification
    from ..scenario import ScenarioFile
    from ..scenario.resolution import ScenarioInput

KEPT = "simulations.partial"


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``skisnow identify`` to the program."""
    parser = commands.add_parser(
        "identify",
        help="friction, drag, snow and more from tracks or photo-cell times",
        description="Find the parameters of a scenario that fit what was measured. Ctrl-C keeps the best so far.",
    )
    parser.add_argument("scenario", metavar="NAME|SCENARIO.toml", help="a built-in scenario or a TOML file")
    parser.add_argument(
        "data",
        nargs="+",
        type=Path,
        metavar="DATA",
        help="tracks (CSV, GPX, TCX, FIT, NMEA, UBX, .pos) or photo-cell times (CSV); several are fitted together",
    )
    free = 'parameters to fit, such as mu_0,drag_area,S_f; default: those with a table [identify."KEY"] in the file'
    parser.add_argument("--free", default="", metavar="KEY,KEY", help=free)
    add_changes(parser)
    add_fall_line_azimuth(parser, "for tracks in latitude and longitude; default: [identify.site] of the file")
    _add_methods(parser)
    parser.add_argument("--json", action="store_true", help="print identification.json alone to standard output")
    parser.add_argument("--out", type=Path, metavar="DIR", help="write identification.json, fits.csv and a report")
    add_language(parser)
    parser.add_argument("--resume", action="store_true", help="go on with the simulations that are kept in --out")
    parser.set_defaults(run=run, parser=parser)


def _add_methods(parser: argparse.ArgumentParser) -> None:
    """Add the options for intervals, searches, clocks and processes."""
    profile = "also intervals by refitting all others along each parameter"
    parser.add_argument("--profile", action="store_true", help=profile)
    bootstrap = "also intervals by N resamples of the residuals, 40 or more"
    parser.add_argument(
        "--bootstrap", type=whole_number(40, MOST_RESAMPLES, or_zero=True), default=0, metavar="N", help=bootstrap
    )
    by = "each resample is refitted with separate simulations (default), or by the linearised model"
    parser.add_argument("--bootstrap-by", choices=("refit", "linear"), default="refit", help=by)
    posterior = "also about N samples of the posterior (needs emcee)"
    parser.add_argument("--posterior", type=whole_number(0, MOST_SAMPLES), default=0, metavar="N", help=posterior)
    parser.add_argument(
        "--starts", type=whole_number(1, MOST_STARTS), default=1, metavar="N", help="searches from N places"
    )
    parser.add_argument("--seed", type=seed_number, default=0, metavar="N", help="of every random number")
    clock = "whether photo-cell clocks show 0 at the start, or each run's has a separate offset"
    parser.add_argument("--clock", choices=("start", "free"), help=clock)
    add_workers(parser)


def run(options: argparse.Namespace) -> int:
    """Identify parameters, print and write them; returns 0, 1 without a result, 130 or 143 after an interrupt."""
    if options.resume and options.out is None:
        options.parser.error("--resume continues the results in --out DIR; name it")
    from ..identification.intervals import require_bootstrap, require_emcee

    require_bootstrap(options.bootstrap, options.bootstrap_by)
    if options.posterior:
        require_emcee()
    scenario_input = scenario_of(options)
    prepare_output(options.out)
    print_warnings(scenario_input.warnings)
    with ending_is_an_interrupt() as ending:
        result = _identify(options)
        with ending.finishing():
            _write_and_print(options, result, scenario_input)
    if ending.requested or ending.pressed or result.outcome == "interrupted":
        return ending.status()
    return 1 if result.outcome in ("too_few_points", "not_converged") else 0


def _identify(options: argparse.Namespace) -> Identification:
    """Result of the identification by the command's options, with progress shown."""
    import numpy as np

    from ..identification import identify

    with Progress() as progress:
        return identify(
            _with_fall_line(options),
            options.data,
            options.free,
            changes=changes_of(options),
            starts=options.starts,
            profile=options.profile,
            bootstrap=options.bootstrap,
            bootstrap_by=options.bootstrap_by,
            posterior=options.posterior,
            clock_is_free=None if options.clock is None else options.clock == "free",
            rng=np.random.default_rng(options.seed),
            workers=options.workers,
            checkpoint=None if options.out is None else options.out / KEPT,
            restart=not options.resume,
            progress=progress,
        )


def _with_fall_line(options: argparse.Namespace) -> ScenarioInput:
    """Input of the scenario, with the compass direction of the fall line from the option if it is stated."""
    from ..scenario.reading import load_input

    scenario_input = load_input(options.scenario)
    if options.fall_line_azimuth_deg is None:
        return scenario_input
    site = {**scenario_input.identify.get("site", {}), "fall_line_azimuth_deg": options.fall_line_azimuth_deg}
    return replace(scenario_input, identify={**scenario_input.identify, "site": site})


def _write_and_print(options: argparse.Namespace, result: Identification, scenario_input: ScenarioFile) -> None:
    """Print warnings and the summary or JSON of an identification, and write its report if --out is given."""
    from ..identification import identification_dict

    contents = identification_dict(result, files=(*scenario_input.files, *options.data))
    print_warnings(result.warnings)
    if options.json:
        print_json(contents)
    else:
        from ..report.summaries import identify_summary

        print(identify_summary(result), flush=True)
    if options.out is not None:
        from ..report.identification import write_identify_report

        with Progress() as progress:
            page = write_identify_report(
                result,
                contents,
                options.out,
                language=options.language,
                progress=lambda doing: progress(f"writing {doing}"),
            )
        print(f"Report: {page}", file=sys.stderr)
    if result.outcome == "interrupted" and options.out is not None:
        print("The same command with --resume goes on with the simulations that are kept.", file=sys.stderr)
