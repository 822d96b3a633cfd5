"""An edge lets go.

Push an edged ski across its edge: the snow takes up force over half a millimetre, then
fails, and the edge slips at a force that stays. It is the failure shear stress times
the length and the depth of the edge, whatever the way.

Figure: side force over the way across, for three depths of the edge, with S_f L e as
dashed lines.
Known from: Eqn 9 of Mössner and others (2013): S_f L e = 0.3 N/mm² · 1600 mm · 2 mm =
960 N.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import skisnow

LENGTH, HALF, STRESS, ANGLE = 1.6, 0.03, 0.3e6, math.radians(45.0)
board = skisnow.Runner(
    np.array([LENGTH / 2, -LENGTH / 2]), np.full(2, HALF), np.zeros(2)
)
s, c = math.sin(ANGLE), math.cos(ANGLE)
edged = np.array(
    [[[1, 0, 0], [0, c, s], [0, -s, c]]]
)  # columns: ahead, left, off the base

figure, axes = plt.subplots()
held = {}
for depth in (1e-3, 2e-3, 3e-3):
    contact = skisnow.SnowContact(skisnow.SnowField(2e8, STRESS, 10.0), [board])
    height = HALF * s - depth
    contact.update([[0.0, 0.0, height]], edged, 0.0)
    across, force = 1e-3 * np.linspace(0.0, 1.5, 151), []
    for way in across:  # to the left: the base pushes the snow before it
        found = contact.force([[0.0, way, height]], edged, np.zeros((1, 6)), 1e-3)
        force.append(-float(found.wrench[0, 1]))
    held[depth] = force[-1]
    [line] = axes.plot(1e3 * across, force, label=f"{1e3 * depth:g} mm deep")
    axes.axhline(
        STRESS * LENGTH * depth, linestyle="--", color=line.get_color(), linewidth=0.8
    )
axes.set(
    xlabel="way across the edge (mm)",
    ylabel="side force (N)",
    xlim=(0, 1.5),
    ylim=(0, None),
)
axes.legend()
print(f"2 mm deep: {held[2e-3]:.1f} N; 3 mm hold {held[3e-3] / held[1e-3]:.3f} × 1 mm")
figure.savefig("edge_lets_go.png")
