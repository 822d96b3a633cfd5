"""A ski for a radius of 12 m.

The slalom ski carves 10.3 m at 45° and 800 N on the race piste. Sidecut and stiffness
may change; skisnow searches for the smallest change that makes 12 m. The design is
written to a ski file, and the file is carved again.

Figure: width of both skis along their length, and turn radius over the edge angle.
Known from: the target of 12 m, met by a carve of the written file.
"""

import math
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import skisnow

turn = {
    "published": "race-piste",
    "unloading_ratio": 10,
    "edge_angle_deg": 45,
    "load_N": 800,
}
task = {
    "ski": "slalom",
    "variables": {"sidecut_mm": [-10, 10], "EI_factor": [0.6, 1.6]},
    "conditions": [turn],
    "goals": [{"output": "turn_radius_boot_m", "target": 12.0}],
    "starts": 2,
}
file = skisnow.design_ski(task).write(Path())[0]
skis = {"slalom": skisnow.read_ski("slalom"), "12 m": skisnow.read_ski(file)}
snow = skisnow.load_snow("race-piste")


def radius(ski: skisnow.Ski, degrees: float) -> float:
    """Turn radius at the boot (m)."""
    angle = math.radians(degrees)
    found = skisnow.carve(ski, snow, edge_angle=angle, load=800.0, unloading_ratio=10)
    return found.turn_radius_boot or math.nan


confirmed = radius(skis["12 m"], 45.0)
print(f"{radius(skis['slalom'], 45.0):.2f} m before, {confirmed:.6f} m from the file")

figure, (upper, lower) = plt.subplots(2, figsize=(6.4, 5.4))
angles = np.arange(20, 66, 5)
for name, ski in skis.items():
    upper.plot(ski.station, 1e3 * ski.width, label=name)
    lower.plot(angles, [radius(ski, float(angle)) for angle in angles], "o-")
lower.plot(45.0, 12.0, "k+", markersize=14)
upper.set(xlabel="distance in front of the boot (m)", ylabel="width (mm)")
lower.set(xlabel="edge angle (°)", ylabel="turn radius (m)", ylim=(0, None))
upper.legend()
figure.savefig("twelve_metres.png")
