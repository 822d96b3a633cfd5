"""Synthetic photo-cell times of straight glides."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from .._support.units import DEGREE, STANDARD_GRAVITY

if TYPE_CHECKING:
    import numpy.typing as npt

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


def glide_time(station: npt.NDArray[np.float64], *, speed: float, slope_angle: float) -> npt.NDArray[np.float64]:
    """Times (s) at distances (m) from a start below the terminal speed, with Coulomb friction and quadratic drag.

    With v∞² = a/k, a = g (sin α − μ cos α), k = ρ C_dA/(2 m) the speed is v∞ tanh φ, φ grows by k v∞ per second, and
    the distance is ln(cosh φ/cosh φ₀)/k.
    """
    acceleration = STANDARD_GRAVITY * (np.sin(slope_angle) - FRICTION * np.cos(slope_angle))
    drag = 0.5 * AIR_DENSITY * DRAG_AREA / MASS
    terminal = np.sqrt(acceleration / drag)
    start = np.arctanh(speed / terminal)
    return np.asarray((np.arccosh(np.cosh(start) * np.exp(drag * station)) - start) / (drag * terminal))
