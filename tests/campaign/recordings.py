"""Recordings of a SnowMicroPen that tests build, and the two real ones."""

import struct
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

RECORDINGS = Path(__file__).resolve().parents[3] / "shared" / "data" / "smp"
LONG = "SNEX20_SMP_S19M1260_2S16_20200208.PNT"
SHORT = "SNEX20_SMP_S19M1285_1S17_20200208.PNT"
STEP_MM = 0.004
NEWTON = 0.0025
"""Distance of the samples and force of a count, in the recordings that are built."""
AIR_N = 0.05


def recording(name: str) -> Path:
    path = RECORDINGS / name
    if not path.exists():
        pytest.skip(f"{name}: the shared recordings are not beside this repository")
    return path


def built(
    counts: npt.ArrayLike, *, north_east: bytes = b"SE", clock: tuple[int, ...] = (2019, 3, 2, 11, 30, 59)
) -> bytes:
    """Write a recording field by field, at the offsets of the format."""
    samples = np.asarray(counts, dtype=">i2")
    data = bytearray(512)
    struct.pack_into(">hi3fh", data, 0, 301, len(samples) + 5, STEP_MM, NEWTON, 0.0, 7)
    struct.pack_into(">6h", data, 20, *clock)
    struct.pack_into(">f", data, 64, 20.0)
    struct.pack_into(">h102s", data, 152, 9, b"near hut!and filling")
    struct.pack_into(">8s4f2s2h", data, 256, b"S31M0067", 45.5, 170.25, 212000.0, 1.5, north_east, 8, 3)
    struct.pack_into(">2i", data, 358, len(samples), 0)
    struct.pack_into(">ih2s2h", data, 376, 5000, 40, b"??", 31, 1236)
    struct.pack_into(">20s20s", data, 392, b"1234 SN5\0>>>>>", b"AMP 6\0?????")
    body = samples.tobytes()
    return bytes(data) + body + b"\xff" * (512 - len(body) % 512)


def plain_snow(mean_force: float, *, air_mm: float = 30.0, snow_mm: float = 60.0, seed: int = 1) -> bytes:
    """Air, then a force that scatters evenly by a tenth about its mean; about, for the format counts in steps."""
    scatter = np.random.default_rng(seed).uniform(0.9, 1.1, round(snow_mm / STEP_MM))
    snow = mean_force * scatter / scatter.mean()
    force = np.concatenate((np.full(round(air_mm / STEP_MM), AIR_N), snow))
    return built(np.round(force / NEWTON))
