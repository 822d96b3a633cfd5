"""Ski forces on a measured skier: markers on the boots in, forces on the boots out, as files that OpenSim reads.

    python examples/forces_on_a_measured_skier.py [FOLDER]

No skier is at hand: a simulated run with two turns stands for one, so that what is found can be compared with what was.
Three markers on each boot are written as capture.trc, 200 frames a second, with noise as a camera has it. From there on
all goes as with a measured file: edge angles of the boots, smoothed, move the skis of a sledge of the skier's mass, and
forces.sto holds the forces on the boots.
"""

from __future__ import annotations

import argparse
import math
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.signal import savgol_filter

from skisnow import Run, load_scenario, simulate
from skisnow.interop.opensim import BootMarkers, Markers, boots_of_markers, boots_text, read_trc, write_trc
from skisnow.simulation.run_tables import write_boots

FloatArray = npt.NDArray[np.float64]
SLOPE, DURATION, FRAME_MS, SMOOTHED_S = math.radians(10.0), 3.0, 5.0, 0.15
EDGES = "time_s,left_edge_angle_deg,right_edge_angle_deg\n0,0,0\n1,20,20\n2,-20,-20\n3,-20,-20\n"
ON_BOOT = {"heel": (-0.15, 0.0, 0.05), "toe": (0.15, 0.0, 0.05), "left": (0.0, 0.06, 0.05)}  # ahead, left, up (m)
SOLE = (0.15, 0.0, -0.05)  # from the heel's marker
TO_LABORATORY = np.array(
    [[math.cos(SLOPE), 0.0, math.sin(SLOPE)], [-math.sin(SLOPE), 0.0, math.cos(SLOPE)], [0.0, -1.0, 0.0]]
)  # from the slope's axes to those with y straight up and z to the right


def run_of(folder: Path, edges: str) -> Run:
    """A sledge whose skis are edged as a table says."""
    (folder / "edges.csv").write_text(edges, encoding="utf-8")
    changes = {"boots.file": str(folder / "edges.csv"), "sledge.edge_angle_deg": 0.0, "start.heading_deg": 0.0}
    changes |= {"run.duration_s": DURATION, "run.output_ms": FRAME_MS}
    return simulate(load_scenario("carved-46m", changes=changes))


def capture(run: Run, noise: float) -> Markers:
    """What cameras with a noise (m) see of the boots."""
    assert run.boots is not None
    names, places = [], []
    for k, side in enumerate(("left", "right")):
        for name, at in ON_BOOT.items():
            names.append(f"{side}_{name}")
            places.append((run.boots.place[:, k] + np.array(at) @ run.boots.axes[:, k]) @ TO_LABORATORY.T)
    seen = np.stack(places, axis=1) + np.random.default_rng(1).normal(0.0, noise, (len(run.time), len(names), 3))
    return Markers(run.time, tuple(names), seen, 1e3 / FRAME_MS)


def forces_of(path: Path, folder: Path) -> Run:
    """From a capture to a run that tells the forces."""
    measured = read_trc(path)
    window = round(SMOOTHED_S * measured.rate) | 1
    smooth = replace(measured, place=savgol_filter(measured.place, window, 3, axis=0))
    left, right = (BootMarkers(f"{side}_heel", f"{side}_toe", f"{side}_left", SOLE) for side in ("left", "right"))
    boots = boots_of_markers(smooth, left, right, slope_angle=SLOPE)
    return run_of(folder, boots_text(boots, edge_angles_only=True))


def difference(found: Run, true: Run) -> tuple[float, float]:
    """Of the force along the normal on the more heavily loaded ski: of its mean, and root mean square; shares."""
    assert found.boots is not None and true.boots is not None
    late = true.time > 0.5  # the skis have swung into their groove
    one, other = (run.boots.force[late, :, 2].max(axis=1) for run in (found, true) if run.boots is not None)
    mean = float(other.mean())
    return float(one.mean()) / mean - 1.0, float(np.sqrt(np.mean((one - other) ** 2))) / mean


def main(folder: Path) -> list[tuple[float, float, float]]:
    """Noise (mm) and how far the forces are off."""
    true, rows = run_of(folder, EDGES), []
    for noise in (0.0, 0.5, 1.0, 2.0):
        write_trc(capture(true, 1e-3 * noise), folder / "capture.trc")
        found = forces_of(folder / "capture.trc", folder)
        write_boots(found, folder / "forces.sto")
        rows.append((noise, *difference(found, true)))
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", nargs="?", type=Path, help="where the files go; left out: nowhere")
    given = parser.parse_args().folder
    with tempfile.TemporaryDirectory() as temporary:
        (given or Path(temporary)).mkdir(parents=True, exist_ok=True)
        print("markers' noise (mm)   mean force off by (%)   root mean square off by (%)")
        for noise, mean, rms in main(given or Path(temporary)):
            print(f"{noise:19.1f} {100.0 * mean:23.1f} {100.0 * rms:29.1f}")
