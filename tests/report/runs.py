"""Runs made without a simulation: a left or right turn on a circle, with everything known in closed form."""

import math

import numpy as np

from skisnow._support.units import DEGREE, N_PER_MM2, N_PER_MM3
from skisnow.scenario import Air, Contact, Plane, RigidSledge, Scenario, Solver, Start, Stop
from skisnow.simulation.moving_boots import BootHistory
from skisnow.simulation.run import Groove, Run, SkiHistory
from skisnow.simulation.run_forces import node_lengths
from skisnow.ski import ski_named
from skisnow.snow import SnowProperties

SPEED, RADIUS, DURATION, STANCE = 8.0, 12.0, 4.0, 0.5
DEPTH = 0.02


def circle_scenario(*, duration: float = DURATION, unloading_ratio: float = 10.0) -> Scenario:
    """A scenario as `carved-46m` has it, near enough."""
    snow = SnowProperties(0.2 * N_PER_MM3, 0.5 * N_PER_MM2, source="given as numbers")
    return Scenario(
        slope=Plane(10.0 * DEGREE),
        contact=Contact(snow=snow, unloading_ratio=unloading_ratio, friction=0.01),
        air=Air(drag_area=0.42, density=1.1, centre_of_pressure_height=0.2),
        sledge=RigidSledge(80.0, (4.0, 4.0, 4.0), (0.0, 0.2), STANCE, 30.0 * DEGREE),
        ski=ski_named("giant-slalom"),
        start=Start(speed=SPEED, heading=-30.0 * DEGREE),
        stop=Stop(duration=duration),
        solver=Solver(),
    )


def circle_run(
    *, left: bool = True, radius: float = RADIUS, duration: float = DURATION, count: int = 201, deep: float = DEPTH,
    unloading_ratio: float = 10.0,
) -> Run:  # fmt: skip
    """A turn at constant speed; heading 0 at half time; the left ski's track lies left of the right one's."""
    time = np.linspace(0.0, duration, count)
    turn = 1.0 if left else -1.0
    heading = turn * SPEED / radius * (time - duration / 2.0)
    place = np.stack(
        [radius * np.sin(turn * heading), turn * radius * (1.0 - np.cos(heading)), np.zeros(count)], axis=1
    )
    place[:, 0] -= place[0, 0]
    forward = np.stack([np.cos(heading), np.sin(heading), np.zeros(count)], axis=1)
    to_left = np.stack([-np.sin(heading), np.cos(heading), np.zeros(count)], axis=1)
    attitude = np.stack([forward, to_left, np.broadcast_to([0.0, 0.0, 1.0], (count, 3))], axis=2)
    skis = _skis(time, place, to_left, deep)
    kinetic = np.full(count, 0.5 * 85.0 * SPEED**2)
    potential = -85.0 * 9.81 * math.sin(10.0 * DEGREE) * (place[:, 0] - place[0, 0])
    gone = -potential
    shares = {"penetration": 0.3, "shear": 0.25, "friction": 0.25, "drag": 0.15, "damping": 0.03, "snow_damping": 0.02}
    energies = {
        "kinetic": kinetic, "potential": potential, "elastic_ski": np.full(count, 12.0),
        "elastic_snow": np.full(count, 3.0), "delayed_snow": np.zeros(count),
        **{name: share * gone for name, share in shares.items()},
    }  # fmt: skip
    return Run(
        scenario=circle_scenario(duration=duration, unloading_ratio=unloading_ratio),
        outcome="finished", remedy="", time=time, place=place, attitude=attitude, velocity=SPEED * forward,
        heading=heading, turn_radius=np.full(count, turn * radius), skis=skis,
        groove=_groove(skis), energies=energies, run_length=SPEED * duration, steps=8000, rejected_steps=3,
        wall_s=0.5, numbers={"elements": 40.0, "line_spacing_m": 0.02},
        boots=_boots(skis, attitude),
    )  # fmt: skip


def _skis(time: np.ndarray, place: np.ndarray, to_left: np.ndarray, deep: float) -> SkiHistory:
    station = np.linspace(0.95, -0.85, 61)
    shape = (len(time), 2, len(station))
    outer = np.array([0.6, 1.0])[None, :, None]
    # the forebody cuts in, the afterbody keeps nearly the depth: a value for each station
    along = np.where(station > 0.0, 1.0 - (station / 0.8) ** 2, 0.92 - 0.1 * station**2)
    grows = 1.0 + 0.2 * np.sin(2.0 * time)[:, None, None]
    edge_depth = deep * outer * grows * along
    force = 600.0 * outer * grows * np.exp(-((station - 0.1) ** 2) / 0.08)
    half = np.array([STANCE / 2.0, -STANCE / 2.0])
    shear = 0.4 * 0.5e6 * np.maximum(edge_depth, 0.0)
    normal, side = (np.broadcast_to(each, shape) @ node_lengths(station) for each in (force, shear))
    return SkiHistory(
        station=station,
        track=place[:, None, :] + half[None, :, None] * to_left[:, None, :],
        depth=edge_depth[:, :, np.argmin(abs(station))],
        edge_depth=edge_depth,
        force_per_length=np.broadcast_to(force, shape),
        shear_per_length=shear,
        force=side[..., None] * to_left[:, None, :] + normal[..., None] * np.array([0.0, 0.0, 1.0]),
        bending=np.broadcast_to(0.02 * station**2, shape),
        twist=np.broadcast_to(-0.5 * DEGREE * station**2, shape),
    )


def _boots(skis: SkiHistory, attitude: np.ndarray) -> BootHistory:
    """Flat boots over the tracks, each bearing 400 N along the normal."""
    shape = skis.track.shape
    axes = np.broadcast_to(np.swapaxes(attitude, 1, 2)[:, None], (*shape[:2], 3, 3))
    return BootHistory(
        place=skis.track,
        axes=axes,
        own_force=np.broadcast_to([0.0, 0.0, 400.0], shape),
        own_moment=np.zeros(shape),
        centre_of_mass=skis.track.mean(axis=1) + np.array([0.0, 0.0, 0.5]),
    )


def _groove(skis: SkiHistory) -> Groove:
    """A piece under each ski every second place of its track."""
    places = skis.track[::2]
    along = np.gradient(places, axis=0)
    along /= np.linalg.norm(along, axis=2)[..., None]
    to_left = np.stack([-along[..., 1], along[..., 0], np.zeros(along.shape[:2])], axis=2)
    depth = skis.depth[::2].ravel()
    return Groove(places.reshape(-1, 3), to_left.reshape(-1, 3), 2.0 * depth, depth, 0.9 * depth)
