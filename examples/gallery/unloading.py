"""Unloading: the snow keeps its groove.

Snow that is pressed and let go gives little back. Loading goes along the hardness H_V,
unloading along the steeper k_u, and where the stress is zero the groove is left. The
area between the two lines is the energy that the groove has cost.

Figure: stress over depth while a place on the snow is pressed, let go, and pressed
deeper, for three unloading ratios.
Known from: by hand: at 0.2 N/mm³ and k_u = 10 H_V, 10 mm leave 9 mm of groove and cost
½ · 0.2 · 10² · 0.9 = 9 N/mm.
"""

import matplotlib.pyplot as plt
import numpy as np

from skisnow.forces.penetration import HypoplasticPoint

down, up, deeper = (
    np.linspace(0, 10, 400),
    np.linspace(10, 0, 400),
    np.linspace(0, 13, 400),
)
path = 1e-3 * np.concatenate([down, up, deeper])  # m

figure, axes = plt.subplots()
lost = {}
for ratio in (1.0, 3.0, 10.0):  # k_u/H_V; 1 is elastic
    snow = HypoplasticPoint(snow_hardness=0.2e9, unloading_ratio=ratio)
    deepest = np.maximum.accumulate(path)
    stress = snow.stress(path, np.concatenate([[0.0], deepest[:-1]]))
    axes.plot(
        1e3 * path,
        1e-6 * stress,
        linewidth=5 / ratio**0.5,
        label=f"k_u/H_V = {ratio:g}",
    )
    there_and_back = slice(0, 800)
    lost[ratio] = float(np.trapezoid(stress[there_and_back], path[there_and_back]))
axes.set(xlabel="depth (mm)", ylabel="stress (N/mm²)", xlim=(0, 13.5), ylim=(0, None))
axes.legend()

groove = 1e3 * float(HypoplasticPoint(0.2e9, 10.0).residual_depth(0.010))
print(f"groove left: {groove:.2f} mm; energy between the lines: {lost[10.0]:.0f} J/m²")
figure.savefig("unloading.png")
