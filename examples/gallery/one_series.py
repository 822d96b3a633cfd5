"""One series, one hardness.

Seven weights press an edged piece of ski into the snow, and a gauge reads how deep it
goes. The snow hardness H_V is the largest load divided by the volume that the tool
displaces there. Two small files are all that is needed.

Figure: load against penetration depth of the seven readings, and F = H_V V through the
last one.
Known from: by hand with Eqns 1 and 2 of Mössner and others (2013): 492 N over 200 mm ·
(7 mm)²/2 = 4900 mm³.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import skisnow
from skisnow.geometry import SkiPiece

load = np.array([12, 92, 172, 252, 332, 412, 492])  # N
depth = np.array([1.05, 3.02, 4.18, 4.99, 5.77, 6.38, 7.00])  # mm

campaign = Path("one-series")
campaign.mkdir()
(campaign / "campaign.toml").write_text(
    'name = "one series"\n[[tool]]\nname = "ski piece"\n'
    'shape = "ski"\nlength_mm = 200\nwidth_mm = 62\n'
)
rows = [f"P1,slope,ski piece,45,{F},{e}" for F, e in zip(load, depth, strict=True)]
(campaign / "penetration.csv").write_text(
    "\n".join(["experiment,site,tool,edge_angle_deg,load_N,depth_mm", *rows])
)

analysis = skisnow.analyse(campaign, n_resamples=100)
hardness = analysis.results["penetration"]["experiments"][0]["H_V_N_per_mm3"]
print(f"H_V = {hardness:.4f} N/mm³")

along = np.linspace(0.0, 7.5, 200)
volume = SkiPiece(length=0.2, width=0.062).displaced_volume(
    1e-3 * along, np.pi / 4
)  # m³
figure, axes = plt.subplots()
axes.plot(depth, load, "o", label="read from the gauge")
axes.plot(
    along, hardness * 1e9 * volume, label=f"F = H_V V with H_V = {hardness:.3f} N/mm³"
)
axes.set(
    xlabel="penetration depth e (mm)",
    ylabel="load F (N)",
    xlim=(0, None),
    ylim=(0, None),
)
axes.legend()
figure.savefig("one_series.png")
