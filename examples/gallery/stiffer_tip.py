"""What does a stiffer tip do?

The bending stiffness in front of the binding grows by 10 %. The derivative of the
radius with the stiffness at each place, integrated over the change, predicts the new
radius to first order, without another carve.

Figure: derivative of the turn radius with the bending stiffness, and force along the
edge with both tips.
Known from: a carve of the stiffer ski; the rest is the curvature of the response.
"""

import math
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import skisnow

slalom, snow = skisnow.read_ski("slalom"), skisnow.load_snow("race-piste")
growth = 0.1 * np.clip((slalom.station - 0.15) / 0.3, 0.0, 1.0)
stiff = replace(
    slalom,
    name="stiffer tip",
    bending_stiffness=slalom.bending_stiffness * (1 + growth),
    keys=None,
)
carves = [
    skisnow.carve(ski, snow, edge_angle=math.pi / 4, load=800.0, unloading_ratio=10)
    for ski in (slalom, stiff)
]
field = carves[0].derivatives().fields("turn_radius_boot_m")
place, by_stiffness = field["beam_m"], field["EI_per_N_m3"]
added = np.interp(
    place, slalom.station[::-1], (growth * slalom.bending_stiffness)[::-1]
)
predicted = -np.trapezoid(by_stiffness * added, place)
carved = (carves[1].turn_radius_boot or 0.0) - (carves[0].turn_radius_boot or 0.0)
print(f"radius {1e3 * carved:+.1f} mm, predicted {1e3 * predicted:+.1f} mm")
force = [np.max(np.array(found.force_per_length, float)) for found in carves]
print(f"largest force along the edge {force[0]:.0f} N/m, then {force[1]:.0f} N/m")

figure, (upper, lower) = plt.subplots(2, sharex=True, figsize=(6.4, 5.4))
upper.plot(place, 1e3 * by_stiffness)
upper.set(ylabel="radius by EI\n(mm per N m² over 1 m)")
for ski, found in zip((slalom, stiff), carves, strict=True):
    lower.plot(found.station, found.force_per_length, label=ski.name)
lower.set(xlabel="distance in front of the boot (m)", ylabel="force per length (N/m)")
lower.legend()
figure.savefig("stiffer_tip.png")
