"""Identification of the parameters of a scenario from measurements."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.processes.batch import ExecutorLike, require_executor
from .._support.processes.kept_rows import KeptRows, forget
from ..parameters import values_of
from ..scenario import Scenario
from ..scenario.identify_section import given_parameters
from ..scenario.keys import free_keys
from ..scenario.reading import build_input, load_input
from ..scenario.resolution import ScenarioInput
from .data import Data, collect_data, fingerprint, start_values
from .intervals import require_bootstrap
from .parameter import parameter_table
from .photo_cell_times import PhotoCellTimes
from .problem import Kind, Observations, Problem, expand_keys
from .result import Identification
from .search import Progress
from .simulations import RunSimulation, Simulations
from .solution import BootstrapBy, SearchRequest, too_few_points
from .solving import solve
from .track_positions import TrackPositions

_NOTHING: Final[Mapping[str, object]] = MappingProxyType({})


def identify(
    scenario: Scenario | str | Path | ScenarioInput,
    data: Sequence[Data | str | Path] | Data | str | Path,
    free: str | Sequence[str] = (),
    *,
    changes: Mapping[str, object] = _NOTHING,
    starts: int = 1,
    profile: bool = False,
    bootstrap: int = 0,
    bootstrap_by: BootstrapBy = "refit",
    posterior: int = 0,
    clock_is_free: bool | None = None,
    rng: np.random.Generator | None = None,
    workers: int | None = None,
    executor: ExecutorLike | None = None,
    checkpoint: Path | None = None,
    restart: bool = False,
    progress: Progress | None = None,
) -> Identification:
    """Estimate parameters of a scenario from measurements by least squares.

    Parameters
    ----------
    scenario
        A scenario, a built-in name, the path of a file, or a `ScenarioInput`.
    data
        Tracks, photo-cell times, or paths of files with these; one or several.
    free
        Free keys, with or without section and unit. ``KEY@RUN`` is the key in one of several runs; ``KEY@each`` has a
        separate value in each run, as keys of the start always have. Default: those with a table
        ``[identify."KEY"]``.
    changes
        Other values of the scenario, as in `skisnow.scenario`.
    starts
        Number of searches: the first begins at the scenario's values, the others at random places around them.
    profile
        True to compute profile-likelihood intervals as well.
    bootstrap, posterior
        Number of resamples, and of samples of the posterior; 0: none.
    bootstrap_by
        "refit": each resample is refitted, with one to four simulated runs of each track; "linear": each is fitted by
        the model linearised at the best values, without simulations.
    clock_is_free
        True if the clock of each photo-cell run has a separate offset (default: ``[identify] clock``, else False).
    rng
        Source of random numbers for starts, bootstrap and posterior (default: a generator with seed 0).
    workers
        Number of processes that simulate (default: the number of cores available to this process).
    executor
        Executor of the simulations, as in `skisnow.run_batch` (default: processes of this computer).
    checkpoint
        File that stores finished simulations; those of an earlier search are used again (default: no file).
    restart
        True to delete the simulations of an earlier search in `checkpoint`, after all arguments have been validated.
    progress
        Called with a line of text on the current step.

    Returns
    -------
    Identification
        The result with any outcome. Ctrl-C ends the search with the best values so far, outcome "interrupted".

    Raises
    ------
    ParameterError, FieldDataError
        A name is unknown, bounds exclude the start, or data are from another place or cannot be read.
    FitError
        Nothing can be computed at the start.

    See Also
    --------
    skisnow.simulate : the run that is fitted.
    skisnow.compare : distances between two tracks, without a fit.

    Notes
    -----
    Searches simulate with fixed steps of 4 ms; the last steps of the search and the numbers of the answer are computed
    with the scenario's own solver.

    References
    ----------
    * Kaps, Nachbauer and Mössner (1996), "Determination of kinetic friction and drag area in alpine skiing", ASTM STP
      1266, 165-177.
    * The page docs/methods/identification.md.
    """
    begun = time.monotonic()
    require_bootstrap(bootstrap, bootstrap_by)
    require_executor(executor)
    scenario_input = (scenario if isinstance(scenario, ScenarioInput) else load_input(scenario)).changed(changes)
    scenario_file = build_input(scenario_input)
    tables = given_parameters(scenario_input.identify)
    if clock_is_free is None:
        clock_is_free = scenario_input.identify.get("clock", "start") == "free"
    keys = free_keys(free) or tuple(dict.fromkeys(key.partition("@")[0] for key in tables))
    if not keys:
        raise ParameterError(
            'No parameter is free. Name keys with --free, or write [identify."KEY"] in the scenario'
        ).tag("nothing_free")
    fixed = [key for key in tables if key.partition("@")[0] not in {free.partition("@")[0] for free in keys}]
    unused = Message(
        "{keys} have a table under [identify] but are not free. They keep the scenario's values", keys=fixed
    )
    measurements = collect_data(
        scenario_input, scenario_file, [data] if isinstance(data, Data | str | Path) else data, keys
    )
    parameters = parameter_table(
        expand_keys(keys, measurements.runs), start_values(scenario_file, measurements, tables), tables
    )
    simulate = RunSimulation(scenario_input, tuple(track.time for track in measurements.tracks))
    if restart and checkpoint is not None:
        forget(checkpoint)
    identity = fingerprint(scenario_input, measurements.tracks) if checkpoint else ""
    rows = KeptRows.opened(checkpoint, identity) if checkpoint else KeptRows()
    counted = _ProgressCounter(progress or (lambda *_: None))
    with Simulations(simulate, rows, workers, counted, executor) as simulations:
        observations: list[Observations] = []
        if measurements.tracks:
            values, own = values_of(scenario_file.scenario), measurements.starts
            observations.append(TrackPositions(measurements.tracks, simulations, measurements.fixed, own, values))
        for cells in measurements.cells:
            observations.append(PhotoCellTimes(cells, scenario_file, measurements.starts, clock_is_free))
        _require_used(keys, observations)
        request = SearchRequest(
            title=scenario_input.title,
            starts=starts,
            profile=profile,
            bootstrap=bootstrap,
            bootstrap_by=bootstrap_by,
            posterior=posterior,
            rng=np.random.default_rng(0) if rng is None else rng,
            progress=counted.about,
            warnings=(*measurements.warnings, *([unused] if fixed else [])),
            methods=measurements.methods,
        )
        problem = Problem(parameters, tuple(observations), noise=(1.0,) * len(observations))
        needed = len(parameters) + problem.nuisances + (not problem.accuracy_is_stated)
        if not problem.priors and problem.points < needed:
            result = too_few_points(problem, request)
        else:
            result = solve(problem, request)
        effort = replace(result.effort, simulations=simulations.computed, kept_simulations=simulations.restored)
        effort = replace(effort, wall_s=time.monotonic() - begun)
        return replace(result, data=measurements.descriptions, effort=effort)


_KINDS: Final[dict[Kind, Message]] = {
    "track": Message("the track"),
    "photo_cells": Message("the photo-cell times"),
}


def _require_used(keys: Sequence[str], observations: Sequence[Observations]) -> None:
    """Reject a free parameter on which none of the data depend."""
    for key in (key.partition("@")[0] for key in keys):
        if not any(observation.used_keys is None or key in observation.used_keys for observation in observations):
            kinds = [_KINDS[kind] for kind in dict.fromkeys(observation.kind for observation in observations)]
            raise ParameterError(
                "--free: {key} has no effect on {kinds}. Remove it, or add data that depend on it"
            ).tag("unused_key", key=key, kinds=kinds)


@dataclass(slots=True)
class _ProgressCounter:
    """Progress of an identification: the current step and the number of simulated runs."""

    progress: Progress
    doing: str = "starting"
    runs: int = 0

    def __call__(self, runs: int) -> None:
        """Report the number of finished runs."""
        self.runs = runs
        self.progress(f"{self.doing}; {runs} simulated runs")

    def about(self, doing: str) -> None:
        """Report that a step such as a search begins, with the number of simulated runs so far."""
        self.doing = doing
        self.progress(f"{doing}; {self.runs} simulated runs" if self.runs else doing)
