"""Computation of a scenario: the loop over output times, the end of a run, the stored values."""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, TypeAlias

import numpy as np

from .._support.errors import ModelLimitWarning, ParameterError
from .._support.messages import Message, joined
from .._support.units import MM
from ..contact import Laws
from ..scenario import Scenario
from ..scenario.plausibility import model_limits
from ..skier import BalancedSkier, Controller
from ..skier.balance import BalanceRecord
from ..skier.failure import cause_of
from .moving_boots import SAME_TIME, BootControl
from .run import OPEN_SHARE, Groove, Outcome, Run, Strength
from .run_record import Record
from .run_setup import AT_REST, PITCHED, TIPPED, Setup, no_start, set_up
from .run_summary import GatesAhead, run_gates

Progress: TypeAlias = Callable[[float, float], None]
"""Takes the simulated time (s), and the share of the run that is done, 0 to 1."""

LONGEST_FLIGHT: Final = 0.3
"""Time (s) with both skis off the snow after which it is airborne (modelling assumption)."""
SINKING_DEPTH: Final = 0.5
"""Depth (m) of the boots below the surface at which the sledge has sunk (modelling assumption)."""
OUTPUTS_AT_ONCE: Final = 5
"""Outputs between which no progress is reported."""
CLEAR: Final = 1.0
"""Distance (m) of the boots behind the last gate at which a course is over: whatever counts has crossed its line."""
_COMPUTED_WRONG: Final = ("step_too_small", "not_finite", "interrupted")
"""Outcomes that an open balance does not take the place of."""
CLOSER: Final = 4.0
"""Factor by which lines of snow are closer when a run is repeated because its energy balance is open."""
CLOSEST: Final = 2e-3
"""Distance (m) of lines of snow below which a run is not repeated."""
_REACHED: Final = 1e-6
"""Run length (m) that counts as none left."""

REMEDIES: Final[dict[Outcome, str]] = {
    "finished": Message("Completed: the whole duration was simulated."),
    "distance_reached": Message("The run length was reached."),
    "end_of_slope": Message(
        "The tips reached the end of the profile, or a border of the grid. Give a longer or wider slope, or a shorter "
        "run."
    ),
    "tipped_over": Message(
        "The sledge leant more than 60° from the snow's normal, or more than 40° ahead or back: it has tipped over. "
        "Lower its centre of mass, widen the stance, or reduce edge angle or speed."
    ),
    "fell": Message(
        "The skier leant more than 60° from the snow's normal: it fell. Reduce the speed, or use a gentler slope or "
        "longer turns; figures/balance shows where the lean left the balance."
    ),
    "airborne": Message(
        "Both skis were off the snow for 0.3 s, a skier's above skier.highest_flight_m. Reduce the speed, or use a "
        "smoother slope."
    ),
    "sunk": Message(
        "The boots sank more than half a metre below the surface, or would: this snow does not carry the sledge. Use "
        "harder snow, less mass or a wider ski."
    ),
    "missed_gate": Message("Change line or start, or the course; gates.csv lists the result at each gate."),
    "straddled": Message(
        "By the rules this is not a passage. Change line or start, or the course; gates.csv lists the result at each "
        "gate."
    ),
    "energy_open": Message(
        "The energy residual is more than 0.5 % of the energy exchanged: the numbers are not reliable. Use smaller "
        "steps, or the error control (solver.fixed false); on very hard snow, or at more than 50° of edge angle, a "
        "smaller tolerance."
    ),
    "step_too_small": Message(
        "The error control required steps below 0.1 µs, or steps of microseconds for too long: the motion is too "
        "stiff or too rough. Increase the tolerance, or reduce k_u/H_V or S_f/H_V."
    ),
    "not_finite": Message("The numbers diverged. Use a smaller step, or the error control."),
    "interrupted": Message("The run was stopped; the results so far are kept."),
}


def simulate(
    scenario: Scenario,
    *,
    progress: Progress | None = None,
    strength_along: Strength | None = None,
    laws: Laws | None = None,
    boots: BootControl | None = None,
    controller: Controller | None = None,
) -> Run:
    """Simulate a scenario from static equilibrium.

    Parameters
    ----------
    scenario
        Scenario to simulate.
    progress
        Called with the simulated time and the share that is done, after every five outputs at the latest.
    strength_along
        S_f over that of the scenario, > 0, by the distance run (m): snow that is weaker or stronger in places.
        Evaluated every 10 ms, for both skis and all along them.
    laws
        Instead of the scenario's: laws of `skisnow.forces`, or user-defined ones. Run, summary.json and report name
        them with their numbers.
    boots
        Moves the boots against the sledge, instead of the scenario's boots.file: called with a `BootMoment` every
        10 ms, or after its attribute ``period`` (s), it gives the `BootPose` of the left and the right boot at the end
        of that time. Its method ``push``, if it has one, gives a force and its place on the sledge.
    controller
        Replaces the built-in control of the scenario's skier: its method ``command`` takes the skier's observation,
        posture and the period (s), and returns a `skisnow.skier.Command`.

    Returns
    -------
    Run
        The run up to its end, whatever the outcome. Ctrl-C ends a run with the outcome "interrupted".

    Raises
    ------
    SolverError
        The sledge finds no equilibrium to start from.

    See Also
    --------
    skisnow.scenario : the parts of a run.
    skisnow.verify : accuracy of a run.
    skisnow.compare : the run next to a measured track.

    Notes
    -----
    One thread; the same scenario gives the same bits on the same machine.

    References
    ----------
    * Mössner and others (2013), "Modeling the ski-snow contact in skiing turns using a hypoplastic vs an elastic
      force-penetration relation", Scand. J. Med. Sci. Sports, doi 10.1111/sms.12035.
    * The page docs/methods/simulated-turn.md.
    """
    for code, text in model_limits(scenario.ski).items():
        warnings.warn(ModelLimitWarning(text).tag(code), stacklevel=2)
    if controller is not None:
        if boots is not None:
            raise ParameterError("boots and controller both move the boots; give one of them").tag("contradiction")
        boots = BalancedSkier(scenario, controller)
    run, setup = _run_once(scenario, progress, laws=laws, boots=boots, strength_along=strength_along)
    if run.outcome == "energy_open" and boots is None and not scenario.solver.fixed:
        spacing = run.numbers["line_spacing_m"]
        solver = replace(scenario.solver, line_spacing=max(spacing / CLOSER, min(CLOSEST, spacing)))
        closer = replace(scenario, solver=solver)
        other, other_setup = _run_once(closer, progress, laws=laws, boots=boots, strength_along=strength_along)
        if other.outcome not in ("energy_open", *_COMPUTED_WRONG):
            run, setup = replace(other, scenario=scenario), other_setup
            warning = ModelLimitWarning(
                "with lines of snow {spacing:.3g} mm apart the energy balance stayed open. The run was repeated with "
                "lines {closer:.3g} mm apart. Set solver.line_spacing_mm to {closer:.3g} or less"
            ).tag("repeated_with_closer_lines", spacing=spacing / MM, closer=run.numbers["line_spacing_m"] / MM)
            warnings.warn(warning, stacklevel=2)
    _warn_of_friction(run)
    _warn_of_unseen_tracks(setup)
    return replace(run, laws=laws, strength_along=strength_along)


def _run_once(
    scenario: Scenario,
    progress: Progress | None,
    *,
    laws: Laws | None,
    boots: BootControl | None,
    strength_along: Strength | None,
) -> tuple[Run, Setup]:
    """The run, and its setup at its end."""
    setup = set_up(scenario, laws=laws, boots=boots, strength_along=strength_along)
    record = Record(setup)
    if setup.height < -SINKING_DEPTH or (not setup.static_residual <= AT_REST and setup.sinks):
        return computed_run(setup, record, "sunk", 0.0), setup
    if not setup.static_residual <= AT_REST:
        setup.dynamics.contact.require_finite_laws()
        raise no_start(setup)
    begin = time.perf_counter()
    try:
        outcome = _loop(setup, record, progress)
    except KeyboardInterrupt:
        outcome = "interrupted"
    return computed_run(setup, record, outcome, time.perf_counter() - begin), setup


def _warn_of_unseen_tracks(setup: Setup) -> None:
    """Warn of older tracks between the lines of snow, with the largest force that is missing."""
    width, force = setup.dynamics.contact.compiled.unseen_track()
    if width > 0.0:
        spacing = setup.numbers["line_spacing_m"]
        warning = ModelLimitWarning(
            "older tracks of up to {width:.2g} mm crossed between two lines of snow, {spacing:.3g} mm apart, and were "
            "not seen: up to {force:.2g} N of the force on a ski may be wrong there. Use a solver.line_spacing_mm "
            "below {width:.2g}"
        ).tag("tracks_between_lines", width=width / MM, spacing=spacing / MM, force=force)
        warnings.warn(warning, stacklevel=3)


def _warn_of_friction(run: Run) -> None:
    """Warn of speeds and snow beyond a law file, and of friction that falls to 0, where the core keeps it."""
    contact = run.scenario.contact
    fastest = float(run.speed.max(initial=0.0))
    if contact.friction_law is not None:
        speeds = float(run.speed.min(initial=fastest)), fastest
        contact.friction_law.warn_outside(contact.temperature, contact.liquid_water or 0.0, speeds)
    elif contact.friction_at(fastest) < 0.0:
        zero_at = -contact.friction / contact.friction_by_speed
        warning = ModelLimitWarning(
            "mu_0 + mu_1 v is below 0 above {zero_at:.3g} m/s, and the run reached {fastest:.3g} m/s: friction counts "
            "as 0 there. Use a friction.mu_1_s_per_m nearer to 0"
        ).tag("friction_below_zero", zero_at=zero_at, fastest=fastest)
        warnings.warn(warning, stacklevel=3)


@dataclass(slots=True)
class _Watch:
    """Checks during a run whether it ends (fall, end of slope or course); called when a drive or an output is due."""

    setup: Setup
    outcome: Outcome | None = None
    _course: GatesAhead = field(init=False)
    _flying: float = 0.0
    _last: float = 0.0

    def __post_init__(self) -> None:
        self._course = GatesAhead(self.setup.scenario.course)
        self._end_behind_last_gate()

    def look(self) -> bool:
        """Check the present moment; True where the run is over."""
        setup = self.setup
        self._flying = 0.0 if setup.dynamics.touches else self._flying + setup.dynamics.time - self._last
        self._last = setup.dynamics.time
        self.outcome = _current_outcome(setup, self._flying)
        if self.outcome is None:
            self._end_behind_last_gate()
        return self.outcome is not None

    def _end_behind_last_gate(self) -> None:
        """End the run as finished if the body is far enough behind the course's last gate."""
        if self._course.is_over(self.setup.place, CLEAR):
            self.outcome = "finished"


def _loop(setup: Setup, record: Record, progress: Progress | None) -> Outcome:
    """Advance from output to output until the run ends; returns its outcome."""
    stop, interval = setup.scenario.stop, setup.scenario.solver.output_interval
    duration = math.inf if stop.duration is None else stop.duration
    length = math.inf if stop.length is None else stop.length
    number, nearing, watch = 0, False, _Watch(setup)
    while watch.outcome is None:
        time = setup.dynamics.time
        if duration - time <= SAME_TIME:
            return "finished"
        left = length - record.run_length
        if left <= _REACHED:
            return "distance_reached"
        moment = min((number + 1) * interval, duration)
        was_near, nearing = nearing, setup.speed * (moment - time) > left
        if nearing:
            moment = time + max(left / setup.speed, 2.0 * SAME_TIME)
        ended = record.advance(moment, replace=was_near, is_over=watch.look)
        number = math.floor((setup.dynamics.time + 2.0 * SAME_TIME) / interval)  # just below an output: it is reached
        if record.gains_energy:
            record.drop()
            return "not_finite"
        if progress is not None and number % OUTPUTS_AT_ONCE == 0:
            progress(setup.dynamics.time, min(1.0, max(setup.dynamics.time / duration, record.run_length / length)))
        if ended is not None:
            return ended
        if not setup.drives:
            watch.look()
    return watch.outcome


def _current_outcome(setup: Setup, flying: float) -> Outcome | None:
    """Outcome that ends the run now, such as a fall or a flight of `flying` seconds; None: it goes on."""
    (leaning, pitching), skier = setup.tilt, setup.scenario.skier
    if skier is not None and leaning > TIPPED and setup.dynamics.touches:
        return "fell"
    if skier is None and (leaning > TIPPED or (pitching > PITCHED and setup.drive is None and setup.dynamics.touches)):
        return "tipped_over"
    if flying >= LONGEST_FLIGHT and (skier is None or setup.height > skier.highest_flight):
        return "airborne"
    if setup.height < -SINKING_DEPTH:
        return "sunk"
    return "end_of_slope" if setup.past_end else None


def computed_run(setup: Setup, record: Record, outcome: Outcome, wall: float) -> Run:
    """Result of a run; the outcome becomes `energy_open` if too much energy is unaccounted for."""
    steps, rejected, *_ = setup.dynamics.counts
    run = Run(
        scenario=setup.scenario,
        outcome=outcome,
        remedy=REMEDIES[outcome],
        **record.histories(),
        groove=_groove(setup),
        run_length=record.run_length,
        steps=steps,
        rejected_steps=rejected,
        wall_s=wall,
        numbers=setup.numbers,
        boots_by=None if setup.drive is None else setup.drive.described,
    )
    if outcome in _COMPUTED_WRONG:
        return run
    if run.has_residual_above(OPEN_SHARE):
        return replace(run, outcome="energy_open", remedy=REMEDIES["energy_open"])
    skier = None if setup.drive is None else setup.drive.control
    records = skier.records if isinstance(skier, BalancedSkier) else []
    if outcome == "fell":
        return replace(run, remedy=joined([*_cause(run, records), run.remedy]))
    return _through_gates(run, records) if outcome in ("finished", "distance_reached") else run


def _cause(run: Run, records: Sequence[BalanceRecord]) -> list[Message]:
    """Sentence on the first limit that the skier exceeded within the records; empty if none."""
    skier, weight = run.scenario.skier, run.scenario.sledge.mass * run.scenario.gravity
    cause = None if skier is None else cause_of(records, skier, weight)
    return [] if cause is None else [cause.message]


def _through_gates(run: Run, records: Sequence[BalanceRecord] = ()) -> Run:
    """The run; if it missed or straddled a gate of its course, with that outcome instead."""
    result = run_gates(run)
    fault = None if result is None else result.fault
    if fault is None:
        return run
    outcome: Outcome = "straddled" if fault.outcome == "straddled" else "missed_gate"
    cause = [] if fault.time is None else _cause(run, [record for record in records if record.seen.time <= fault.time])
    return replace(run, outcome=outcome, remedy=joined([fault.words, *cause, REMEDIES[outcome]]))


def _groove(setup: Setup) -> Groove:
    """Grooves of a run: one piece for each line, from the first knot of its groove to the last."""
    rows = setup.dynamics.contact.tracks()
    if not len(rows):
        return Groove(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), np.zeros(0), np.zeros(0))
    first = np.flatnonzero(np.any(np.diff(rows[:, :2], axis=0, prepend=-1.0) != 0.0, axis=1))
    last = np.append(first[1:], len(rows)) - 1
    depth = np.maximum.reduceat(rows[:, 5], first)
    across = rows[last, 2:5] - rows[first, 2:5]
    width = np.linalg.norm(across, axis=1)
    wide = width > 0.0
    left = across[wide] / width[wide, None]
    middle = 0.5 * (rows[first, 2:5] + rows[last, 2:5])[wide]
    return Groove(middle, left, width[wide], depth[wide], setup.residual_depth(depth[wide]))
