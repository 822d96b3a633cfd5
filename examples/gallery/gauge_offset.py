"""A gauge that does not start at zero.

If the gauge reads 0.3 mm when the tool only touches, every depth of the series is wrong
by that much, and the hardness of a flat tool with it. The seven readings together tell
the offset: the line through them misses the origin.

Figure: loads and depths as read, the line through them and where it meets zero load,
and the hardness with both readings.
Known from: the snow is made up: 0.10 N/mm³ under a flat tool, so that each depth is
F/(H_V L W), plus 0.3 mm.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import skisnow

load = np.array([12, 92, 172, 252, 332, 412, 492])  # N
depth = load / (0.10 * 200 * 62) + 0.30  # mm, as read

campaign = Path("offset")
campaign.mkdir()
(campaign / "campaign.toml").write_text(
    'name = "offset"\ngauge_resolution_mm = 0.01\n'
    '[[tool]]\nname = "ski piece"\nshape = "ski"\nlength_mm = 200\nwidth_mm = 62\n'
)
rows = [f"P1,slope,ski piece,0,{F},{e:.4f}" for F, e in zip(load, depth, strict=True)]
(campaign / "penetration.csv").write_text(
    "\n".join(["experiment,site,tool,edge_angle_deg,load_N,depth_mm", *rows])
)

penetration = skisnow.analyse(campaign, n_resamples=100).results["penetration"]
offset = penetration["seating"][0]["depth_offset_mm"]
as_read = penetration["experiments"][0]["H_V_N_per_mm3"]
corrected = as_read * (1 + penetration["seating"][0]["H_V_change_percent"] / 100)
print(
    f"offset {offset:.3f} mm; H_V {as_read:.4f} N/mm³ as read, {corrected:.4f} without"
)

figure, axes = plt.subplots()
axes.plot(depth, load, "o", label="as read")
axes.plot(
    [offset, depth[-1]],
    [0, load[-1]],
    label=f"offset {offset:.2f} mm: H_V {corrected:.3f} N/mm³",
)
axes.plot(
    [0, depth[-1]],
    [0, load[-1]],
    "--",
    label=f"through the origin: H_V {as_read:.3f} N/mm³",
)
axes.set(
    xlabel="depth on the gauge (mm)", ylabel="load (N)", xlim=(0, None), ylim=(0, None)
)
axes.legend()
figure.savefig("gauge_offset.png")
