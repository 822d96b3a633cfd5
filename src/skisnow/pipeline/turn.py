"""The whole chain: a campaign, its snow with intervals, a turn with each contact, a band over what is not known."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.processes.pool import workers_in_force
from ..campaign import Campaign, read_campaign
from ..estimation import Analysis, analyse
from ..estimation.sites import site_of_campaign
from ..report.campaign.data import is_synthetic
from ..report.turn.chain import TurnChain
from ..report.turn.figures import FEWEST
from ..scenario import Scenario, load_scenario
from ..scenario.contact import ELASTIC
from ..scenario.identify_section import Prior, measured_of
from ..simulation import Run
from ..simulation.simulated_run import simulate
from ..ski import Ski
from ..snow.mean_snow import measured_intervals, no_used_experiment, site_in_words
from .ensemble import MEASURED, drawn_scenarios, ensemble_of, inputs_with

UNLOADING_RATIO: Final = 10.0
"""k_u/H_V of hypoplastic snow whose unloading was not measured (modelling assumption: none is published)."""
RUNS: Final = 64
"""Runs of the ensemble (assumption: the band of 90 % then leaves six out, and shares are known to a tenth)."""


def turn(
    campaign: Campaign | Analysis | str | Path,
    site: str | None = None,
    scenario: Scenario | str | Path = "carved-46m",
    *,
    ski: Ski | str | Path | None = None,
    unloading_ratio: float | None = None,
    shear_displacement: float | None = None,
    priors: Sequence[Prior] = (),
    runs: int = RUNS,
    seed: int = 1,
    workers: int | None = None,
    progress: Callable[[str], None] | None = None,
) -> TurnChain:
    """From a campaign to a turn: its snow, the turn on it with two contacts, and a band over what is not known of it.

    Parameters
    ----------
    campaign
        A campaign, its folder, or its analysis.
    site
        Whose snow it is; "C" is also the campaign's "site C". Default: all sites together.
    scenario
        The turn: its snow is replaced by the one that was found. A built-in name, a file, or a scenario.
    ski
        Ski instead of that of the scenario: a ski, a name of the catalogue, or a file.
    unloading_ratio
        k_u/H_V > 1 of the hypoplastic contact; default: the measured one of the site, or 10 where none is. The other
        contact is elastic.
    shear_displacement
        u_y (m) > 0; default: the measured one of the site, or the scenario's own where none is.
    priors
        Further inputs of the band beside H_V and S_f with the same key, or beside it. Without one, k_u/H_V and
        u_y are drawn from their measured intervals where the site has them and neither is given above; all else, and
        they where they were not measured, from `skisnow.pipeline.ensemble.PRIORS`.
    runs
        Number of runs of the ensemble, 3 or more.
    seed
        Of those draws.
    workers
        Processes for the ensemble; None: one for each core.
    progress
        Called with a line of text now and then.

    Returns
    -------
    TurnChain
        With `TurnChain.report` for the page that shows it all.

    Raises
    ------
    FieldDataError
        The campaign holds errors.
    ParameterError
        The site has no used penetration experiment, or too few of either kind for intervals; a number is outside its
        range; the scenario or the ski cannot be read.
    SolverError
        The sledge finds no equilibrium to start from on that snow.

    See Also
    --------
    skisnow.analyse : only the first step.
    skisnow.simulate : only one turn.

    Notes
    -----
    A script that calls this with several workers needs the usual ``if __name__ == "__main__":``.

    References
    ----------
    * Mössner and others (2013), "Modeling the ski-snow contact in skiing turns using a hypoplastic vs an elastic
      force-penetration relation", Scand. J. Med. Sci. Sports, doi 10.1111/sms.12035.
    * The page docs/how-to/in-python.md.
    """
    _require(unloading_ratio, shear_displacement, runs)
    workers = workers_in_force(workers)
    say = progress or _silent
    analysis = campaign if isinstance(campaign, Analysis) else _analysed(campaign, site, progress)
    snow = analysis.snow(site, unloading_ratio=unloading_ratio)
    if snow.unloading_ratio is None:
        snow = replace(snow, unloading_ratio=UNLOADING_RATIO)
    if shear_displacement is not None:
        snow = replace(snow, shear_displacement=shear_displacement, shear_displacement_interval=None)
    measured_intervals(snow)
    turn = (scenario if isinstance(scenario, Scenario) else load_scenario(scenario)).with_(snow=snow)
    turn = turn if ski is None else turn.with_(ski=ski)
    every = inputs_with(priors, turn)
    drawn = drawn_scenarios(turn, every, runs, seed)
    contacts = {
        f"hypoplastic, k_u / H_V = {snow.unloading_ratio:.3g}": turn,
        "elastic": turn.with_(unloading_ratio=ELASTIC),
    }
    simulated = {name: _run(name, contact, say) for name, contact in contacts.items()}
    nominal = next(iter(simulated.values()))
    ensemble, moved, warnings = ensemble_of(nominal, drawn, every, workers=workers, progress=say)
    return TurnChain(
        campaign=analysis.campaign.name,
        site=site_in_words(site_of_campaign(analysis.campaign, site)),
        synthetic=is_synthetic(analysis.campaign.name),
        snow=snow,
        runs=simulated,
        ensemble=ensemble,
        seed=seed,
        ensemble_error=moved,
        measured=tuple(source for source in measured_of(snow) if source in every or source.key in MEASURED),
        priors=tuple(source for source in every if isinstance(source, Prior)),
        warnings=warnings,
        analysis=analysis,
    )


def _analysed(campaign: Campaign | str | Path, site: str | None, progress: Callable[[str], None] | None) -> Analysis:
    """The analysis of a campaign that has the site: a misspelt site is reported before the estimates."""
    read = campaign if isinstance(campaign, Campaign) else read_campaign(campaign, progress=progress)
    pressed = set(read.penetration.site) if read.penetration is not None else set()
    if site is not None and pressed and site_of_campaign(read, site) not in pressed:
        raise no_used_experiment(read.name, site, sorted(pressed))
    return analyse(read, progress=progress)


def _run(contact: str, turn: Scenario, say: Callable[[str], None]) -> Run:
    say(f"the turn with the contact “{contact}”")
    run = simulate(turn)
    if run.outcome == "interrupted":
        raise KeyboardInterrupt
    return run


def _require(unloading_ratio: float | None, shear_displacement: float | None, runs: int) -> None:
    if unloading_ratio is not None and not unloading_ratio > ELASTIC:
        raise ParameterError(
            Message(
                "unloading_ratio is {unloading_ratio}; k_u/H_V must be above 1 here: elastic snow is the other contact",
                unloading_ratio=unloading_ratio,
            ),
            code="out_of_range",
        )
    if shear_displacement is not None and not shear_displacement > 0.0:
        raise ParameterError(
            Message(
                "shear_displacement is {shear_displacement} m; u_y must be above 0",
                shear_displacement=shear_displacement,
            ),
            code="out_of_range",
        )
    if runs < FEWEST:
        raise ParameterError(
            Message("runs is {runs}; a band needs {fewest} or more", runs=runs, fewest=FEWEST), code="out_of_range"
        )


def _silent(_text: str) -> None:
    return
