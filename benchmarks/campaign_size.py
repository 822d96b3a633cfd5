"""A campaign of a million readings, read, screened, fitted and reported in a process of its own."""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from .timing import Measurement, timed

LOADS_N = np.linspace(12.0, 492.0, 7)


def write_large_campaign(folder: Path, n_rows: int) -> None:
    """F = H_V V with lognormal H_V at 20 sites, angles 30, 45, 60°, gauge 0.01 mm; seed 1."""
    rng = np.random.default_rng(1)
    m = n_rows // 7
    H_V, angle, site = np.exp(rng.normal(-1.0, 0.8, m)), rng.choice([30, 45, 60], m), rng.integers(0, 20, m)
    density = rng.normal(520.0, 40.0, 20)
    tangent = np.tan(np.radians(angle))
    depth = np.sqrt(2.0 * LOADS_N * tangent[:, None] / (H_V[:, None] * 200.0)) * np.exp(rng.normal(0, 0.02, (m, 1)))
    rows = [
        f"p{i},site {site[i]},ski piece,{angle[i]},{load:g},{e:.2f}\n"
        for i in range(m)
        for load, e in zip(LOADS_N, depth[i], strict=True)
    ]
    folder.mkdir(parents=True)
    header = "experiment,site,tool,edge_angle_deg,load_N,depth_mm\n"
    (folder / "penetration.csv").write_text(header + "".join(rows), encoding="utf-8")
    samples = "".join(f"d{i},site {i},{density[i]:.1f}\n" for i in range(20))
    (folder / "density.csv").write_text("sample,site,snow_density_kg_per_m3\n" + samples, encoding="utf-8")
    tool = '[[tool]]\nname = "ski piece"\nshape = "ski"\nlength_mm = 200\nwidth_mm = 62\n'
    (folder / "campaign.toml").write_text(
        f'name = "large, synthetic"\ngauge_resolution_mm = 0.01\nload_uncertainty_N = 0.5\n{tool}', encoding="utf-8"
    )


def measure(n_rows: int) -> Iterator[Measurement]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_large_campaign(folder / "campaign", n_rows)
        words = ["-m", "skisnow", "analyse", str(folder / "campaign"), "--out", str(folder / "out")]
        seconds = timed(lambda: subprocess.run([sys.executable, *words], check=True, capture_output=True))
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024.0
    yield Measurement(f"{n_rows} readings to the report, peak {peak:.0f} MB", seconds, "< 20 s, 1.5 GB")
