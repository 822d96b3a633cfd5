"""Identification of the parameters of a scenario from measurements."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np

from .._support.errors import FitError, ParameterError
from .._support.processes.executors import ExecutorLike, require_executor
from .._support.processes.kept_rows import KeptRows, forget
from ..parameters import values_of
from ..scenario import Scenario, ScenarioFile
from ..scenario.identify_section import given_parameters
from ..scenario.keys import free_keys
from ..scenario.reading import build_input, load_input
from ..scenario.resolution import ScenarioInput
from .bootstrap import BootstrapBy, require_bootstrap
from .data import Collected, Data, collected, fingerprint, values_to_begin_with
from .groove_residuals import GrooveResiduals, require_groove_stays
from .grooves_alone import grooves_alone
from .parameter import Parameter, fixed_by_given, parameter_table
from .photo_cell_times import PhotoCellTimes
from .problem import Observations, keys_of_runs, problem_of
from .result import Effort, Identification
from .simulations import RunSimulation, Simulations
from .solution import too_few
from .solving import Request, solved
from .track_positions import TrackPositions

_NOTHING: Final[Mapping[str, object]] = MappingProxyType({})
Progress = Callable[[str], None]


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
    """Find the parameters of a scenario that fit what was measured.

    Parameters
    ----------
    scenario
        A scenario, a built-in name, the path of a file, or values as given.
    data
        Tracks, photo-cell times, measured grooves, or paths of files with these; several together.
    free
        Free keys, with or without section and unit; ``KEY@RUN`` in one run of several, ``KEY@each`` in
        each a value of its own, as keys of the start always. Default: those with a table ``[identify."KEY"]``.
    changes
        Other values of the scenario, as `skisnow.scenario` takes them.
    starts
        Searches, the first from the scenario's values, the others from random places about them.
    profile
        Whether intervals are also found by refitting all others along each parameter.
    bootstrap, posterior
        Numbers of resamples, and of samples of the posterior; 0: none.
    bootstrap_by
        "refit": each resample is refitted, with one to four simulated runs of each track; "linear": by the model
        linearised at the best values, in no time.
    clock_is_free
        Whether each photo-cell run's clock has a separate offset; None: as ``[identify] clock`` says, else not.
    rng
        Source of random numbers, for starts, bootstrap and posterior; left out, one with the seed 0.
    workers
        Processes that simulate; None: as many as this process has cores.
    executor
        Executor used instead of processes of this computer, as of `skisnow.run_batch`.
    checkpoint
        File in which finished simulations are stored, and looked for first; None: nowhere.
    restart
        Whether what an earlier search stored there is forgotten, once everything that is asked has been found right.
    progress
        Called with a line of text now and then.

    Returns
    -------
    Identification
        Whatever the outcome. Ctrl-C keeps the best so far with the outcome "interrupted".

    Raises
    ------
    ParameterError, FieldDataError
        A name is unknown, bounds exclude the start, data are of another place or cannot be read.
    FitError
        Not even the start can be computed.

    See Also
    --------
    skisnow.simulate : the run that is fitted.
    skisnow.compare_tracks : how far two tracks are apart, without a fit.

    Notes
    -----
    Searches simulate with fixed steps of 1 ms; the last steps of the search and the numbers of the answer are computed
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
    given = (scenario if isinstance(scenario, ScenarioInput) else load_input(scenario)).changed(changes)
    asked = build_input(given)
    own = given_parameters(given.identify)
    keys = free_keys(free) or tuple(dict.fromkeys(key.partition("@")[0] for key in own))
    if not keys:
        raise ParameterError('nothing is looked for: name keys with --free, or write [identify."KEY"] in the scenario')
    read = collected(given, asked, [data] if isinstance(data, Data | str | Path) else data, keys)
    parameters = parameter_table(keys_of_runs(keys, read.runs), values_to_begin_with(asked, read, own), own)
    simulate = RunSimulation(given, tuple(track.time for track in read.tracks))
    if restart and checkpoint is not None:
        forget(checkpoint)
    rows = KeptRows() if checkpoint is None else KeptRows.opened(checkpoint, fingerprint(given, read.tracks))
    counted = _Counted(progress or _silent)
    with Simulations(simulate, rows, workers, counted, executor) as simulations:
        observations = _observations(asked, read, simulations, clock_is_free=_clock(given, clock_is_free))
        _require_used(keys, observations)
        plan = Request(
            title=given.title,
            starts=starts,
            profile=profile,
            bootstrap=bootstrap,
            bootstrap_by=bootstrap_by,
            posterior=posterior,
            rng=np.random.default_rng(0) if rng is None else rng,
            progress=counted.about,
            warnings=(*read.warnings, *_fixed(keys, own)),
            methods=read.methods,
        )
        found = _found(parameters, observations, plan)
        return replace(
            found,
            data=read.taken,
            effort=replace(
                found.effort,
                simulations=simulations.computed,
                kept_simulations=simulations.found,
                wall_s=time.monotonic() - begun,
            ),
        )


def _found(parameters: tuple[Parameter, ...], observations: tuple[Observations, ...], plan: Request) -> Identification:
    problem = problem_of(parameters, observations)
    if not problem.priors and problem.points < len(parameters) + problem.nuisances + (not problem.accuracy_is_stated):
        return too_few(problem, plan.title, plan.warnings)
    only = observations[0]
    if len(observations) == 1 and isinstance(only, GrooveResiduals):
        return grooves_alone(parameters, only, plan)
    return solved(problem, plan)


def _observations(
    scenario: ScenarioFile, read: Collected, simulations: Simulations, *, clock_is_free: bool
) -> tuple[Observations, ...]:
    observationss: list[Observations] = []
    if read.tracks:
        observationss.append(
            TrackPositions(read.tracks, simulations, read.fixed, read.starts, values_of(scenario.scenario))
        )
    observationss += [PhotoCellTimes(cell, scenario, read.starts, clock_is_free) for cell in read.cells]
    for groove in read.grooves:
        require_groove_stays(scenario)
        observationss.append(GrooveResiduals(groove, scenario))
    return tuple(observationss)


def _clock(scenario_input: ScenarioInput, asked: bool | None) -> bool:
    return scenario_input.identify.get("clock", "start") == "free" if asked is None else asked


def _require_used(keys: Sequence[str], observations: Sequence[Observations]) -> None:
    for key in (key.partition("@")[0] for key in keys):
        if not any(observation.depends_on(key) for observation in observations):
            kinds = " and ".join(dict.fromkeys(observation.kind.replace("_", " ") for observation in observations))
            raise ParameterError(f"--free: {key} plays no part in {kinds}. Leave it out, or add data that depend on it")


def _fixed(keys: Sequence[str], own: Mapping[str, object]) -> tuple[str, ...]:
    fixed = fixed_by_given(keys, own)
    if not fixed:
        return ()
    return (f"{', '.join(fixed)} stand under [identify] and are not looked for: they keep the scenario's values",)


@dataclass(slots=True)
class _Counted:
    """What is being done, with the number of simulated runs."""

    progress: Progress
    doing: str = "starting"
    runs: int = 0

    def __call__(self, runs: int) -> None:
        """Take note of a finished run."""
        self.runs = runs
        self.progress(f"{self.doing}; {runs} simulated runs")

    def about(self, doing: str) -> None:
        """Report the current step."""
        self.doing = doing
        self.progress(f"{doing}; {self.runs} simulated runs" if self.runs else doing)


def _silent(_text: str) -> None:
    return


__all__ = ["Effort", "FitError", "Identification", "identify"]
