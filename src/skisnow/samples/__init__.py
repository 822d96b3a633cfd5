"""Synthetic sample files for every command that the documentation shows: campaign, tracks, photo cells, snow, runs."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from importlib.resources import as_file, files
from pathlib import Path
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import OutputError
from .._support.staging import require_writable, staged, write_file
from .._support.units import DEGREE, STANDARD_GRAVITY
from ..campaign import write_reference
from ..campaign.snow_pit import DepthTemperature, LayerDensity, SnowLayer, SnowPit
from ..interop.caaml import caaml_text
from ..scenario import Plane, load_scenario
from ..simulation import Run
from ..simulation.simulated_run import simulate
from ..track.projection import GeodeticPoint, east_north_up_axes, geodetic
from ..track.slope_frame import slope_axes

ORIGIN: Final = GeodeticPoint(47.1234, 11.4321, 1900.0)
AZIMUTH_DEG: Final = 140.0
"""Compass direction in which the sample slope falls."""
START: Final = datetime(2026, 2, 3, 9, 10, tzinfo=UTC)
RECEIVER_NOISE_M: Final = 0.3
"""Standard deviation of each coordinate; the noise of neighbouring points does not correlate."""
_GATES: Final = np.array([[12.0 + 12.0 * number, 2.0 * (-1.0) ** number] for number in range(8)])
_SLOPE_DEG: Final = 12.0


def touring_day(random: np.random.Generator) -> str:
    """GPX of three runs of linked turns at 10 m/s and two lifts, 1 Hz, on a slope of 12°."""
    length, turn, swing = 600.0, 60.0, 40.0 * DEGREE
    way = np.arange(0.0, length, 0.1)
    heading = swing * np.sin(2.0 * np.pi * way / turn)
    down = np.cumsum(np.column_stack([np.cos(heading), np.sin(heading)]) * 0.1, axis=0)[::100]
    up = np.linspace(down[-1], down[0], 200)
    place = np.concatenate([down, up, down, up, down])
    place = place + RECEIVER_NOISE_M * random.standard_normal(place.shape)
    return gpx_track(place, np.arange(len(place), dtype=float), slope_angle=_SLOPE_DEG * DEGREE)


def gates_track(random: np.random.Generator) -> str:
    """GPX of a run at 8 m/s and 10 Hz that passes the gates of `course_waypoints`, 0.6 m from each pole."""
    x = np.arange(0.0, _GATES[-1, 0] + 12.0, 0.01)
    y = 2.6 * np.cos(np.pi * (x - _GATES[0, 0]) / 12.0) * np.clip(x / _GATES[0, 0], 0.0, 1.0)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    even = np.arange(0.0, way[-1], 0.8)
    place = np.column_stack([np.interp(even, way, x), np.interp(even, way, y)])
    noise = 0.03 * random.standard_normal(place.shape)
    return gpx_track(place + noise, 0.1 * np.arange(float(len(place))), slope_angle=_SLOPE_DEG * DEGREE)


def course_waypoints() -> str:
    """GPX of eight gates: one waypoint for each turning pole, with the side on which it is passed."""
    points = on_earth(_GATES, slope_angle=_SLOPE_DEG * DEGREE)
    sides = ["left" if y > 0.0 else "right" for _, y in _GATES]
    rows = [
        f'<wpt lat="{point[0]:.9f}" lon="{point[1]:.9f}"><ele>{point[2]:.2f}</ele>'
        f"<name>{number}</name><type>{side}</type></wpt>"
        for number, (point, side) in enumerate(zip(points, sides, strict=True), 1)
    ]
    return _gpx_document(rows)


def on_earth(place: FloatArray, *, slope_angle: float) -> FloatArray:
    """Latitude (°), longitude (°), height (m) of points x down the slope, y to the left, shape (n, 2) or (n, 3)."""
    inside = np.zeros((len(place), 3))
    inside[:, : place.shape[1]] = place
    east_north_up = inside @ slope_axes(AZIMUTH_DEG * DEGREE, slope_angle)
    return geodetic(ORIGIN.in_space + east_north_up @ east_north_up_axes(ORIGIN.latitude_deg, ORIGIN.longitude_deg))


def gpx_track(place: FloatArray, time: FloatArray, *, slope_angle: float) -> str:
    """GPX 1.1 of points on the slope (m) at times (s) after `START`."""
    rows = ["<trk><name>synthetic</name><trkseg>"]
    for (latitude, longitude, height), second in zip(on_earth(place, slope_angle=slope_angle), time, strict=True):
        stamp = (START + timedelta(seconds=float(second))).isoformat(timespec="milliseconds").replace("+00:00", "Z")
        rows.append(
            f'<trkpt lat="{latitude:.9f}" lon="{longitude:.9f}"><ele>{height:.3f}</ele><time>{stamp}</time></trkpt>'
        )
    return _gpx_document([*rows, "</trkseg></trk>"])


def _gpx_document(rows: list[str]) -> str:
    """GPX text around its rows."""
    head = '<gpx version="1.1" creator="skisnow, synthetic" xmlns="http://www.topografix.com/GPX/1/1">'
    return "\n".join(['<?xml version="1.0" encoding="UTF-8"?>', head, *rows, "</gpx>", ""])


_SAMPLE_MM: Final = 0.004
_FORCE_OF_COUNT_N: Final = 0.0025
_HEADER_BYTES: Final = 512


def sample_pit() -> SnowPit:
    """Pit of a groomed piste, with layers, densities and temperatures."""
    return SnowPit(
        name="synthetic pit",
        time="2026-02-03T09:10:00+01:00",
        comment="synthetic",
        country="AT",
        latitude_deg=ORIGIN.latitude_deg,
        longitude_deg=ORIGIN.longitude_deg,
        elevation=ORIGIN.height,
        aspect="SE",
        slope_angle_deg=12.0,
        snow_height=1.25,
        air_temperature_C=-4.5,
        layers=(SnowLayer(0.0, 0.12, "K-", "MFpc", 0.75e-3), SnowLayer(0.12, 0.3, "P+", "RGsr", 0.5e-3)),
        densities=(LayerDensity(0.0, 512.5, 0.1), LayerDensity(0.2, 430.0, 0.1)),
        temperatures=(DepthTemperature(0.0, -7.25), DepthTemperature(0.1, -5.5), DepthTemperature(0.4, -3.0)),
    )


def weather_smet(random: np.random.Generator) -> str:
    """SMET 1.1 of two days of a weather station, a row each hour at UTC+1."""
    hours = np.arange(0.0, 48.0)
    day = np.cos(2.0 * np.pi * (hours - 13.0) / 24.0)
    fields = {
        "TA": 268.0 + 4.0 * day + 0.3 * random.standard_normal(len(hours)),
        "RH": np.clip(0.7 - 0.1 * day, 0.0, 1.0),
        "TSS": 265.0 + 5.0 * day,
        "ISWR": np.clip(500.0 * day, 0.0, None),
    }
    lines = ["SMET 1.1 ASCII", "[HEADER]", "station_id = syntheticstation", "station_name = synthetic station"]
    lines += [f"latitude = {ORIGIN.latitude_deg}", f"longitude = {ORIGIN.longitude_deg}"]
    lines += [f"altitude = {ORIGIN.height:g}", "nodata = -999", "tz = 1"]
    lines += [f"fields = timestamp {' '.join(fields)}", "[DATA]"]
    first = datetime(START.year, START.month, START.day, 1)
    for hour, values in enumerate(zip(*(column.tolist() for column in fields.values()), strict=True)):
        when = (first + timedelta(hours=hour)).isoformat()
        lines.append(" ".join((when, *(f"{value:.10g}" for value in values))))
    return "\n".join((*lines, ""))


def snow_micro_pen_recording(random: np.random.Generator) -> bytes:
    """Recording in the instrument's binary format: 30 mm of air, then snow whose mean force grows with depth."""
    snow = np.linspace(1.5, 4.0, round(120.0 / _SAMPLE_MM)) * random.uniform(0.8, 1.2, round(120.0 / _SAMPLE_MM))
    force = np.concatenate([np.full(round(30.0 / _SAMPLE_MM), 0.02), snow])
    counts = np.round(force / _FORCE_OF_COUNT_N).astype(">i2")
    header = bytearray(_HEADER_BYTES)
    struct.pack_into(">hi3fh", header, 0, 301, len(counts), _SAMPLE_MM, _FORCE_OF_COUNT_N, 0.0, 0)
    struct.pack_into(">6h", header, 20, *START.timetuple()[:6])
    struct.pack_into(">f", header, 64, 20.0)
    struct.pack_into(">h102s", header, 152, 9, b"synthetic")
    place = (ORIGIN.latitude_deg, ORIGIN.longitude_deg, ORIGIN.height * 100.0, 1.0)
    struct.pack_into(">8s4f2s2h", header, 256, b"SYNTH001", *place, b"NE", 8, 3)
    struct.pack_into(">2i", header, 358, len(counts), 0)
    struct.pack_into(">ih2s2h", header, 376, 5000, 40, b"  ", 1, 1236)
    struct.pack_into(">20s20s", header, 392, b"synthetic", b"synthetic")
    body = counts.tobytes()
    return bytes(header) + body + b"\xff" * (-len(body) % _HEADER_BYTES)


MASS, DRAG_AREA, FRICTION, AIR_DENSITY = 80.0, 0.42, 0.03, 1.2
"""kg, m², 1, kg/m³."""
_STATIONS: Final = np.array([5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 80.0])
_TIME_SD_S: Final = 0.002


def photo_cell_times(random: np.random.Generator) -> str:
    """CSV of two glides on 10°, from 2 and 4 m/s, past seven photo cells."""
    rows = ["run,station_m,time_s,time_sd_s"]
    for run, speed in (("glide 1", 2.0), ("glide 2", 4.0)):
        times = glide_time(_STATIONS, speed=speed, slope_angle=10.0 * DEGREE)
        times += _TIME_SD_S * random.standard_normal(len(times))
        rows += [
            f"{run},{station:g},{time:.4f},{_TIME_SD_S:g}"
            for station, time in zip(_STATIONS.tolist(), times.tolist(), strict=True)
        ]
    return "\n".join((*rows, ""))


def glide_time(station: FloatArray, *, speed: float, slope_angle: float) -> FloatArray:
    """Times (s) at distances (m) from a start below the terminal speed, with Coulomb friction and quadratic drag.

    With v∞² = a/k, a = g (sin α − μ cos α), k = ρ C_dA/(2 m) the speed is v∞ tanh φ, φ grows by k v∞ per second, and
    the distance is ln(cosh φ/cosh φ₀)/k.
    """
    acceleration = STANDARD_GRAVITY * (np.sin(slope_angle) - FRICTION * np.cos(slope_angle))
    drag = 0.5 * AIR_DENSITY * DRAG_AREA / MASS
    terminal = np.sqrt(acceleration / drag)
    start = np.arctanh(speed / terminal)
    return np.asarray((np.arccosh(np.cosh(start) * np.exp(drag * station)) - start) / (drag * terminal))


CAMPAIGN: Final = "campaign"
LAST: Final = "README.txt"


def write_samples(folder: str | Path, *, seed: int = 1) -> list[Path]:
    """Write synthetic sample files: a campaign, tracks, gates, photo-cell times, pits, studies.

    folder: new or empty folder.
    seed: seed of the random numbers, 0 or more.
    Returns: the files, sorted by path.
    Raises OutputError: the folder is not empty or cannot be written.

    Notes
    -----
    All files are synthetic. No value in them was measured.
    """
    folder = Path(folder)
    if folder.exists() and any(folder.iterdir()):
        raise OutputError("{folder} is not empty. Give a new or an empty folder.").tag("wrong_kind", folder=folder)
    require_writable(folder)
    with staged(folder, last=LAST) as stage:
        for name, content in _contents(np.random.default_rng(seed)):
            write_file(stage.path / name, content)
        write_reference(stage.path / CAMPAIGN, seed=seed)
    return sorted(path for path in folder.rglob("*") if path.is_file())


def _contents(random: np.random.Generator) -> Iterator[tuple[str, str | bytes]]:
    """Path in the folder and content of each sample file, without those of the reference campaign."""
    with as_file(files(__package__) / "files") as shipped:
        for path in sorted(path for path in shipped.rglob("*") if path.is_file()):
            yield path.relative_to(shipped).as_posix(), path.read_bytes()
    yield "day.gpx", touring_day(random)
    yield "run.gpx", gates_track(random)
    yield "course.gpx", course_waypoints()
    yield "cells.csv", photo_cell_times(random)
    yield from run_samples(random)
    yield "pit.caaml", caaml_text(sample_pit())
    yield "weather.smet", weather_smet(random)
    yield "snow_micro_pen.PNT", snow_micro_pen_recording(random)


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
    scenario = load_scenario(SCENARIO, changes={"solver.method": "fast"})
    usual = simulate(scenario)
    other = simulate(scenario.with_(speed_m_per_s=8.1, heading_deg=-25.0, mass_kg=95.0))
    mine = (files("skisnow.scenario") / "catalogue" / f"{SCENARIO}.toml").read_text("utf-8") + _MINE
    yield "mine.toml", mine
    yield "two-runs.toml", mine + _SECOND_RUN
    place = usual.place[::_EVERY] + _NOISE_M * random.standard_normal(usual.place[::_EVERY].shape)
    rows = np.column_stack([usual.time[::_EVERY], place]).tolist()
    lines = ["time_s,x_m,y_m,z_m", *(",".join(f"{value:.3f}" for value in row) for row in rows)]
    yield "measured.csv", "\n".join([*lines, ""])
    yield "measured.gpx", _track_gpx(usual, random)
    yield "run-1.gpx", _track_gpx(usual, random)
    yield "run-2.gpx", _track_gpx(other, random)


def _track_gpx(run: Run, random: np.random.Generator) -> str:
    """GPX text of a run's track on a plane slope, thinned out and with drawn noise."""
    slope = run.scenario.slope
    assert isinstance(slope, Plane)
    place = run.place[::_EVERY] + _NOISE_M * random.standard_normal(run.place[::_EVERY].shape)
    return gpx_track(place, run.time[::_EVERY], slope_angle=slope.angle)
