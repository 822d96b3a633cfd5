"""A skid that becomes a carve.

A sledge comes fast onto flat snow that is weak in shear, its skis tilted by 30°. The
turn that the skis would carve asks for more side force than the snow can give, so they
skid, on a much wider arc. Friction slows the sledge, the force falls with the square of
the speed, and from some speed on the snow holds: the skis carve.

Figure: turn radius and speed over time; the radius falls to that of the carved turn as
the speed falls.
Known from: geometry: the carved turn of a ski on its edge has about R_sc cos ϑ.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import skisnow

EDGE = 30.0
snow = skisnow.SnowProperties(
    0.2e9, 0.05e6, source="weak in shear", unloading_ratio=10.0
)
turn = skisnow.load_scenario("carved-46m").with_(
    snow=snow,
    angle_deg=0.0,
    heading_deg=0.0,
    speed_m_per_s=12.0,
    edge_angle_deg=EDGE,
    mu_0=0.25,  # brakes much, so that little time is enough
    drag_area_m2=0.0,
    duration_s=4.0,
)
run = skisnow.simulate(turn)

rule = turn.ski.sidecut_radius_of_three_widths * math.cos(math.radians(EDGE))
settled = (run.time > 2.6) & (run.time < 3.6)
carved = float(np.median(run.turn_radius[settled]))
skids = float(np.median(run.turn_radius[(run.time > 0.4) & (run.time < 1.0)]))
print(f"skids on {skids:.0f} m, carves on {carved:.1f} m; R_sc cos ϑ = {rule:.1f} m")

figure, (upper, lower) = plt.subplots(2, sharex=True)
started = run.time > 0.2
upper.plot(run.time[started], run.turn_radius[started])
upper.axhline(rule, color="black", linestyle="--", linewidth=0.8, label="R_sc cos ϑ")
upper.set(ylabel="turn radius (m)", ylim=(0, 80))
upper.legend()
lower.plot(run.time, run.speed)
lower.set(xlabel="time (s)", ylabel="speed (m/s)", ylim=(0, None))
figure.savefig("skid_to_carve.png")
