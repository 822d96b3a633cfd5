"""From a campaign to a turn: its snow with intervals, a turn with each contact, a band over the uncertain inputs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from .._support.errors import ParameterError, require_range
from .._support.messages import Message
from .._support.processes.batch import run_batch, worker_count
from .._support.processes.kept_rows import Row
from ..campaign import Campaign, read_campaign
from ..estimation import Analysis, analyse
from ..estimation.parts import site_of_campaign
from ..parameters import values_of
from ..report.campaign.data import is_synthetic
from ..report.turn.chain import EnsembleRun, TurnChain, used_grip
from ..report.turn.figures import FEWEST, TimedTrack
from ..scenario import Scenario, load_scenario
from ..scenario.contact import ELASTIC
from ..scenario.identify_section import Measured, Prior, measured_of
from ..simulation import Run
from ..simulation.simulated_run import simulate
from ..simulation.verification import NUDGED, limit_sentences, nudged_scenarios
from ..ski import Ski
from ..snow.mean_snow import drawn_snows, measured_intervals, no_used_experiment, site_in_words

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
    """Simulate a turn on the snow of a campaign with two contacts, and an ensemble of it over the uncertain inputs.

    Parameters
    ----------
    campaign
        A campaign, its folder, or its analysis.
    site
        Site whose snow is used; "C" is also the campaign's "site C". Default: all sites together.
    scenario
        Scenario of the turn: a built-in name, a file, or a scenario. Its snow is replaced by that of the campaign.
    ski
        Ski instead of that of the scenario: a ski, a name of the catalogue, or a file.
    unloading_ratio
        k_u/H_V > 1 of the hypoplastic contact; default: that measured at the site, or 10 without one. The other
        contact is elastic.
    shear_displacement
        u_y (m) > 0; default: that measured at the site, or the scenario's without one.
    priors
        Further inputs of the ensemble, which replace those with the same key. By default k_u/H_V and u_y are drawn
        from their measured intervals if the site has them and neither is stated above; the others from
        `skisnow.pipeline.PRIORS`.
    runs
        Number of runs of the ensemble, 3 or more.
    seed
        Seed of the random numbers of the ensemble.
    workers
        Number of processes for the ensemble; None: one for each core.
    progress
        Callback for lines of text on the progress.

    Returns
    -------
    TurnChain
        Snow, runs and ensemble; `TurnChain.report` writes a page with all of it.

    Raises
    ------
    FieldDataError
        The campaign contains errors.
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
    if unloading_ratio is not None and not unloading_ratio > ELASTIC:
        raise ParameterError(
            "unloading_ratio is {unloading_ratio}; k_u/H_V must be above 1 here: elastic snow is the other contact"
        ).tag("out_of_range", unloading_ratio=unloading_ratio)
    if shear_displacement is not None:
        require_range("shear_displacement", shear_displacement, 0.0, above=True)
    require_range("runs", runs, FEWEST)
    workers = worker_count(workers)
    say = progress or (lambda *_: None)
    if isinstance(campaign, Analysis):
        analysis = campaign
    else:  # the site is checked before the estimates, which take long
        read = campaign if isinstance(campaign, Campaign) else read_campaign(campaign, progress=progress)
        pressed = set(read.penetration.site) if read.penetration is not None else set()
        if site is not None and pressed and site_of_campaign(read, site) not in pressed:
            raise no_used_experiment(read.name, site, sorted(pressed))
        analysis = analyse(read, progress=progress)
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
    contacts: dict[str, Scenario] = {
        Message("hypoplastic, k_u / H_V = {ratio:.3g}", ratio=snow.unloading_ratio): turn,
        Message("elastic"): turn.with_(unloading_ratio=ELASTIC),
    }
    simulated: dict[str, Run] = {}
    for name, contact in contacts.items():
        say(f"the turn with the contact “{name}”")
        simulated[name] = simulate(contact)
        if simulated[name].outcome == "interrupted":
            raise KeyboardInterrupt
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


CAMBER_ROUNDING: Final = "ski.camber_rounding_mm"
PRIORS: Final = (
    Prior(
        key="snow.unloading_ratio",
        low=2.0,
        high=50.0,
        origin="not measured here, not published; at 2 the snow keeps half of a groove, at 50 all but all of it",
    ),
    Prior(
        key="snow.shear_displacement_mm",
        low=0.02,
        high=0.5,
        origin="not measured here; from the default, near the limit 0 of the paper's law, to half a millimetre",
    ),
    Prior(
        key="friction.mu_0",
        low=0.4,
        high=2.5,
        about=True,
        origin="as far about the scenario's own as 0.023 and 0.139, the ends of over 200 runs (Wolfsperger and others "
        "2021), are about their geometric middle",
    ),
    Prior(
        key="ski.stiffness_factor",
        low=0.77,
        high=1.3,
        origin="EI and GJ of the catalogue are inferred from an index: natural frequencies to 15 %, stiffness to 30 %",
    ),
    Prior(
        key=CAMBER_ROUNDING,
        low=50.0,
        high=200.0,
        origin="no source: half and twice the 100 mm of a ski whose camber is known as one number",
    ),
)
"""By default."""
MEASURED: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")
"""Keys whose uncertainty the campaign tells in any case."""
OUTPUT: Final = 0.05
"""Time (s) between the rows of a track that the band draws."""


def inputs_with(priors: Iterable[Prior], turn: Scenario) -> tuple[Measured | Prior, ...]:
    """Uncertain inputs of the ensemble besides H_V and S_f, in the order of its columns.

    Order of precedence: a prior of the caller, a measured interval of the snow, the default prior. The rounding of the
    camber is an input only for a ski with a camber as one number.
    """
    measured = {uncertain.key: uncertain for uncertain in measured_of(turn.contact.snow)}
    inputs = {prior.key: measured.get(prior.key, prior) for prior in PRIORS}
    if turn.ski.base is None or turn.ski.base.camber == 0.0:
        del inputs[CAMBER_ROUNDING]
    for prior in priors:
        if prior.key in MEASURED:
            raise ParameterError("{key} has no prior here: its interval comes from the campaign").tag(
                "no_data", key=prior.key
            )
        inputs[prior.key] = prior
    return tuple(inputs.values())


def simulate_fast(scenario: Scenario) -> dict[str, Any]:
    """Simulate a scenario by the fast method; returns outcome, track, share of time in side-slip, as JSON values."""
    run = simulate(scenario.with_(solver=replace(scenario.solver, method="fast", fixed=False, output_interval=OUTPUT)))
    time, x, y = (column.tolist() for column in (run.time, run.place[:, 0], run.place[:, 1]))
    return {"outcome": run.outcome, "track": [time, x, y], "slips": used_grip(run)[1]}


def drawn_scenarios(nominal: Scenario, inputs: Sequence[Measured | Prior], count: int, seed: int) -> list[Scenario]:
    """Draw `count` scenarios by a Latin hypercube over H_V, S_f and the further inputs; other values are nominal."""
    shares = latin_hypercube(count, 2 + len(inputs), np.random.default_rng(seed))
    snows = drawn_snows(nominal.contact.snow, shares[:, :2])
    own = values_of(nominal)
    columns = {source.key: source.at(shares[:, 2 + j], own[source.key]) for j, source in enumerate(inputs)}
    return [
        nominal.with_(snow=snow, **{key: float(values[i]) for key, values in columns.items()})
        for i, snow in enumerate(snows)
    ]


def latin_hypercube(count: int, inputs: int, generator: np.random.Generator) -> Any:
    """Random shares from 0 to 1, shape (count, inputs): each of `count` equal slices of an input contains one."""
    slices = generator.permuted(np.tile(np.arange(count), (inputs, 1)), axis=1).T
    return (slices + generator.random((count, inputs))) / count


def ensemble_of(
    nominal: Run, scenarios: Sequence[Scenario], inputs: Sequence[Measured | Prior], *, workers: int | None,
    progress: Callable[[str], None],
) -> tuple[list[EnsembleRun], float, tuple[str, ...]]:  # fmt: skip
    """Runs of the ensemble, distance (m) by which the fast method moves the nominal run's end, and warnings of it."""
    nudged = {key: pair for key, pair in nudged_scenarios(nominal).items() if key in NUDGED}
    points = [nominal.scenario, *scenarios, *(scenario for nudges in nudged.values() for scenario in nudges)]
    first, *rows = run_batch(
        points, simulate_fast, workers=workers, progress=lambda done, count: progress(f"run {done} of {count}")
    )
    moved = _end_distance(first, [[column[-1]] for column in nominal.place[:, :2].T])
    runs = []
    for scenario, row in zip(scenarios, rows, strict=False):
        values, track = values_of(scenario), TimedTrack(*map(np.array, row["track"]))
        drawn = {key: float(values[key]) for key in (*MEASURED, *(source.key for source in inputs))}
        runs.append(EnsembleRun(scenario.contact.snow, row["outcome"], track, drawn, row["slips"]))
    beside = iter(rows[len(scenarios) :])
    moves = {
        key: max(_end_distance(next(beside), first["track"][1:]) for _ in nudges) for key, nudges in nudged.items()
    }
    return runs, moved, limit_sentences(moves, nominal.run_length)


def _end_distance(row: Row, place: Sequence[Sequence[float]]) -> float:
    """Distance (m) of the end of a row's track from the last place of another track, given as x and y."""
    return float(np.hypot(*(column[-1] - other[-1] for column, other in zip(row["track"][1:], place, strict=True))))
