"""Straight down the fall line.

A sledge on two skis runs straight down 10° with friction and air drag. It speeds up,
ever more slowly, towards the speed at which drag and friction take all that the slope
gives. Newton's equation for a point has the same answer in closed form.

Figure: speed over time of the simulated sledge, and of the point mass as dots; the
final speed as a dashed line.
Known from: closed form: v = v_∞ tanh(artanh(v_0/v_∞) + t g (sin α - μ cos α)/v_∞).
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import skisnow

turn = skisnow.load_scenario("carved-46m").with_(
    heading_deg=0.0,
    edge_angle_deg=0.0,
    mu_0=0.05,
    speed_m_per_s=3.0,
    duration_s=8.0,
    unloading_ratio=1.0,
)
run = skisnow.simulate(turn)

slope, mass = math.radians(10.0), turn.sledge.mass + 2 * turn.ski.mass
pull = 9.81 * (math.sin(slope) - 0.05 * math.cos(slope))
final = math.sqrt(pull / (0.5 * turn.air.density * turn.air.drag_area / mass))
exact = final * np.tanh(np.arctanh(3.0 / final) + run.time * pull / final)
print(
    f"after {run.time[-1]:g} s {run.speed[-1]:.3f} m/s; point mass {exact[-1]:.3f} m/s"
)

figure, axes = plt.subplots()
axes.plot(run.time, run.speed, label="simulated")
axes.plot(run.time[::50], exact[::50], ".", color="black", label="point mass")
axes.axhline(final, linestyle="--", linewidth=0.8, label=f"final speed {final:.1f} m/s")
axes.set(xlabel="time (s)", ylabel="speed (m/s)", ylim=(0, None))
axes.legend()
figure.savefig("straight_glide.png")
