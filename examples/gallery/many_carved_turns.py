"""Two hundred carved turns in one table.

A study asks one question over a grid or a sample of its inputs. This one spreads two
hundred points evenly over edge angle, load and both snow parameters, and asks each
whether the snow holds the ski. One bad point never stops it.

Figure: share of the shear strength in use over the edge angle; above 1 the ski slips.
Colour: the failure shear stress.
Known from: statics: the side force of every row is its load times tan ϑ.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import skisnow

QUESTION = """
out = "sample.csv"
[fixed]
ski = "slalom"
unloading_ratio = 10
[latin_hypercube]
n = 200
seed = 1
edge_angle_deg = { from = 10, to = 70 }
load_N = { from = 300, to = 1500 }
H_V_N_per_mm3 = { from = 0.05, to = 2, log = true }
S_f_N_per_mm2 = { from = 0.04, to = 0.5 }
"""
Path("sample.toml").write_text(QUESTION)
table = skisnow.study(skisnow.read_study("sample.toml"), workers=1)
print({outcome: count for outcome, count in table.counts().items() if count})

rows = [row for row in table.rows if row["side_force_N"] is not None]
names = (
    "edge_angle_deg",
    "load_N",
    "side_force_N",
    "side_force_limit_N",
    "S_f_N_per_mm2",
)
columns = [np.array([row[name] for row in rows], float) for name in names]
angle, load, force, limit, strength = columns
worst = float(np.max(np.abs(force / (load * np.tan(np.radians(angle))) - 1)))
print(f"side force over load · tan ϑ: 1 to within {worst:.1e}")

figure, axes = plt.subplots()
points = axes.scatter(angle, force / limit, c=strength, s=14)
axes.axhline(1.0, color="black", linewidth=0.8)
axes.set(
    xlabel="edge angle (°)", ylabel="side force over what the snow holds", yscale="log"
)
figure.colorbar(points, label="S_f (N/mm²)")
figure.savefig("many_carved_turns.png")
