"""What do 2 mm more waist do?

The arc of a ski's edge comes from three widths. Two millimetres more in the middle make
the side line straighter, and the ski turns wider: on hard snow by about as much as its
sidecut radius grows.

Figure: turn radius over edge angle of a slalom ski as it is and with 2 mm more waist.
Known from: geometry: R = L²/(8 δ), δ = (tip + tail - 2 waist)/4, so R grows by δ/(δ - 1
mm).
"""

import math
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import skisnow

slalom = skisnow.read_ski("slalom")
along = np.clip(
    (slalom.station - slalom.sidecut_middle) / (slalom.sidecut_length / 2), -1.0, 1.0
)
wider = replace(slalom, name="2 mm more", width=slalom.width + 0.002 * (1.0 - along**2))

growth = wider.sidecut_radius_of_three_widths / slalom.sidecut_radius_of_three_widths
angles = np.arange(15, 61, 5)
radius: dict[str, list[float]] = {slalom.name: [], wider.name: []}
for ski in (slalom, wider):
    for angle in angles:
        answer = skisnow.carve(
            ski,
            skisnow.load_snow("glacier"),
            edge_angle=math.radians(angle),
            load=400.0,
            unloading_ratio=10.0,
        )
        radius[ski.name].append(answer.turn_radius_chord or math.nan)
carved = radius[wider.name][3] / radius[slalom.name][3]
print(f"sidecut radius {growth:.4f} times as large, turn at 30° {carved:.4f} times")

figure, axes = plt.subplots()
for name, values in radius.items():
    axes.plot(angles, values, "o-", label=name)
axes.set(xlabel="edge angle (°)", ylabel="turn radius (m)", ylim=(0, None))
axes.legend()
figure.savefig("more_waist.png")
