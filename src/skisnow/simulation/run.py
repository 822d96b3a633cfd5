"""A run: results of a scenario over time and along the skis, and the way it ended."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.units import DEGREE, MM, Facts, Shown, amount, field_facts, name_with_values, span
from ..contact import Laws
from ..scenario import Plane, Scenario, Terrain
from ..track.track import Track
from .moving_boots import BootHistory
from .run_forces import BalanceHistory, node_lengths

Outcome: TypeAlias = Literal[
    "finished", "distance_reached", "end_of_slope", "tipped_over", "fell", "airborne", "sunk", "missed_gate",
    "straddled", "energy_open", "step_too_small", "not_finite", "interrupted",
]  # fmt: skip
Strength: TypeAlias = Callable[[float], float]
"""Takes the distance run (m), and gives S_f over that of the scenario, > 0."""

OPEN_SHARE, LEAST_OPEN = 0.005, 1e-3
"""Energy residual as a share of the energy exchanged, and in J: a run that exceeds both ends as `energy_open`."""
STEADY_SPEED, STEADY_FROM = 1.0, 0.5
"""Speed (m/s) above which, and time (s) after which, a run's turn radius counts: before, it is that of the start."""
STORED: Final = ("kinetic", "potential", "elastic_ski", "elastic_snow", "delayed_snow")
LOST: Final = ("penetration", "shear", "friction", "drag", "damping", "snow_damping")
GIVEN: Final = ("boots", "push")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class SkiHistory(Shown):
    """The skis over time: index 0 the time (n), 1 the ski (0 left, 1 right), 2 the place along it or the coordinate.

    station: Places along the ski, tip to tail, positive before the boot (m), (m,).
    track: (n, 2, 3) the loaded edge under the boot, nearer the middle of a flat ski, on the snow surface (m).
    depth: (n, 2) of that edge below the undisturbed surface (m); negative: above it.
    edge_depth: (n, 2, m) of the edge that is down, below the undisturbed surface (m); negative: above it.
    force_per_length, shear_per_length: (n, 2, m) of the snow along its normal, and across the edge, positive left
        (N/m).
    force: (n, 2, 3) total force of the snow on the ski in the slope's axes: normal force, shear and friction (N).
    bending, twist: (n, 2, m) deflection of the base away from the snow (m), growth of the edge angle (rad), against the
        boot.
    """

    station: FloatArray
    track: FloatArray
    depth: FloatArray
    edge_depth: FloatArray
    force_per_length: FloatArray
    shear_per_length: FloatArray
    bending: FloatArray
    twist: FloatArray
    force: FloatArray

    @property
    def total_force(self) -> FloatArray:
        """(n, 2) magnitude of `force` (N)."""
        return np.asarray(np.linalg.norm(self.force, axis=-1))

    @property
    def normal_force(self) -> FloatArray:
        """(n, 2) part of `force` along the snow's normal (N)."""
        return np.asarray(self.force_per_length @ node_lengths(self.station))

    def _repr_facts(self) -> Facts:
        force = dict.fromkeys(("force_per_length", "shear_per_length"), "N/m")
        return field_facts(self, dict.fromkeys(self.__slots__, "m") | force | {"twist": "rad", "force": "N"})


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Groove(Shown):
    """Grooves of the skis in the snow, one entry for each piece of a line across the path.

    middle: (k, 3) of the piece, on the undisturbed surface (m).
    left: (k, 3) unit vector along it, to the left.
    width: (k,) across (m).
    depth: (k,) deepest that the snow was pushed (m).
    residual_depth: (k,) of the groove that stays (m).
    """

    middle: FloatArray
    left: FloatArray
    width: FloatArray
    depth: FloatArray
    residual_depth: FloatArray

    def _repr_facts(self) -> Facts:
        return field_facts(self, dict.fromkeys(self.__slots__, "m") | {"left": ""})


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class Run(Shown):
    """Result of a simulation.

    Attributes
    ----------
    scenario
        The simulated scenario.
    outcome, remedy
        Outcome, and its meaning and remedy in words.
    time
        (n,) from the start (s).
    place
        (n, 3) of the middle between the boots, at the level of the bases (m).
    attitude
        (n, 3, 3) rotation matrix from the sledge's frame (x forward, y left, z up) to space.
    velocity
        (n, 3) of that middle, in space (m/s).
    heading
        (n,) of the skis from the fall line, positive left (rad).
    turn_radius
        (n,) of the middle's path, positive left (m); infinite where it is straight.
    skis
        The skis over time.
    groove
        Grooves of the skis.
    energies
        (n,) each (J): STORED, LOST since the start, and GIVEN by moving boots and pushes.
    run_length
        Length of the middle's path (m).
    steps, rejected_steps
        Numbers of the integrator.
    wall_s
        Time it took, without the start (s).
    numbers
        Choices of the solver: elements, line_spacing_m.
    boots
        Where the boots were, and force and moment on each; None where nothing is known of them.
    boots_by
        Their control, in words; None where they stay where the sledge has them.
    laws, strength_along
        Laws that acted instead of the scenario's, as `skisnow.simulate` was given it.

    See Also
    --------
    skisnow.simulate
    skisnow.compare
    """

    scenario: Scenario
    outcome: Outcome
    remedy: str
    time: FloatArray
    place: FloatArray
    attitude: FloatArray
    velocity: FloatArray
    heading: FloatArray
    turn_radius: FloatArray
    skis: SkiHistory
    groove: Groove
    energies: dict[str, FloatArray]
    run_length: float
    steps: int
    rejected_steps: int
    wall_s: float
    numbers: dict[str, float]
    boots: BootHistory | None = None
    boots_by: str | None = None
    laws: Laws | None = None
    strength_along: Strength | None = None

    @property
    def given_laws(self) -> dict[str, str | None]:
        """Laws that acted instead of the scenario's, in words: friction, shear, penetration, strength_along."""
        along = None if self.strength_along is None else name_with_values(self.strength_along)
        laws = dict.fromkeys(("friction", "shear", "penetration")) if self.laws is None else self.laws.described
        return {**laws, "strength_along": along}

    @property
    def balance(self) -> BalanceHistory:
        """Lean of the body over its skis, and the lean in balance; needs `boots`."""
        from .run_forces import balance_of

        return balance_of(self)

    @property
    def track(self) -> Track:
        """Path of the middle between the boots, as in track.csv: the input of `skisnow.compare`."""
        slope = self.scenario.slope
        axes = ("x down the fall line", "z out of the snow")
        if not isinstance(slope, Plane):
            axes = ("x horizontal distance down the fall line", "z height")
        if isinstance(slope, Terrain):
            axes = ("x horizontal, along that of the grid", "z height")
        return Track(
            name="simulated run",
            time=self.time,
            place=self.place,
            speed=self.speed,
            velocity=self.velocity,
            time_scale="local",
            frame=f"{axes[0]}, y to the left, {axes[1]}, in m",
            axes="slope",
            slope_angle=slope.angle if isinstance(slope, Plane) else 0.0,
            speed_kind="along the path",
        )

    def plot(self, what: str = "track") -> Any:
        """A figure of the run.

        what: "track": from above, with the grooves; "motion": speed, heading and turn radius; "along_ski": depth and
            normal force along both skis over time; "grip": grip utilisation of each ski; "energies"; "course": the line
            over the gates, with the edge angle as colour; "balance": lean, edge angle and forces; "boots": edge angles
            of both boots, forces and edging moments of the skis on them.
        Returns: A new figure; no window is opened.
        Raises ParameterError: the figure does not exist, or the run ended before its first step.
        """
        from ..report.run.drawings import run_figure

        return run_figure(self, what)

    def report(self, folder: str | Path) -> Path:
        """Write the files of ``skisnow simulate --out``: summary.json, track.csv, run.nc, figures/ and report.html.

        Returns: Path of report.html.
        Raises OutputError: a file cannot be written.
        """
        from ..report.run.page import write_run

        return write_run(self, folder)

    def to_dataframe(self) -> Any:
        """The rows of track.csv with its columns, units in their names; needs pandas (``skisnow[pandas]``).

        Returns: pandas.DataFrame
        Raises ParameterError: pandas is not installed.
        """
        from ..report.run.file import run_dataframe

        return run_dataframe(self)

    def to_xarray(self) -> Any:
        """The content of run.nc, over time and along the skis, SI; needs xarray (``skisnow[xarray]``).

        Returns: xarray.Dataset
        Raises ParameterError: xarray is not installed.
        """
        from ..report.run.file import run_dataset

        return run_dataset(self)

    def _repr_facts(self) -> Facts:
        """Title with the outcome, and rows with laws, length, speed, heading, radius, depth, energy and effort."""
        error, radius = self.energy_balance_error, self.turn_radius_quantile(0.5)
        finite = self.speed[np.isfinite(self.speed)]
        fastest = amount(float(finite.max()) if finite.size else None, "m/s")
        law_names = ", ".join(f"{name} {law.partition('(')[0]}" for name, law in self.given_laws.items() if law)
        rows = (
            *([("laws", f"given in Python: {law_names}")] if law_names else []),
            ("run length", f"{amount(self.run_length, 'm')} in {amount(self.simulated_s, 's')}"),
            ("speed", f"{span(float(self.speed[0]), float(self.speed[-1]), 'm/s')}, maximum {fastest}"),
            ("heading", span(float(self.heading[0]) / DEGREE, float(self.heading[-1]) / DEGREE, "°")),
            ("turn radius", "straight" if radius is None else f"{amount(radius, 'm')} (median)"),
            ("edge depth", f"maximum {amount(float(np.nanmax(self.skis.edge_depth)) / MM, 'mm')}"),
            ("energy residual", "no energy exchanged" if error is None else f"{amount(100.0 * error)} %"),
            ("computed in", f"{self.steps} steps, {amount(self.wall_s, 's')}"),
        )
        return Facts(self.outcome.replace("_", " "), rows)

    @property
    def speed(self) -> FloatArray:
        """Speed (m/s) of the middle between the boots, (n,)."""
        return np.asarray(np.linalg.norm(self.velocity, axis=1))

    @property
    def simulated_s(self) -> float:
        """Simulated time (s)."""
        return float(self.time[-1])

    @property
    def energy_exchanged(self) -> float:
        """Kinetic energy at the start, all losses, and the largest fall in potential energy (J).

        Moving boots may supply or absorb energy; the absorbed energy is a loss here.
        """
        potential = self.energies["potential"]
        lost = sum(float(self.energies[name][-1]) for name in LOST)
        taken = sum(max(0.0, -float(self._energy_or_zero(name)[-1])) for name in GIVEN)
        return float(self.energies["kinetic"][0]) + lost + taken + float(potential[0] - potential.min())

    def _energy_or_zero(self, name: str) -> FloatArray:
        """Energy over time (J) by its name; zeros if the run has none."""
        return self.energies.get(name, np.zeros(len(self.time)))

    @property
    def energy_balance_error(self) -> float | None:
        """|energy at the end + losses - energy at the start| as a share of the energy exchanged; None if that is 0."""
        over = self.energy_exchanged
        return self.energy_residual / over if over > 0.0 else None

    @property
    def energy_residual(self) -> float:
        """|energy at the end + losses - energy at the start| (J)."""
        change = sum(float(self.energies[name][-1] - self.energies[name][0]) for name in STORED)
        lost = sum(float(self.energies[name][-1]) for name in LOST)
        return abs(change + lost - sum(float(self._energy_or_zero(name)[-1]) for name in GIVEN))

    def has_residual_above(self, share: float) -> bool:
        """True if the energy residual exceeds a share of the energy exchanged, and 0.001 J."""
        error = self.energy_balance_error
        return error is not None and error > share and self.energy_residual > LEAST_OPEN

    def turn_radius_quantile(self, share: float) -> float | None:
        """Quantile of the turn radius (m), without its sign, once the start is over; None of a straight run."""
        steady = (self.speed > STEADY_SPEED) & (self.time - self.time[0] >= STEADY_FROM)
        radius = np.abs(self.turn_radius[steady & np.isfinite(self.turn_radius)])
        return float(np.quantile(radius, share)) if radius.size else None
