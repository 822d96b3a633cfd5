"""Flat or edged: how the load grows with the depth.

In snow whose resistance is its hardness times the displaced volume, a flat tool meets a
load that grows in proportion to its depth. Put on its edge it is a wedge: depth and
contact grow together, and the load grows with the square.

Figure: load against penetration depth for five edge angles on one snow.
Known from: Eqns 2 and 3 of Mössner and others (2013): at 45° and 10 mm, V = 200 mm ·
(10 mm)²/2, so 0.04 N/mm³ bear 400 N.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

from skisnow.forces.penetration import VolumeLaw
from skisnow.geometry import SkiPiece

tool = SkiPiece(length=0.2, width=0.062)
snow = VolumeLaw(snow_hardness=0.04e9)  # N/m³: fresh snow on a slope
depth = np.linspace(0.0, 0.010, 101)

figure, axes = plt.subplots()
for degrees in (0, 15, 30, 45, 60):
    axes.plot(
        1e3 * depth,
        snow.reaction_force(tool, depth, math.radians(degrees)),
        label=f"{degrees}°",
    )
axes.set(xlabel="penetration depth (mm)", ylabel="load (N)", ylim=(0, 1500))
axes.legend(title="edge angle")

load = float(snow.reaction_force(tool, 0.010, math.radians(45)))
half = float(snow.reaction_force(tool, 0.005, math.radians(45)))
print(f"45°, 10 mm: {load:.1f} N; at half the depth {half / load:.2f} of it")
figure.savefig("flat_or_edged.png")
