"""Over a roll.

A slope need not be a plane: a measured profile of heights is one, too. Here a sledge
glides without friction and drag over a long roll. On snow that gives back what it
takes, height becomes speed and speed height, and nothing else.

Figure: height of the profile over the way, and the speed beside that of a point that
slides without loss.
Known from: conservation of energy: v² = v_0² + 2 g (z_0 - z).
"""

import matplotlib.pyplot as plt
import numpy as np

import skisnow

x = np.arange(0.0, 61.0, 0.5)
height = -0.1 * x + 0.4 * np.cos(2 * np.pi * x / 30.0)
turn = skisnow.load_scenario("carved-46m").with_(
    slope=skisnow.Profile(x, height),
    x_m=3.0,
    speed_m_per_s=5.0,
    heading_deg=0.0,
    edge_angle_deg=0.0,
    mu_0=0.0,
    drag_area_m2=0.0,
    unloading_ratio=1.0,
    duration_s=6.0,
)
run = skisnow.simulate(turn)

way, climb = run.place[:, 0], run.place[:, 2]
exact = np.sqrt(run.speed[0] ** 2 + 2 * 9.81 * (climb[0] - climb))
off = float(np.max(np.abs(run.speed - exact)))
print(f"{run.speed[0]:.2f} to {run.speed[-1]:.2f} m/s, at most {off:.3f} off the point")

figure, (upper, lower) = plt.subplots(2, sharex=True)
upper.plot(x, height)
upper.set(ylabel="height (m)")
lower.plot(way, run.speed, label="simulated")
lower.plot(way[::40], exact[::40], ".", color="black", label="without loss")
lower.set(xlabel="horizontal distance (m)", ylabel="speed (m/s)", ylim=(0, None))
lower.legend()
figure.savefig("over_a_roll.png")
