"""A ski for three snows.

Snow differs from day to day. One ski is designed for 12 m on the middle snow, the other
for the smallest worst deviation from 12 m on all three.

Figure: turn radius of both designs over the hardness of the snow.
Known from: the best worst case, which is too short on the softest snow by as much as it
is too long on the hardest.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import skisnow

SNOWS = (0.08, 0.21, 0.55)  # H_V in N/mm³
TURN = {"S_f_N_per_mm2": 0.52, "unloading_ratio": 10, "edge_angle_deg": 45}


def designed(snows: tuple[float, ...]) -> skisnow.Ski:
    """Ski with the smallest worst deviation from 12 m."""
    task = {
        "ski": "slalom",
        "variables": {"sidecut_mm": [-10, 10], "EI_factor": [0.6, 1.6]},
        "conditions": [
            {**TURN, "load_N": 800, "H_V_N_per_mm3": hardness} for hardness in snows
        ],
        "goals": [{"output": "turn_radius_boot_m", "target": 12.0, "over": "worst"}],
        "starts": 2,
    }
    return skisnow.design_ski(task).ski


def radius(ski: skisnow.Ski, hardness: float) -> float:
    """Turn radius at the boot (m)."""
    snow = skisnow.SnowProperties(1e9 * hardness, 0.52e6, "example", unloading_ratio=10)
    carve = skisnow.carve(ski, snow, edge_angle=math.pi / 4, load=800.0)
    return carve.turn_radius_boot or math.nan


skis = {"one snow": designed(SNOWS[1:2]), "three snows": designed(SNOWS)}
worst = {}
for name, ski in skis.items():
    radii = [radius(ski, hardness) for hardness in SNOWS]
    worst[name] = max(abs(each - 12.0) for each in radii)
    print(f"{name}: {', '.join(f'{each:.3f}' for each in radii)} m")

figure, axes = plt.subplots()
hardness = np.geomspace(0.05, 0.9, 12)
for name, ski in skis.items():
    axes.semilogx(hardness, [radius(ski, each) for each in hardness], "o-", label=name)
axes.axhline(12.0, color="black", linewidth=0.8)
axes.plot(SNOWS, [12.0] * len(SNOWS), "k|", markersize=14)
axes.set(xlabel="snow hardness H_V (N/mm³)", ylabel="turn radius (m)")
axes.legend()
figure.savefig("robust_ski.png")
