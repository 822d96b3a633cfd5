"""Folder of sample files, with simulated runs, that ``skisnow samples`` writes."""

from __future__ import annotations

import math
from importlib.resources import as_file, files
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from .._support.errors import OutputError
from .._support.staging import require_writable, staged, write_file
from .._support.units import MM
from ..campaign import write_reference
from ..carving.equilibrium import carve
from ..scenario import Plane, load_scenario
from ..simulation.simulated_run import simulate
from .measurements import (
    AZIMUTH_DEG,
    ORIGIN,
    course_waypoints,
    gates_track,
    gpx_track,
    photo_cell_times,
    snow_samples,
    touring_day,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..scenario import Scenario
    from ..simulation import Run

CAMPAIGN: Final = "campaign"
LAST: Final = "README.txt"


def write_samples(folder: str | Path, *, seed: int = 1) -> list[Path]:
    """Write synthetic sample files: a campaign, tracks, gates, photo-cell times, pits, studies.

    Parameters
    ----------
    folder
        New or empty folder.
    seed
        Seed of the random numbers, 0 or more.

    Returns
    -------
    The files, sorted by path.

    Raises
    ------
    OutputError
        The folder is not empty or cannot be written.

    Notes
    -----
    All files are synthetic. No value in them was measured.
    """
    folder = Path(folder)
    if folder.exists() and any(folder.iterdir()):
        raise OutputError("{folder} is not empty. Give a new or an empty folder.", code="wrong_kind", folder=folder)
    require_writable(folder)
    with staged(folder, last=LAST) as stage:
        for name, content in _contents(np.random.default_rng(seed)):
            write_file(stage.path / name, content)
        write_reference(stage.path / CAMPAIGN, seed=seed)
    return sorted(path for path in folder.rglob("*") if path.is_file())


def _contents(random: np.random.Generator) -> Iterator[tuple[str, str | bytes]]:
    """Each file outside the reference campaign, by its path in the folder."""
    with as_file(files(__package__) / "files") as shipped:
        for path in sorted(path for path in shipped.rglob("*") if path.is_file()):
            yield path.relative_to(shipped).as_posix(), path.read_bytes()
    yield "day.gpx", touring_day(random)
    yield "run.gpx", gates_track(random)
    yield "course.gpx", course_waypoints()
    yield "cells.csv", photo_cell_times(random)
    yield from run_samples(random)
    yield from snow_samples(random)


SCENARIO: Final = "carved-46m"
_NOISE_M: Final = 0.02
_EVERY: Final = 10  # rows of a run every 10 ms become points at 10 Hz
_MINE: Final = f"""
[solver]
method = "fast"

[identify.site]
fall_line_azimuth_deg = {AZIMUTH_DEG:g}
latitude_deg = {ORIGIN.latitude_deg}
longitude_deg = {ORIGIN.longitude_deg}
"""
_SECOND_RUN: Final = """
[identify.runs."run-2.gpx"]
speed_m_per_s = 8.1
heading_deg = -25
mass_kg = 95
"""


def run_samples(random: np.random.Generator) -> Iterator[tuple[str, str]]:
    """Name and content of the samples that need a simulated run."""
    usual = _run()
    other = _run(speed_m_per_s=8.1, heading_deg=-25.0, mass_kg=95.0)
    mine = (files("skisnow.scenario") / "catalogue" / f"{SCENARIO}.toml").read_text("utf-8") + _MINE
    yield "mine.toml", mine
    yield "two-runs.toml", mine + _SECOND_RUN
    yield "measured.csv", _table(usual, random)
    yield "measured.gpx", _gpx(usual, random)
    yield "run-1.gpx", _gpx(usual, random)
    yield "run-2.gpx", _gpx(other, random)
    yield "marks.csv", _grooves(usual.scenario, random)


def _run(**changes: float) -> Run:
    return simulate(load_scenario(SCENARIO, changes={"solver.method": "fast"}).with_(**changes))


def _table(run: Run, random: np.random.Generator) -> str:
    place = run.place[::_EVERY] + _NOISE_M * random.standard_normal(run.place[::_EVERY].shape)
    rows = np.column_stack([run.time[::_EVERY], place])
    return "\n".join(["time_s,x_m,y_m,z_m", *(",".join(f"{value:.3f}" for value in row) for row in rows.tolist()), ""])


def _gpx(run: Run, random: np.random.Generator) -> str:
    slope = run.scenario.slope
    assert isinstance(slope, Plane)
    place = run.place[::_EVERY] + _NOISE_M * random.standard_normal(run.place[::_EVERY].shape)
    return gpx_track(place, run.time[::_EVERY], slope_angle=slope.angle)


def _grooves(scenario: Scenario, random: np.random.Generator) -> str:
    """CSV of the groove at eight places, with the depth that stays and the radius of a steady carve."""
    sledge, slope, contact = scenario.sledge, scenario.slope, scenario.contact
    assert isinstance(slope, Plane)
    load = (sledge.mass + 2.0 * scenario.ski.mass) * scenario.gravity * math.cos(slope.angle) / 2.0
    answer = carve(
        scenario.ski,
        contact.snow,
        edge_angle=sledge.edge_angle,
        load=load,
        unloading_ratio=contact.unloading_ratio,
    )
    deepest = float(np.max(np.asarray(answer.edge_depth)))
    depth = deepest * (1.0 - 1.0 / contact.unloading_ratio) / MM
    width = deepest / math.tan(sledge.edge_angle) / MM
    rows = ["depth_mm,width_mm,turn_radius_m,depth_sd_mm,width_sd_mm,turn_radius_sd_m"]
    for _ in range(8):
        noise = random.standard_normal(3)
        rows.append(
            f"{depth + 0.2 * noise[0]:.2f},{width + 0.5 * noise[1]:.2f},"
            f"{answer.turn_radius_chord + 0.3 * noise[2]:.2f},0.2,0.5,0.3"
        )
    return "\n".join((*rows, ""))
