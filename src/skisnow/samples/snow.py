"""Synthetic snow samples: a pit in CAAML, densities, weather in SMET, and a SnowMicroPen recording."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Final

import numpy as np

from ..campaign.smet import StationSeries
from ..campaign.snow_pit import DepthTemperature, LayerDensity, SnowLayer, SnowPit
from ..interop.caaml import caaml_text
from ..interop.smet import smet_text
from .tracks import ORIGIN, START

if TYPE_CHECKING:
    from collections.abc import Iterator

_SAMPLE_MM: Final = 0.004
_FORCE_OF_COUNT_N: Final = 0.0025
_HEADER_BYTES: Final = 512


def snow_samples(random: np.random.Generator) -> Iterator[tuple[str, str | bytes]]:
    """Name and content of each snow sample."""
    yield "pit.caaml", caaml_text(sample_pit())
    yield "densities.csv", _densities(random)
    yield "weather.smet", smet_text(_weather(random))
    yield "snow_micro_pen.PNT", snow_micro_pen_recording(random)


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


def _densities(random: np.random.Generator) -> str:
    """CSV of density-cutter samples of two pits, with heights in cm above the ground."""
    rows = ["ID,TOP,BOTTOM,RHO,NOTES,TYPE"]
    for pit in ("P1", "P2"):
        rows += [f"{pit},{top},{top - 10},{random.normal(450.0, 20.0):.1f},-9999,N" for top in range(120, 80, -10)]
    return "\n".join((*rows, ""))


def _weather(random: np.random.Generator) -> StationSeries:
    hours = np.arange(0.0, 48.0)
    day = np.cos(2.0 * np.pi * (hours - 13.0) / 24.0)
    fields = {
        "TA": 268.0 + 4.0 * day + 0.3 * random.standard_normal(len(hours)),
        "RH": np.clip(0.7 - 0.1 * day, 0.0, 1.0),
        "TSS": 265.0 + 5.0 * day,
        "ISWR": np.clip(500.0 * day, 0.0, None),
    }
    latitude, longitude, altitude = ORIGIN.latitude_deg, ORIGIN.longitude_deg, ORIGIN.height
    time = START.timestamp() // 86400.0 * 86400.0 + 3600.0 * hours
    return StationSeries("weather.smet", "synthetic station", latitude, longitude, altitude, 1.0, time, fields)


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
