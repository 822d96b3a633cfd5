"""One leg drawn up.

A sledge glides straight on level snow without friction, and its left boot is drawn up
by 8 cm, as a skier flexes a leg; the skis stay flat. The sledge leans to the left, and
the left ski takes more of the load: the weight passes nearer to it.

Figure: lean over time; below, the force on each boot along the slope's normal, and that
of statics on the left one as a dashed line.
Known from: statics: with stance s and height h of the centre of mass the lean θ is
atan(0.08/s), and the left boot bears m g (s/2 + h tan θ)/(s + 0.08 tan θ).
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import skisnow

STANCE, HEIGHT, UP, SECONDS = 0.5, 0.6, 0.08, 1.0


def legs(moment: skisnow.BootMoment) -> list[skisnow.BootPose]:
    """The left boot goes up by half a cosine; both tilt against the lean."""
    phase = math.pi * min(moment.until / SECONDS, 1.0)
    up = UP * (1.0 - math.cos(phase)) / 2
    places = ([0, STANCE / 2, up], [0, -STANCE / 2, 0])
    poses = [skisnow.BootPose.of(place, -math.atan2(up, STANCE)) for place in places]
    poses[0].velocity[2] = rate = UP * math.pi / SECONDS * math.sin(phase) / 2
    for pose in poses:
        pose.turning[0] = rate * STANCE / (STANCE**2 + up**2)
    return poses


level = dict.fromkeys(("angle_deg", "heading_deg", "edge_angle_deg", "mu_0"), 0.0)
glide = skisnow.load_scenario("carved-46m").with_(
    **level, drag_area_m2=0.0, centre_of_mass_height_m=HEIGHT, duration_s=2.0
)
run = skisnow.simulate(glide, boots=legs)
lean = np.degrees(np.arcsin(run.attitude[:, 1, 2]))
assert run.boots is not None
bears = run.boots.force[:, :, 2]
found = float(bears[run.time > 1.5, 0].mean())

rise = UP / STANCE
known = math.degrees(math.atan(rise))
left = glide.sledge.mass * 9.81 * (STANCE / 2 + HEIGHT * rise) / (STANCE + UP * rise)
print(f"lean {lean[-1]:.2f}°, statics {known:.2f}°")
print(f"left boot {found:.0f} N, statics {left:.0f} N")

figure, (upper, lower) = plt.subplots(2, sharex=True)
upper.plot(run.time, lean)
upper.set(ylabel="lean to the left (°)")
lower.plot(run.time, bears, label=["left boot", "right boot"])
lower.axhline(left, linestyle="--", linewidth=0.8, label="left boot, statics")
lower.set(xlabel="time (s)", ylabel="force (N)", ylim=(0, None))
lower.legend()
figure.savefig("one_leg_drawn_up.png")
