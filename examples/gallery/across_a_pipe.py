"""Across a pipe.

The snow may be any surface z(x, y), such as a grid of heights that a drone has
measured. This one has rollers down the slope and sides that rise like those of a
half-pipe. The sledge glides slantwise from one side to the other, without friction and
drag. On snow that gives back what it takes, height becomes speed, whatever way the
track takes; the edges lose a little, as the skis turn down the slope.

Figure: heights of the grid as lines of equal height with the track of the sledge over
them, and its speed beside that of a point that slides without loss.
Known from: conservation of energy: v² = v_0² + 2 g (z_0 - z).
"""

import matplotlib.pyplot as plt
import numpy as np

import skisnow

x, y = np.arange(0.0, 41.0, 0.5), np.arange(-7.0, 7.5, 0.5)
rollers = -0.15 * x + 0.25 * np.cos(2 * np.pi * x / 14.0)
height = np.add.outer(rollers, 0.02 * y**2)
turn = skisnow.load_scenario("carved-46m").with_(
    slope=skisnow.Terrain(x, y, height),
    x_m=3.0,
    y_m=-2.0,
    speed_m_per_s=6.0,
    heading_deg=12.0,
    edge_angle_deg=0.0,
    mu_0=0.0,
    drag_area_m2=0.0,
    unloading_ratio=1.0,
    duration_s=3.0,
)
run = skisnow.simulate(turn)

climb = run.place[:, 2]
exact = np.sqrt(run.speed[0] ** 2 + 2 * 9.81 * (climb[0] - climb))
off = float(np.max(np.abs(run.speed - exact)))
print(f"{run.speed[0]:.2f} to {run.speed[-1]:.2f} m/s, at most {off:.2f} off the point")

figure, (upper, lower) = plt.subplots(2, sharex=True, figsize=(6.4, 5.0))
upper.contour(
    x, y, height.T, levels=24, colors="0.7", linewidths=0.7, linestyles="solid"
)
upper.plot(run.place[:, 0], run.place[:, 1])
upper.set(ylabel="to the left (m)", aspect="equal")
lower.plot(run.place[:, 0], run.speed, label="simulated")
lower.plot(run.place[::25, 0], exact[::25], ".", color="black", label="without loss")
lower.set(xlabel="distance down the slope (m)", ylabel="speed (m/s)", ylim=(0, None))
lower.legend()
figure.savefig("across_a_pipe.png")
